from __future__ import annotations

import json
import os
from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from pathlib import Path
from threading import Event, Semaphore, Thread

import pytest
from recorded_calls import (
    SCHEMA,
    Counting,
    Interrupted,
    asked,
    entries_of,
    only_file,
    outcome,
    record,
    reply_format,
)

from adhoc import __version__
from adhoc.core.chat import ChatMessage
from adhoc.core.errors import BudgetReached, LedgerError, ModelBusy, ReplyError
from adhoc.llm.ledger.entry import Answer, Call, Failure, Text
from adhoc.llm.ledger.key import MOST_EPISODES, CallKeys
from adhoc.llm.ledger.reader import ledger_files
from adhoc.llm.ledger.recording import LedgerModel
from adhoc.llm.ledger.spending import Spending, spent
from adhoc.llm.model import LMRequest, LMResponse
from adhoc.llm.scripted import ScriptedModel
from adhoc.testing.model_contract import LanguageModelContract


class TestLedgerModel(LanguageModelContract):
    @pytest.fixture(autouse=True)
    def _folders(self, tmp_path_factory):
        self.folders = tmp_path_factory

    def model(self):
        return LedgerModel(ScriptedModel(["an answer"]), self.folders.mktemp("ledger"))


def test_a_call_and_its_answer_are_recorded_in_full(tmp_path):
    model = LedgerModel(Counting(), tmp_path, {"temperature": 0.3})
    model.begin_episode("e1", 5)
    response = model.complete(asked(template="t0", sample=2, temperature=0.5, reply=reply_format()))
    (file,) = ledger_files(tmp_path)
    head = file.header
    assert (head.model, head.window, head.settings) == ("counting-1", 9000, {"temperature": 0.3})
    assert head.library_version == __version__
    *texts, call, answer = entries_of(tmp_path)
    contents = {text.sha256: text.content for text in texts}
    assert sorted(contents.values()) == sorted(["You are a robot.", "Where to?", json.dumps(SCHEMA)])
    assert [(role, contents[digest]) for role, digest in call.messages] == [
        ("system", "You are a robot."),
        ("user", "Where to?"),
    ]
    assert contents[call.schema] == json.dumps(SCHEMA)
    assert (call.stage, call.agent, call.episode, call.template) == ("generate", "r1", "e1", "t0")
    assert (call.sample, call.repeat, call.model, call.max_tokens) == (2, 0, "counting-1", 1024)
    assert (call.temperature, call.seed) == (0.5, 7)
    assert (answer.key, answer.text, answer.model) == (call.key, "answer 1 to Where to?", "counting-1")
    assert (answer.prompt_tokens, answer.completion_tokens, answer.cost_usd) == (10, 3, 0.25)
    assert answer.raw == {"id": 1, "text": "answer 1 to Where to?"}
    assert (answer.finish_reason, answer.outcome, answer.problem) == ("stop", None, None)
    assert answer.latency_s == response.latency_s > 0
    assert not response.replayed


def test_a_call_is_on_the_disk_before_it_is_made(tmp_path):
    class Looking(Counting):
        def complete(self, request: LMRequest) -> LMResponse:
            seen.append(entries_of(tmp_path))
            return super().complete(request)

    seen: list[list[object]] = []
    LedgerModel(Looking(), tmp_path).complete(asked())
    assert [type(entry) for entry in seen[0]] == [Text, Text, Call]
    assert [type(entry) for entry in entries_of(tmp_path)] == [Text, Text, Call, Answer]


def test_an_answer_is_in_the_file_before_anybody_sees_it(tmp_path, monkeypatch):
    class Slow(Thread):
        def start(self) -> None:
            """No sync at all."""

    monkeypatch.setattr("adhoc.llm.ledger.disk_sync.Thread", Slow)
    LedgerModel(Counting(), tmp_path).complete(asked())
    assert [type(entry) for entry in entries_of(tmp_path)] == [Text, Text, Call, Answer]


def test_what_is_written_gets_to_the_disk(tmp_path, monkeypatch):
    synced: list[int] = []
    monkeypatch.setattr(os, "fsync", lambda descriptor: synced.append(os.fstat(descriptor).st_size))
    model = LedgerModel(Counting(), tmp_path)
    for number in range(20):
        model.complete(asked(str(number)))
    model._writer._disk.wait()
    assert synced[-1] == only_file(tmp_path).stat().st_size


