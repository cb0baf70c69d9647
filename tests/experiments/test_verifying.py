"""The derivations of `adhoc verify`, against records made by hand."""

from __future__ import annotations

import pytest

from adhoc.evaluation.metrics import FailedShare, action_steps
from adhoc.experiments.verifying.derived import derived_troubles
from adhoc.experiments.verifying.finding import Finding, NumberedRecord, expected
from adhoc.experiments.verifying.form import form_troubles

STAGE = {
    "calls": 2,
    "prompt_tokens": 100,
    "prefix_tokens": 40,
    "completion_tokens": 10,
    "cost_usd": 0.1,
    "repaired": 1,
    "invalid": 0,
}
WON = {
    "episode_id": "task--heuristic--irot-tiny--t4",
    "task_id": "task",
    "house_id": "house",
    "rooms": 7,
    "difficulty": "Difficult",
    "teammates": 2,
    "misplaced": 3,
    "team": "heuristic",
    "team_label": "Heuristic based",
    "policy": "irot",
    "policy_label": "IRoT-LLM",
    "join_step": 4,
    "joined": True,
    "newcomer": {"can_manipulate": True},
    "first_help": 6,
    "seed": 0,
    "model": "tiny",
    "max_steps": 30,
    "steps": 10,
    "ending": "all misplaced objects re-placed",
    "reached_cap": None,
    "success": True,
    "replaced": 3,
    "partial_success": 1.0,
    "temporal_steps": 10,
    "action_steps": 24,
    "agent_steps": {"teammate_1": 10, "teammate_2": 8, "newcomer": 6},
    "reference_temporal_steps": 20,
    "efficiency": 0.5,
    "messages": 3,
    "llm": {**{name: 2 * value for name, value in STAGE.items()}, "stages": {"plan": STAGE, "ask": STAGE}},
    "history_hash": "0123456789abcdef",
    "history": None,
    "scenario_hash": "s",
    "config_hash": "c",
    "failed_share": "from_joining",
    "library_version": "0",
    "wall_s": 0.1,
}
LOST = {
    **WON,
    "first_help": None,
    "steps": 30,
    "ending": "step limit reached",
    "success": False,
    "replaced": 1,
    "partial_success": 1 / 3,
    "temporal_steps": 30,
    "action_steps": 30 + 30 + 26,
    "agent_steps": {"teammate_1": 30, "teammate_2": 8, "newcomer": 26},
    "efficiency": 0.0,
}
ALONE = {
    **LOST,
    "policy": "none",
    "join_step": None,
    "joined": False,
    "newcomer": None,
    "agent_steps": {"teammate_1": 30, "teammate_2": 8},
    "action_steps": 60,
    "history": "0" * 16 * 30 + "0123456789abcdef",
}
LATE = {**LOST, "join_step": 20, "joined": False, "steps": 20, "agent_steps": {"a": 20, "b": 20}}
LATE = {**LATE, "ending": "all robots stopped or out of battery", "action_steps": 60}
CUT = {**LOST, "steps": 12, "ending": "budget reached", "reached_cap": "budget.episode.calls"}
CUT = {**CUT, "agent_steps": {"teammate_1": 12, "teammate_2": 8, "newcomer": 8}}
WHOLE = {"won": WON, "lost": LOST, "alone": ALONE, "late": LATE, "cut": CUT}


def fields_of(record):
    return {field for field, _ in derived_troubles(record)}


@pytest.mark.parametrize("name", WHOLE)
def test_what_the_definitions_give_is_no_trouble(name):
    assert list(form_troubles(WHOLE[name])) == []
    assert list(derived_troubles(WHOLE[name])) == []


