from __future__ import annotations

import os
import signal
import threading
from collections import Counter
from functools import partial

import pytest
from worker_setups import Compare, Refusing

from adhoc.core.errors import (
    ConfigurationError,
    EpisodesFailed,
    ModelBusy,
    ModelError,
    ReplyError,
)
from adhoc.evaluation.records import RecordFile, checked_part
from adhoc.experiments.failures import Tolerance
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.plan import make_plan
from adhoc.experiments.run import run_comparison
from adhoc.experiments.workers.crew import SpawnedWorker
from adhoc.experiments.workers.parent import DEATHS, run_in_workers
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage


class Progress:
    def __init__(self):
        self.total, self.told = None, Counter()

    def begin(self, plan):
        self.total = plan.to_run

    def started(self, episode_id):
        self.told["started", episode_id] += 1

    def finished(self, record):
        self.told["finished", record["episode_id"]] += 1

    def failed(self, failure):
        self.told["failed", failure.episode_id] += 1

    def count(self, what):
        return sum(times for (told, _), times in self.told.items() if told == what)


class Provider(LanguageModel):
    """Answers with as many letters as the question has vowels of a kind; counts what it is asked."""

    window = 4096

    def __init__(self):
        self.asked, self.begun, self.notes, self.threads = Counter(), [], [], set()

    @property
    def name(self):
        return "provider"

    def complete(self, request: LMRequest) -> LMResponse:
        question = request.messages[0].content
        self.asked[question] += 1
        self.threads.add(threading.current_thread())
        return LMResponse("x" * sum(map(ord, question)), self.name, Usage(3, 2, 0.5), raw={"id": object()})

    def begin_episode(self, episode, seed):
        self.begun.append((episode, seed))


def run(folder, make, workers=2, provider=None, **options):
    progress, store = Progress(), RunFolder(folder, options.pop("tolerance", None))
    provider = provider or Provider()
    plan = make_plan([make.comparison(Provider())], store)
    hire, make_model = partial(SpawnedWorker, make=make), options.pop("provider_of", lambda: provider)
    summary = run_in_workers(plan, hire, make_model, workers, store, progress, **options)
    return summary, progress


def records_of(folder):
    records = [checked_part(record) for record in RecordFile(folder).read()]
    return sorted(records, key=lambda record: record["episode_id"])


def test_the_records_are_those_of_one_process(tmp_path):
    make, alone = Compare(), Provider()
    run_comparison(make.comparison(alone), RunFolder(tmp_path / "serial"), Progress())
    provider = Provider()
    summary, progress = run(tmp_path / "workers", make, provider=provider)
    assert records_of(tmp_path / "workers") == records_of(tmp_path / "serial")
    assert (summary.run, summary.recorded, progress.total) == (6, 0, 6)
    assert progress.count("finished") == progress.count("started") == 6
    assert provider.asked == alone.asked
    assert sorted(provider.begun) == sorted(alone.begun)
    joined = [record for record in records_of(tmp_path / "workers") if record["policy"] != "none"]
    assert [record["llm"]["cost_usd"] for record in joined] == [0.5 * 9] * 3


def test_the_same_again_runs_nothing(tmp_path):
    run(tmp_path, Compare(scenarios=2))
    before = (tmp_path / "episodes.jsonl").read_bytes()
    provider = Provider()
    summary, progress = run(tmp_path, Compare(scenarios=2), provider=provider)
    assert (summary.run, summary.recorded, progress.total) == (0, 4, 0)
    assert (tmp_path / "episodes.jsonl").read_bytes() == before
    assert not provider.asked


def test_more_workers_than_scenarios_and_a_single_one(tmp_path):
    run(tmp_path / "many", Compare("fetcher", 1), workers=3)
    run(tmp_path / "one", Compare("fetcher", 1), workers=1)
    assert records_of(tmp_path / "many") == records_of(tmp_path / "one")
    assert len(records_of(tmp_path / "one")) == 2


def test_calls_of_two_workers_are_under_way_together(tmp_path):
    both = threading.Barrier(2, timeout=60)

    class Meeting(Provider):
        def complete(self, request):
            if request.messages[0].content.startswith("newcomer 3 "):
                both.wait()
            return super().complete(request)

    run(tmp_path, Compare(scenarios=2), provider=Meeting())
    assert not both.broken


def test_everything_about_the_model_is_asked_of_the_parents(tmp_path):
    class Strict(Provider):
        def count_tokens(self, messages):
            return 17

        def may_go_together(self, requests):
            return [it.stage for it in requests] == ["first", "second"]

        def note(self, stage, outcome):
            self.notes.append((stage, outcome))

    provider = Strict()
    run(tmp_path, Compare("curious", 1), workers=1, provider=provider)
    assert provider.notes == [("provider 4096 17 True", "noted")] * 9


def test_errors_of_the_model_reach_the_policy_with_their_fields(tmp_path):
    class Refusing(Provider):
        def complete(self, request):
            raise ModelBusy("try later", retry_after=7.0, rate_limited=True)

    with pytest.raises(ModelBusy, match=r"^try later$") as caught:
        run(tmp_path, Compare(scenarios=1), provider=Refusing())
    assert (caught.value.retry_after, caught.value.rate_limited) == (7.0, True)