def test_one_can_wait_for_the_disk(tmp_path, monkeypatch):
    synced: list[int] = []

    def note(descriptor):
        """Of this ledger alone: others of the process may still be on their way to the disk."""
        status = os.fstat(descriptor)
        if status.st_ino in {path.stat().st_ino for path in (tmp_path, *tmp_path.rglob("*"))}:
            synced.append(status.st_size)

    monkeypatch.setattr(os, "fsync", note)
    LedgerModel(Counting(), tmp_path, wait_for_disk=True).complete(asked())
    assert len(synced) == 3, "the folder, the call, the answer"
    assert synced[-1] == only_file(tmp_path).stat().st_size


def test_a_disk_that_fails_is_told(tmp_path, monkeypatch):
    model = LedgerModel(Counting(), tmp_path, wait_for_disk=True)
    model.complete(asked())

    def fail(descriptor):
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(os, "fsync", fail)
    for _ in range(2):
        with pytest.raises(LedgerError, match="did not reach the disk: Input/output error"):
            model.complete(asked())


def test_a_text_is_stored_once_in_a_file(tmp_path):
    record(tmp_path, asked("a"), asked("b"), asked("a"))
    contents = [entry.content for entry in entries_of(tmp_path) if isinstance(entry, Text)]
    assert contents == ["You are a robot.", "a", "b"]


def test_a_later_session_pays_nothing_again(tmp_path):
    requests = [asked("a"), asked("a"), asked("b"), asked("!empty"), asked("!cut"), asked("a", sample=1)]
    first = record(tmp_path, *requests)
    inner = Counting()
    model = LedgerModel(inner, tmp_path)
    model.begin_episode("e1", 0)
    assert [outcome(model, request) for request in requests] == first
    assert inner.asked == []
    assert len(ledger_files(tmp_path)) == 1, "nothing new, no new file"


def test_what_is_given_again_says_so_and_is_otherwise_equal(tmp_path):
    model = LedgerModel(Counting(), tmp_path)
    model.begin_episode("e1", 0)
    first = model.complete(asked())
    model.begin_episode("e1", 0)
    again = model.complete(asked())
    assert again.replayed
    assert (again.text, again.usage, again.latency_s, again.raw) == (
        first.text,
        first.usage,
        first.latency_s,
        first.raw,
    )


def test_asking_the_same_again_in_an_episode_is_another_call(tmp_path):
    assert record(tmp_path, asked(), asked()) == ["answer 1 to Where to?", "answer 2 to Where to?"]


def test_episodes_share_equal_calls(tmp_path):
    inner = Counting()
    model = LedgerModel(inner, tmp_path)
    answers = []
    for episode in ("alone", "together"):
        model.begin_episode(episode, 7)
        answers.append([model.complete(asked(episode=episode)).text for _ in range(2)])
    assert answers[0] == answers[1]
    assert len(inner.asked) == 2


def test_robots_do_not_count_each_others_requests(tmp_path):
    inner = Counting()
    model = LedgerModel(inner, tmp_path)
    assert model.complete(asked(agent="r1")).text == model.complete(asked(agent="r2")).text
    assert model.complete(asked(agent="r2")).text == "answer 2 to Where to?"


def test_equal_requests_of_one_robot_may_not_go_together(tmp_path):
    model = LedgerModel(Counting(), tmp_path)
    assert model.may_go_together([asked("a"), asked("b"), asked("a", agent="r2"), asked("a", sample=1)])
    assert not model.may_go_together([asked("a"), asked("b"), asked("a")])


@pytest.mark.parametrize(
    "change",
    [
        {"messages": (ChatMessage("user", "You are a robot."), ChatMessage("user", "Where to?"))},
        {"messages": (ChatMessage("system", "You are a robot."),)},
        {"reply": reply_format()},
        {"model": "other"},
        {"temperature": 0.0},
        {"max_tokens": 5},
        {"seed": 8},
        {"seed": None},
        {"sample": 1},
        {"template": "t1"},
    ],
)
def test_what_decides_an_answer_is_part_of_the_key(change):
    assert CallKeys("m", {}).next(asked()) != CallKeys("m", {}).next(asked(**change))