@pytest.mark.parametrize(
    ("name", "changes", "field"),
    [
        ("won", {"replaced": 4}, "replaced"),
        ("won", {"success": False}, "success"),
        ("won", {"partial_success": 0.99}, "partial_success"),
        ("won", {"temporal_steps": 30}, "temporal_steps"),
        ("won", {"action_steps": 25}, "action_steps"),
        ("won", {"agent_steps": {"teammate_1": 10, "teammate_2": 8, "newcomer": 7}}, "action_steps"),
        ("won", {"agent_steps": {"teammate_1": 16, "newcomer": 8}}, "agent_steps"),
        ("won", {"agent_steps": {"a": 11, "b": 7, "newcomer": 6}}, "agent_steps.a"),
        ("won", {"first_help": 7}, "first_help"),
        ("won", {"first_help": 0}, "first_help"),
        ("won", {"newcomer": None}, "newcomer"),
        ("won", {"rooms": 6}, "difficulty"),
        ("won", {"model": None}, "model"),
        ("won", {"ending": "step limit reached"}, "ending"),
        ("lost", {"replaced": 3, "partial_success": 1.0}, "ending"),
        ("lost", {"steps": 29}, "ending"),
        ("lost", {"steps": 31}, "steps"),
        ("lost", {"failed_share": "full"}, "action_steps"),
        ("lost", {"temporal_steps": 29}, "temporal_steps"),
        ("lost", {"history": "0" * 16}, "history"),
        ("lost", {"reached_cap": "budget.episode.usd"}, "reached_cap"),
        ("lost", {"join_step": None}, "join_step"),
        ("alone", {"joined": True}, "joined"),
        ("alone", {"history": "0123456789abcdef" * 30}, "history"),
        ("alone", {"history": None}, "history"),
        ("alone", {"history_hash": "f" * 16}, "history_hash"),
        ("alone", {"first_help": 3}, "first_help"),
        ("late", {"steps": 21}, "joined"),
        ("late", {"joined": True}, "agent_steps"),
        ("cut", {"reached_cap": None}, "reached_cap"),
        ("cut", {"success": True}, "success"),
    ],
)
def test_what_does_not_follow_is_told_with_its_field(name, changes, field):
    assert field in fields_of({**WHOLE[name], **changes})


@pytest.mark.parametrize("field", STAGE)
def test_sums_over_the_stages_of_a_model_are_checked(field):
    llm = {**WON["llm"], field: WON["llm"][field] + 1e-6 if field == "cost_usd" else WON["llm"][field] + 1}
    assert fields_of({**WON, "llm": llm}) == {f"llm.{field}"}


def test_rounded_costs_are_no_trouble():
    llm = {**WON["llm"], "cost_usd": WON["llm"]["cost_usd"] + 1e-12}
    assert fields_of({**WON, "llm": llm}) == set()


def test_an_episode_may_end_by_its_budget_with_all_objects_in_place():
    record = {**CUT, "replaced": 3, "partial_success": 1.0}
    assert fields_of(record) == set()


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"rooms": 0}, "rooms"),
        ({"steps": -1}, "steps"),
        ({"steps": True}, "steps"),
        ({"ending": "lunch"}, "ending"),
        ({"failed_share": None}, "failed_share"),
        ({"joined": 1}, "joined"),
        ({"history": 5}, "history"),
        ({"join_step": -3}, "join_step"),
        ({"agent_steps": [1]}, "agent_steps"),
        ({"agent_steps": {"a": 0.5}}, "agent_steps"),
        ({"newcomer": 3}, "newcomer"),
        ({"first_help": "soon"}, "first_help"),
        ({"llm": {}}, "llm.stages"),
        ({"llm": {**WON["llm"], "calls": None}}, "llm.calls"),
        ({"llm": {**WON["llm"], "stages": {"plan": {**STAGE, "cost_usd": -1}}}}, "llm.stages.plan.cost_usd"),
        ({"team_label": None}, "team_label"),
    ],
)
def test_what_no_run_writes_is_told_before_anything_is_computed(changes, field):
    assert [name for name, _ in form_troubles({**WON, **changes})] == [field]


def test_a_missing_field_is_told():
    record = {name: value for name, value in WON.items() if name != "ending"}
    ((field, text),) = form_troubles(record)
    assert field == "ending"
    assert text.startswith("is missing; it should be one of")


def test_findings_name_file_line_field_and_episode():
    it = NumberedRecord(7, WON)
    assert str(it.finding(("steps", "is 3"))) == (
        "episodes.jsonl, line 7: steps: is 3 (episode task--heuristic--irot-tiny--t4)"
    )
    assert str(Finding("table.md", None, "", "is gone", False)) == "note: table.md: is gone"


def test_true_is_not_one():
    assert list(expected("x", True, 1, "it")) == [("x", "is True; it is 1")]
    assert list(expected("x", 1.0, 1, "it")) == []


def test_the_newcomer_counts_from_its_joining_or_in_full():
    arguments = (False, {}, 3, 500)
    assert action_steps(*arguments, None, FailedShare.FROM_JOINING) == 1500
    assert action_steps(*arguments, 100, FailedShare.FROM_JOINING) == 1900
    assert action_steps(*arguments, 100, FailedShare.FULL) == 2000
