"""The parts of the workers that need no process."""

from __future__ import annotations

import pickle
import threading

import pytest

from adhoc.core import errors
from adhoc.core.chat import ChatMessage
from adhoc.core.errors import AdhocError, BudgetReached, ModelBusy, ReplyError, WorkerError
from adhoc.core.replies import Reading, ReplyFormat
from adhoc.experiments.workers.agenda import Agenda
from adhoc.experiments.workers.calls import CallThreads
from adhoc.experiments.workers.messages import Raised, portable
from adhoc.experiments.workers.remote import RemoteModel
from adhoc.llm.model import LanguageModel, LMRequest

ERRORS = [kind for kind in vars(errors).values() if isinstance(kind, type) and issubclass(kind, AdhocError)]


class Demanding(AdhocError):
    """An error that pickle alone cannot bring back."""

    def __init__(self, file: str, line: int) -> None:
        super().__init__(f"{file}, line {line}")
        self.line = line


def carried(error):
    return pickle.loads(pickle.dumps(Raised.of(error))).error()


@pytest.mark.parametrize("kind", ERRORS)
def test_every_error_survives_the_way(kind):
    back = carried(kind("what went wrong"))
    assert (type(back), str(back)) == (kind, "what went wrong")


def test_the_fields_of_errors_survive_the_way():
    busy = carried(ModelBusy("later", 3.5, True))
    assert (busy.retry_after, busy.rate_limited) == (3.5, True)
    assert carried(BudgetReached("no", scope="run")).scope == "run"
    assert carried(ReplyError("no", outcome="illegal")).outcome == "illegal"
    demanding = carried(Demanding("a.json", 7))
    assert (str(demanding), demanding.line) == ("a.json, line 7", 7)


def test_a_request_is_sent_with_its_schema_and_without_its_reader():
    request = LMRequest(
        (ChatMessage("user", "?"),),
        "generate",
        reply=ReplyFormat("x", {"type": "object"}, lambda _: Reading(1)),
    )
    sent = pickle.loads(pickle.dumps(portable(request)))
    assert sent.messages == request.messages
    assert (sent.reply.name, sent.reply.schema) == ("x", {"type": "object"})
    assert portable(LMRequest((), "generate")) == LMRequest((), "generate")


def test_a_remote_model_leaves_nothing_to_the_defaults_of_a_language_model():
    public = {name for name in vars(LanguageModel) if not name.startswith("_")}
    assert public <= set(vars(RemoteModel))


class TestAgenda:
    def full(self, count=3, deaths=3):
        return Agenda(range(count), deaths)

    def test_scenarios_are_handed_out_in_order_and_once(self):
        agenda = self.full()
        assert [agenda.next(0), agenda.next(1), agenda.next(0)] == [0, 1, 2]
        assert not agenda.open_units
        assert agenda.next(1) is None
        assert (agenda.is_dismissed(1), agenda.is_dismissed(0)) == (True, False)

    def test_what_a_lost_worker_had_comes_next(self):
        agenda = self.full()
        agenda.next(0)
        agenda.next(1)
        agenda.lose(0, "signal SIGKILL")
        assert [agenda.next(1), agenda.next(2), agenda.next(1)] == [0, 2, None]

    def test_what_was_done_does_not_come_again(self):
        agenda = self.full(2)
        agenda.next(0)
        agenda.next(0)
        agenda.lose(0, "signal SIGKILL")
        assert [agenda.next(1), agenda.next(1)] == [1, None]

    def test_deaths_are_counted_by_episode(self):
        agenda = self.full(deaths=2)
        for worker, episode in enumerate(["alone", "joined"]):
            agenda.next(worker)
            agenda.note_episode(worker, episode)
            agenda.lose(worker, "signal SIGKILL")
        agenda.next(2)
        agenda.note_episode(2, "joined")
        assert agenda.given_up("joined") is None
        agenda.lose(2, "signal SIGSEGV")
        assert agenda.given_up("joined") == "2 worker processes died in it (last: signal SIGSEGV)"
        assert agenda.given_up("alone") is None

    def test_deaths_before_any_episode_end_the_run_only_if_no_worker_gets_further(self):
        agenda = self.full(deaths=2)
        agenda.lose(0, "signal SIGKILL")
        agenda.next(1)
        agenda.note_episode(1, "alone")
        agenda.lose(2, "signal SIGKILL")
        with pytest.raises(WorkerError, match="before the first episode"):
            agenda.lose(3, "signal SIGKILL")

    def test_a_worker_that_is_killed_when_it_leaves_is_no_loss(self):
        agenda = self.full(1, deaths=1)
        agenda.next(0)
        agenda.next(0)
        agenda.lose(0, "signal SIGKILL")
        assert not agenda.open_units


class TestCallThreads:
    def test_as_many_calls_go_at_once_as_there_may_be_threads(self):
        threads, meeting, done = CallThreads(3), threading.Barrier(3, timeout=60), threading.Semaphore(0)

        def call():
            meeting.wait()
            done.release()

        for _ in range(6):
            threads.make(call)
        assert all(done.acquire(timeout=60) for _ in range(6))
        threads.close(60)
        assert threads.failures.empty()

    def test_a_call_that_raises_is_told_and_the_thread_goes_on(self):
        threads, done = CallThreads(1), threading.Event()
        threads.make(lambda: 1 // 0)
        threads.make(done.set)
        assert done.wait(60)
        assert isinstance(threads.failures.get(), ZeroDivisionError)
        threads.close(60)

    def test_the_end_waits_for_what_was_begun_and_drops_the_rest(self):
        threads, begun, go, made = CallThreads(1), threading.Event(), threading.Event(), []

        def first():
            begun.set()
            go.wait(60)
            made.append("first")

        threads.make(first)
        threads.make(lambda: made.append("second"))
        assert begun.wait(60)
        threading.Timer(0.2, go.set).start()
        threads.close(60)
        assert made == ["first"]

    def test_a_call_that_hangs_does_not_hang_the_end(self):
        threads, forever = CallThreads(1), threading.Event()
        threads.make(lambda: forever.wait(60) and None)
        threads.close(0.05)
        forever.set()