def test_model_and_settings_are_part_of_the_key():
    keys = [CallKeys(model, settings).next(asked())[0] for model in "ab" for settings in ({}, {"t": 0.3})]
    assert len(set(keys)) == 4


def test_who_asks_is_no_part_of_the_key():
    other = asked(stage="reflect", agent="r9", episode="e9", left_out_messages=3)
    assert CallKeys("m", {}).next(asked()) == CallKeys("m", {}).next(other)


def test_the_key_is_what_the_documentation_says():
    key, repeat = CallKeys("m", {}).next(LMRequest((ChatMessage("user", "hi"),), "generate"))
    assert repeat == 0
    request = (
        b'{"max_tokens":1024,"messages":[["user","hi"]],"model":"m","sample":0,"schema":null,"seed":null,'
        b'"settings":{},"temperature":null,"template":""}'
    )
    assert key == sha256(f'["{sha256(request).hexdigest()}",0]'.encode()).hexdigest()


def test_only_so_many_episodes_are_remembered():
    keys = CallKeys("m", {})
    first = keys.next(asked(episode="first"))
    for number in range(MOST_EPISODES):
        keys.next(asked(episode=str(number)))
    assert len(keys._episodes) == MOST_EPISODES
    assert keys.next(asked(episode="first")) == first


def test_requests_without_an_episode_belong_to_the_latest():
    keys = CallKeys("m", {})
    keys.begin_episode("e1")
    assert [keys.next(asked(episode=episode))[1] for episode in ("", "e1", "")] == [0, 1, 2]
    keys.begin_episode("e2")
    assert keys.next(asked(episode=""))[1] == 0


def test_an_answer_of_no_use_is_recorded_with_what_it_cost(tmp_path):
    record(tmp_path, asked("!cut"), asked("!empty"))
    cut, empty = (entry for entry in entries_of(tmp_path) if isinstance(entry, Answer))
    assert (cut.outcome, cut.problem, cut.text, cut.cost_usd) == (
        "truncated",
        "cut off",
        "answer 1 to !cut",
        0.25,
    )
    assert (empty.outcome, empty.problem, empty.text, empty.model) == ("empty", "nothing there", "", "")
    model = LedgerModel(Counting(), tmp_path)
    with pytest.raises(ReplyError, match="cut off") as caught:
        model.complete(asked("!cut"))
    assert caught.value.outcome == "truncated"
    assert isinstance(caught.value.response, LMResponse)
    assert caught.value.response.replayed
    with pytest.raises(ReplyError, match="nothing there") as caught:
        model.complete(asked("!empty"))
    assert caught.value.response is None


def test_a_failed_call_is_recorded_and_made_again(tmp_path):
    inner = Counting()
    model = LedgerModel(inner, tmp_path)
    for _ in range(2):
        model.begin_episode("e1", 0)
        with pytest.raises(ModelBusy):
            model.complete(asked("!busy"))
    assert len(inner.asked) == 2
    failure = entries_of(tmp_path)[-1]
    assert isinstance(failure, Failure)
    assert (failure.error, failure.message) == ("ModelBusy", "the provider has a fault")


def test_a_call_that_a_cap_did_not_allow_is_not_pending(tmp_path):
    model = LedgerModel(ScriptedModel([BudgetReached("enough", "run"), "later"]), tmp_path)
    with pytest.raises(BudgetReached):
        model.complete(asked())
    model.begin_episode("", 0)
    assert model.complete(asked()).text == "later"
    assert spent(tmp_path) == Spending(1, 4 + 2, 1, failed=1)


