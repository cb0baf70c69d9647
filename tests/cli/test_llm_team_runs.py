"""Runs of a team whose members ask a language model together: recorded, capped, replayed, shared."""

from __future__ import annotations

import pytest
from paid_model import PaidReasoner

from adhoc.cli.main import main
from adhoc.evaluation.records import RecordFile, checked_part


@pytest.fixture(autouse=True)
def _fresh(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(PaidReasoner, "calls", [])
    monkeypatch.setattr(PaidReasoner, "dies_at", None)


def run(*arguments, out="results"):
    fixed = [
        "run",
        "team=llm",
        "policy=irot",
        "join_step=3",
        "llm._target_=paid_model.PaidReasoner",
        "benchmark.draws=[{house: one_room, seed: 1, misplaced: 2, teammates: 3}]",
        "max_steps=12",
        f"out={out}",
        "pictures=false",
        "transcript=false",
    ]
    return main([*fixed, *arguments])


def records(out="results"):
    return [checked_part(record) for record in RecordFile(out).read()]


def test_a_team_pays_for_the_shared_past_once_and_replays_from_the_ledger_alone():
    assert run() == 0
    alone, joined = records()
    paid = len(PaidReasoner.calls)
    assert paid < alone["llm"]["calls"] + joined["llm"]["calls"]
    assert alone["llm"]["stages"].keys() == {"team negotiate", "team sub_skill"}
    assert {"generate", "team negotiate"} <= joined["llm"]["stages"].keys()
    assert run("ledger.mode=replay", "ledger.path=results/ledger", out="again") == 0
    assert records("again") == records()
    assert len(PaidReasoner.calls) == paid


def test_the_team_has_its_own_counts_of_planning():
    run()
    alone, joined = records()
    assert alone["planning"]["sub_tasks"] == 0
    assert alone["team_planning"]["sub_tasks"] >= 3
    assert joined["planning"]["sub_tasks"] >= 1


@pytest.mark.parametrize("calls", [4, 5, 6, 7, 8, 9])
def test_a_cap_reached_among_questions_that_go_out_together_is_reached_alike_again(calls):
    """The order of answers would decide which question is the last one."""
    cap = f"budget.episode.calls={calls}"
    assert run(cap) == 0
    assert [it["llm"]["calls"] for it in records()] == [calls, calls]
    assert run(cap, "ledger.path=results/ledger", out="again") == 0
    assert records("again") == records()
