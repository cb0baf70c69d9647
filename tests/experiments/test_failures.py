from __future__ import annotations

import json

import pytest
from grid_world import GridWorld, Script
from test_run import HELPER, IDLER, SCENARIOS, conditions

from adhoc.core.errors import ConfigurationError, EpisodesFailed, ModelError, RecordError
from adhoc.evaluation.contender import Contender
from adhoc.experiments.comparison import Comparison, Entrant
from adhoc.experiments.failures import Failure, FailureFile, Tolerance
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.progress import Silent
from adhoc.experiments.run import run_comparison


class Faulty(Script):
    """Raises at its second step, as long as `broken` says so."""

    broken = True
    error: Exception = ZeroDivisionError("a fault in a policy")

    def act(self, observation, inbox):
        if observation.step == 6 and Faulty.broken:
            raise self.error
        return super().act(observation, inbox)


FAULTY = Contender("faulty", "Faulty", lambda seat: Faulty(), {"name": "faulty"})


@pytest.fixture(autouse=True)
def broken():
    Faulty.broken = True


def comparison(*newcomers, **changes):
    entrants = tuple(Entrant(it, 5) for it in newcomers)
    return Comparison(GridWorld(), SCENARIOS, conditions(**changes), entrants)


def run(folder, *newcomers, most=None, **changes):
    store = RunFolder(folder, Tolerance(most))
    return run_comparison(comparison(*newcomers, **changes), store), store


def test_the_other_episodes_are_run(tmp_path):
    summary, store = run(tmp_path, FAULTY, HELPER)
    assert (summary.run, summary.failed) == (4, 2)
    assert {it["policy"] for it in store.records} == {"none", "helper"}


def test_what_went_wrong_is_kept_with_its_place(tmp_path):
    run(tmp_path, FAULTY)
    failure = RunFolder(tmp_path).failures[0]
    assert (failure.team, failure.policy, failure.join_step) == ("walkers", "faulty", 5)
    assert (failure.error, failure.message) == ("ZeroDivisionError", "a fault in a policy")
    assert "raise self.error" in failure.trace


def test_a_failed_episode_is_run_again_and_forgotten_when_it_succeeds(tmp_path):
    run(tmp_path, FAULTY)
    Faulty.broken = False
    summary, store = run(tmp_path, FAULTY)
    assert (summary.run, summary.recorded, store.failures) == (2, 2, ())
    assert not (tmp_path / "failures.jsonl").exists()


def test_who_goes_away_while_being_told_leaves_no_failure(tmp_path):
    class Gone(Silent):
        def finished(self, record):
            raise SystemExit(1)

    with pytest.raises(SystemExit):
        run_comparison(comparison(HELPER), RunFolder(tmp_path), Gone())
    assert len(RunFolder(tmp_path).records) == 1
    assert RunFolder(tmp_path).failures == ()


def test_a_failure_of_an_episode_that_is_recorded_does_not_count(tmp_path):
    run(tmp_path, HELPER)
    record = RunFolder(tmp_path).records[0]
    FailureFile(tmp_path).add(
        Failure(
            record["episode_id"], "task", "walkers", "none", None, "Killed", "between two writes", "", "0"
        )
    )
    assert RunFolder(tmp_path).failures == ()


def test_what_a_policy_says_in_an_error_is_one_line(tmp_path, monkeypatch):
    monkeypatch.setattr(Faulty, "error", RuntimeError("my sensor\nbroke\x1b[31m"))
    _, store = run(tmp_path, FAULTY)
    assert store.failures[0].message == "my sensor broke [31m"


def test_one_that_fails_again_is_there_once(tmp_path):
    run(tmp_path, FAULTY)
    run(tmp_path, FAULTY)
    assert len(RunFolder(tmp_path).failures) == 2


def test_episodes_whose_team_alone_failed_are_not_run(tmp_path):
    team = Contender("walkers", "Walkers", lambda seat: Faulty(), {"name": "walkers"})
    _, store = run(tmp_path, HELPER, team=team)
    assert store.records == []
    assert [it.message for it in store.failures if it.policy == "helper"] == [
        f"{it.id}--walkers--helper--t5: the episode of the team alone failed" for it in SCENARIOS
    ]


@pytest.mark.parametrize("error", [ModelError("no key"), OSError(28, "No space left"), MemoryError()])
def test_what_would_go_wrong_in_all_episodes_ends_the_run(tmp_path, error, monkeypatch):
    monkeypatch.setattr(Faulty, "error", error)
    with pytest.raises(type(error)):
        run(tmp_path, FAULTY)
    assert RunFolder(tmp_path).failures == ()


@pytest.mark.parametrize(
    ("most", "kept"),
    [(0, 1), (1, 2), (0.2, 2), (0.1, 1)],
)
def test_the_run_stops_when_too_many_failed(tmp_path, most, kept):
    with pytest.raises(EpisodesFailed, match=rf"{kept} of 6 episodes failed.*fail_on_error={most}"):
        run(tmp_path, FAULTY, IDLER, most=most)
    assert len(RunFolder(tmp_path).failures) == kept


@pytest.mark.parametrize("most", [2, 0.34, None])
def test_the_run_goes_on_when_few_failed(tmp_path, most):
    assert run(tmp_path, FAULTY, IDLER, most=most)[0].failed == 2


@pytest.mark.parametrize("most", [-1, -0.1, 1.5])
def test_an_impossible_tolerance_is_refused(most):
    with pytest.raises(ConfigurationError, match=f"fail_on_error={most}"):
        Tolerance(most)


@pytest.mark.parametrize("line", ["no json", "[]", json.dumps({"episode_id": "a"})])
def test_a_damaged_file_is_named(tmp_path, line):
    (tmp_path / "failures.jsonl").write_text(line + "\n")
    with pytest.raises(RecordError, match=r"failures\.jsonl, line 1"):
        RunFolder(tmp_path)


class Unspeakable(Exception):
    def __str__(self):
        raise ValueError("it cannot be told")


@pytest.mark.parametrize(
    "error",
    [TimeoutError("slow"), ConnectionResetError("gone"), SystemExit(0), Unspeakable(), RecursionError()],
)
def test_whatever_else_a_policy_raises_is_its_episodes_failure(tmp_path, error, monkeypatch):
    monkeypatch.setattr(Faulty, "error", error)
    summary, store = run(tmp_path, FAULTY)
    assert (summary.run, summary.failed) == (2, 2)
    assert {it.error for it in store.failures} == {type(error).__name__}


@pytest.mark.parametrize("most", [float("inf"), float("nan")])
def test_a_tolerance_is_a_number(most):
    with pytest.raises(ConfigurationError, match="fail_on_error"):
        Tolerance(most)