def test_a_call_that_was_interrupted_stays_pending_and_is_made_again(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        LedgerModel(Interrupted(), tmp_path).complete(asked())
    assert spent(tmp_path) == Spending(calls=1, pending=1)
    assert LedgerModel(Counting(), tmp_path).complete(asked()).text == "answer 1 to Where to?"


class Waiting(Counting):
    """Answers when it is told to."""

    def __init__(self) -> None:
        super().__init__()
        self.called, self.go = Event(), Event()

    def complete(self, request: LMRequest) -> LMResponse:
        self.called.set()
        assert self.go.wait(20)
        return super().complete(request)


class Watched(dict):
    """Tells how often something was looked up."""

    def __init__(self) -> None:
        super().__init__()
        self.looked_up = Semaphore(0)

    def get(self, key, default=None):
        self.looked_up.release()
        return super().get(key, default)


@pytest.mark.parametrize("text", ["Where to?", "!busy", "!cut"])
def test_equal_requests_in_flight_are_one_call(tmp_path, text):
    inner = Waiting()
    model = LedgerModel(inner, tmp_path)
    model._in_flight = flights = Watched()
    with ThreadPoolExecutor(5) as pool:
        first = pool.submit(outcome, model, asked(text, episode="0"))
        assert inner.called.wait(20)
        others = [pool.submit(outcome, model, asked(text, episode=str(number))) for number in range(1, 5)]
        assert all(flights.looked_up.acquire(timeout=20) for _ in range(5))
        assert not any(other.done() for other in others)
        inner.go.set()
        results = {call.result() for call in (first, *others)}
    assert len(results) == 1
    assert len(inner.asked) == 1
    assert len([entry for entry in entries_of(tmp_path) if isinstance(entry, Call)]) == 1
    assert not model._in_flight


def test_many_threads_write_whole_lines(tmp_path):
    model = LedgerModel(Counting(), tmp_path)
    with ThreadPoolExecutor(16) as pool:
        list(
            pool.map(lambda number: model.complete(asked(f"question {number % 50}", seed=number)), range(200))
        )
    entries = entries_of(tmp_path)
    assert len({entry.key for entry in entries if isinstance(entry, Answer)}) == 200
    assert len([entry for entry in entries if isinstance(entry, Text)]) == 51
    assert spent(tmp_path) == Spending(200, 2000, 600, 50.0)


def test_every_writer_has_a_file_of_its_own(tmp_path):
    earlier: dict[Path, bytes] = {}
    for number in range(3):
        record(tmp_path, asked(f"question {number}"))
        contents = {path: path.read_bytes() for path in tmp_path.iterdir()}
        assert len(contents) == number + 1
        assert earlier.items() <= contents.items(), "earlier files are as they were"
        earlier = contents


def test_a_forked_process_writes_elsewhere(tmp_path, monkeypatch):
    model = LedgerModel(Counting(), tmp_path)
    model.complete(asked("a"))
    monkeypatch.setattr(os, "getpid", lambda: 1)
    model.complete(asked("b"))
    names = sorted(path.stem.split("-")[-2] for path in tmp_path.iterdir())
    assert len(names) == 2
    assert "1" in names


def test_nothing_is_written_behind_what_somebody_else_wrote(tmp_path):
    model = LedgerModel(Counting(), tmp_path)
    model.complete(asked("a"))
    path = only_file(tmp_path)
    path.write_bytes(path.read_bytes()[:-5])
    with pytest.raises(LedgerError, match="was changed by somebody else"):
        model.complete(asked("b"))


def test_a_full_disk_is_told_before_anything_is_asked_and_leaves_no_half_line(tmp_path, monkeypatch):
    inner = Counting()
    model = LedgerModel(inner, tmp_path)
    model.complete(asked("a"))
    path = only_file(tmp_path)
    before, write = path.read_bytes(), os.write

    def full(descriptor, data):
        if len(data) < 100:
            raise OSError(28, "No space left on device")
        return write(descriptor, data[: len(data) // 2])

    monkeypatch.setattr(os, "write", full)
    with pytest.raises(LedgerError, match="cannot be written: No space left on device"):
        model.complete(asked("b"))
    monkeypatch.undo()
    assert len(inner.asked) == 1
    assert path.read_bytes() == before
    assert model.complete(asked("c")).text == "answer 2 to c"


def test_a_folder_that_is_a_file_is_told(tmp_path):
    (tmp_path / "out").write_text("x")
    with pytest.raises(LedgerError, match="no ledger can be begun"):
        LedgerModel(Counting(), tmp_path / "out" / "ledger").complete(asked())
