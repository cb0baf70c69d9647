"""A word in a negotiation, as it is read from a model's reply."""

from __future__ import annotations

import json
from typing import Any

import pytest
from fake_situation import CONTEXT

from adhoc.core.calls import Call
from adhoc.core.errors import ReplyError
from adhoc.core.plans import Objection, Proposal
from adhoc.llm.counting import CountingModel
from adhoc.llm.scripted import ScriptedModel
from adhoc.planning.negotiate import LLMNegotiator

SEARCH = {"name": "Search", "args": ["room|3"], "reason": "near"}
PLANS = {"teammate_1": Call("Search", ("room|4",)), "teammate_2": Call("Rest")}


def propose(*replies: dict[str, Any], **options: Any) -> tuple[Proposal, CountingModel]:
    model = CountingModel(ScriptedModel([json.dumps({"analysis": "", **it}) for it in replies]))
    return LLMNegotiator(model, **options).propose(CONTEXT, PLANS), model


def test_agreement() -> None:
    proposal, _ = propose({"agree": True, "objections": [], "sub_task": SEARCH})
    assert proposal == Proposal(Call("Search", ("room|3",)), "near", ())


def test_objections_carry_the_plan_that_they_are_about() -> None:
    proposal, _ = propose(
        {
            "agree": "no",
            "objections": [{"teammate": "teammate_1", "reason": "I am there"}],
            "sub_task": SEARCH,
        }
    )
    assert proposal.objections == (Objection("robot_0", "teammate_1", PLANS["teammate_1"], "I am there"),)


def test_whoever_agrees_objects_to_nothing() -> None:
    proposal, _ = propose(
        {"agree": True, "objections": [{"teammate": "teammate_1", "reason": "?"}], "sub_task": SEARCH}
    )
    assert proposal.objections == ()


@pytest.mark.parametrize(
    ("entries", "left", "outcome"),
    [
        ([{"teammate": "stranger", "reason": ""}], 0, "unknown id"),
        ([{"teammate": 7}, "teammate_1", None], 0, "unknown id"),
        ([{"teammate": "teammate_1"}, {"teammate": "teammate_1"}], 1, "duplicate"),
    ],
)
def test_objections_to_nothing_are_dropped_and_counted(entries, left, outcome) -> None:
    proposal, model = propose({"agree": False, "objections": entries, "sub_task": SEARCH})
    assert len(proposal.objections) == left
    assert model.stages["negotiate"].outcomes[outcome] >= 1


@pytest.mark.parametrize(
    "reply",
    [
        {"objections": [], "sub_task": SEARCH},
        {"agree": True},
        {"agree": "perhaps", "sub_task": SEARCH},
        {"agree": True, "sub_task": {"name": "Fly", "args": []}},
        {"agree": True, "sub_task": {"name": "Search", "args": ["room|99"]}},
        {"agree": False, "objections": "teammate_1", "sub_task": SEARCH},
    ],
)
def test_what_cannot_be_used_is_asked_for_once_more(reply) -> None:
    good = {"agree": True, "objections": [], "sub_task": SEARCH}
    proposal, model = propose(reply, good)
    assert proposal.sub_task == Call("Search", ("room|3",))
    assert model.stages["negotiate"].repaired == 1
    with pytest.raises(ReplyError):
        propose(reply, repairs=0)


def test_what_the_robot_is_not_able_to_do_is_refused() -> None:
    good = {"agree": True, "objections": [], "sub_task": SEARCH}
    rest = {"agree": True, "objections": [], "sub_task": {"name": "Rest", "args": []}}
    proposal, model = propose(
        rest, good, legal=lambda call, capability: "no rest" if call.name == "Rest" else None
    )
    assert proposal.sub_task.name == "Search"
    assert model.stages["negotiate"].outcomes["illegal"] == 1