def test_an_unusable_reply_that_nobody_catches_fails_the_episode(tmp_path):
    class Mumbling(Provider):
        def complete(self, request):
            raise ReplyError("nothing usable", outcome="empty")

    with pytest.raises(EpisodesFailed, match=r"s0--walkers--asker-provider--t3.*ReplyError: nothing usable"):
        run(tmp_path, Compare(scenarios=1), provider=Mumbling())


def test_a_fault_of_the_parents_model_ends_the_run(tmp_path):
    class Faulty(Provider):
        def complete(self, request):
            raise ZeroDivisionError("a fault in a backend")

    with pytest.raises(ZeroDivisionError, match="a fault in a backend"):
        run(tmp_path, Compare(scenarios=1), provider=Faulty())


def test_a_model_that_cannot_be_built_ends_the_run(tmp_path):
    def missing():
        raise ModelError("no key")

    with pytest.raises(ModelError, match="no key"):
        run(tmp_path, Compare(), provider_of=missing)


def test_a_worker_that_cannot_begin_ends_the_run(tmp_path):
    with pytest.raises(ModelError, match="there is no such model"):
        run(tmp_path, Refusing())


def test_a_disturbed_past_fails_the_episode(tmp_path):
    with pytest.raises(EpisodesFailed, match=r"two_rooms-s0.*EpisodeError"):
        run(tmp_path, Compare("disturbed", 1))


def test_failed_episodes_are_kept_and_the_others_run(tmp_path):
    summary, progress = run(tmp_path, Compare("faulty", 2), tolerance=Tolerance(None))
    assert (summary.run, summary.failed, progress.count("failed")) == (2, 2, 2)
    (first, second) = sorted(RunFolder(tmp_path).failures, key=lambda it: it.task_id)
    assert (first.episode_id, first.error) == ("two_rooms-s0--walkers--faulty--t3", "ZeroDivisionError")
    assert "a fault in a policy" in second.trace


def test_more_failures_than_borne_end_the_run(tmp_path):
    with pytest.raises(EpisodesFailed, match=r"2 of 6 episodes failed.*fail_on_error=1"):
        run(tmp_path, Compare("faulty", 3), tolerance=Tolerance(1), workers=1)


def test_the_episode_of_a_killed_worker_is_run_again(tmp_path):
    compare = Compare("dying", 2, str(tmp_path), deaths=DEATHS - 1)
    summary, progress = run(tmp_path / "killed", compare)
    assert len(list(tmp_path.glob("death-*"))) == DEATHS - 1
    assert (summary.run, summary.recorded, progress.count("finished")) == (4, 0, 4)
    assert progress.count("started") == 4 + DEATHS - 1
    run(tmp_path / "undisturbed", Compare("dying", 2, str(tmp_path)))
    assert records_of(tmp_path / "killed") == records_of(tmp_path / "undisturbed")


def test_a_worker_may_be_killed_in_the_middle_of_a_message(tmp_path):
    summary, _ = run(tmp_path / "killed", Compare("stammering", 1, str(tmp_path), deaths=1))
    assert len(list(tmp_path.glob("death-*"))) == 1
    assert summary.run == 2


@pytest.mark.parametrize(("newcomer", "how"), [("dying", "signal SIGKILL"), ("leaving", "exit code 9")])
def test_an_episode_that_kills_its_worker_again_and_again_has_failed(tmp_path, newcomer, how):
    compare = Compare(newcomer, 1, str(tmp_path), deaths=100)
    summary, _ = run(tmp_path / "run", compare, tolerance=Tolerance(None))
    assert len(list(tmp_path.glob("death-*"))) == DEATHS
    assert (summary.run, summary.failed) == (1, 1)
    (failure,) = RunFolder(tmp_path / "run").failures
    assert failure.episode_id == f"two_rooms-s0--walkers--{newcomer}--t3"
    assert f"{DEATHS} worker processes died in it (last: {how})" in failure.message


def test_a_call_in_flight_is_answered_although_its_worker_was_killed(tmp_path):
    killed, answered = threading.Event(), []

    class Watching(Provider):
        def complete(self, request):
            response = super().complete(request)
            if request.messages[0].content.startswith("newcomer 5 ") and not killed.is_set():
                killed.set()
                (worker,) = workers_of_this_process()
                os.kill(worker, signal.SIGKILL)
                answered.append(response.text)
            return response

    provider = Watching()
    summary, _ = run(tmp_path, Compare(scenarios=1), workers=1, provider=provider)
    assert summary.run == 2
    assert len(answered) == 1
    assert provider.begun.count(("two_rooms-s0--walkers--asker-provider--t3", 0)) == 2


def workers_of_this_process():
    from multiprocessing import active_children

    return [child.pid for child in active_children() if child.name.startswith("adhoc-worker")]


@pytest.mark.parametrize("numbers", [{"workers": 0}, {"calls": 0}])
def test_numbers_out_of_range_are_refused(tmp_path, numbers):
    with pytest.raises(ConfigurationError, match="must be at least 1"):
        run(tmp_path, Compare(), **numbers)


def test_no_worker_is_left_behind(tmp_path):
    with pytest.raises(EpisodesFailed):
        run(tmp_path, Compare("disturbed", 1))
    assert workers_of_this_process() == []
