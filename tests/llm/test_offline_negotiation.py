"""What the offline reasoner says in a negotiation, by its prompt alone."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest
from fake_situation import CONTEXT, KNOWLEDGE

from adhoc.core.calls import Call
from adhoc.core.messages import TeammateView
from adhoc.core.plans import Context, Objection
from adhoc.core.values import Capability
from adhoc.llm.model import LMRequest
from adhoc.llm.offline.reasoner import OfflineReasoner
from adhoc.prompting.library import shipped_prompts
from adhoc.prompting.stage import StageInput

STRONG, WEAK = Capability(payload=20.0), Capability(can_manipulate=False)
DELIVER_1, DELIVER_BOX = (
    Call("Deliver", ("Letter|1", "Tray", "Office")),
    Call("Deliver", ("Box|1", "Shelf", "Archive")),
)
SEARCH_3 = Call("Search", ("room|3",))
A, B = TeammateView("a", capability=STRONG), TeammateView("b", capability=STRONG)


def said(
    *teammates: TeammateView, plans: dict[str, Call], context: Context = CONTEXT, **stage: Any
) -> dict[str, Any]:
    context = replace(context, teammates=teammates, messages=())
    messages = shipped_prompts().render("negotiate", context, StageInput(plans=plans, **stage))
    model = OfflineReasoner(KNOWLEDGE, forget_capability=0.0, ignore_teammate=0.0, ignore_reply=0.0)
    return json.loads(model.complete(LMRequest(messages, "negotiate")).text)


def sub_task(answer: dict[str, Any]) -> str:
    return " ".join([answer["sub_task"]["name"], *answer["sub_task"]["args"]])


def test_it_agrees_with_what_fits_and_leaves_that_alone() -> None:
    answer = said(A, B, plans={"a": DELIVER_1, "b": SEARCH_3})
    assert answer["agree"] is True
    assert answer["objections"] == []
    assert "Letter|1" not in sub_task(answer)


def test_alone_it_takes_the_nearest() -> None:
    assert sub_task(said(plans={})) == str(DELIVER_1)


@pytest.mark.parametrize(
    ("teammates", "plans", "objected", "reason"),
    [
        ((replace(A, capability=WEAK), B), {"a": DELIVER_1}, "a", "cannot manipulate"),
        ((replace(A, capability=Capability(payload=1.0)), B), {"a": DELIVER_BOX}, "a", "too heavy"),
        ((A, B), {"a": DELIVER_1, "b": DELIVER_1}, "b", "a plans to handle Letter|1"),
        ((A, replace(B, holding="Letter|1")), {"a": DELIVER_1}, "a", "b holds"),
    ],
)
def test_it_objects_to_what_does_not_fit(teammates, plans, objected, reason) -> None:
    answer = said(*teammates, plans=plans)
    assert answer["agree"] is False
    (objection,) = answer["objections"]
    assert objection["teammate"] == objected
    assert reason in objection["reason"]


def test_it_objects_to_a_plan_about_what_it_holds() -> None:
    answer = said(A, plans={"a": DELIVER_1}, context=replace(CONTEXT, holding="Letter|1"))
    assert "I hold" in answer["objections"][0]["reason"]


def test_what_it_objects_to_does_not_stand() -> None:
    assert sub_task(said(replace(A, capability=WEAK), plans={"a": DELIVER_1})) == str(DELIVER_1)


def test_objected_to_it_plans_something_else() -> None:
    objection = Objection("a", "robot_0", DELIVER_1, "mine")
    assert "Letter|1 Tray" not in sub_task(said(A, plans={}, objections=(objection,)))


def test_it_forgets_the_ability_of_nobody_else() -> None:
    """A teammate that the prompt does not list is not judged."""
    assert said(B, plans={"stranger": DELIVER_1})["agree"] is True
