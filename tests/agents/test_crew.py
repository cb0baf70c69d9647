"""The private talk of an LLM-based team."""

from __future__ import annotations

from dataclasses import replace

import pytest

from adhoc.agents.crew import Crew, objection_message, plan_message, read_objection
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Objection

EXPLORE, TIDY = Call("Explore", ("room|2",)), Call("Re-place", ("Mug|1", "Shelf", "Kitchen"))


def said(message: Message, sender: str) -> Message:
    return replace(message, sender=sender)


def test_the_latest_plans_in_the_order_of_planning():
    crew = Crew()
    crew.hear_all([said(plan_message(EXPLORE), "a"), said(plan_message(TIDY), "b")], 1)
    assert list(crew.plans(1).items()) == [("a", EXPLORE), ("b", TIDY)]
    crew.hear(said(plan_message(EXPLORE), "a"), 2)
    assert list(crew.plans(2)) == ["a", "b"]
    crew.hear(said(plan_message(TIDY), "a"), 2)
    assert list(crew.plans(2)) == ["b", "a"]


def test_what_was_said_before_does_not_replace_what_was_said_later():
    crew = Crew()
    crew.hear(replace(said(plan_message(TIDY), "a"), step=4), 3)
    crew.hear(replace(said(plan_message(None), "a"), step=3), 4)
    assert crew.plans(4) == {"a": TIDY}


def test_who_has_no_plan_stopped_or_fell_silent_plans_nothing():
    crew = Crew(patience=5)
    for name, message in {
        "idle": plan_message(None),
        "stopped": plan_message(EXPLORE, stopped=True),
        "silent": plan_message(TIDY),
    }.items():
        crew.hear(said(message, name), 10)
    assert crew.plans(15) == {"silent": TIDY}
    assert crew.plans(16) == {}
    assert crew.broken(15) == ()
    assert crew.broken(16) == ("idle", "silent")
    assert crew.heard("silent") == 10


def test_plans_that_were_made_again_are_passed_on_for_members_alone():
    crew = Crew()
    crew.hear(said(plan_message(EXPLORE), "a"), 1)
    crew.hear(said(plan_message(None, revised={"a": TIDY, "nobody": TIDY}), "b"), 1)
    assert crew.plans(1) == {"a": TIDY}


def test_a_plan_that_is_passed_on_late_does_not_replace_a_newer_one():
    crew = Crew()
    crew.hear(replace(said(plan_message(TIDY), "a"), step=5), 5)
    crew.hear(replace(said(plan_message(None, revised={"a": EXPLORE}), "b"), step=4), 6)
    assert crew.plans(6) == {"a": TIDY}


@pytest.mark.parametrize(
    "message",
    [
        Message(MessageKind.TEAM, "", {"name": "a", "position": [1, 2]}),
        Message(MessageKind.TASK_STATE, "", plan_message(EXPLORE).payload),
        Message(MessageKind.TEAM, ""),
    ],
)
def test_other_talk_is_no_plan(message):
    crew = Crew()
    crew.hear(said(message, "x"), 1)
    assert not crew.is_member("x")


@pytest.mark.parametrize("revised", [3, None, ["a"], {"a": 7}])
def test_nonsense_within_a_plan_is_left_out(revised):
    crew = Crew()
    crew.hear(said(plan_message(EXPLORE), "a"), 1)
    payload = {"plan": {"name": 3}, "stopped": "no", "revised": revised}
    crew.hear(Message(MessageKind.TEAM, "", payload, sender="x"), 1)
    assert crew.is_member("x")
    assert set(crew.plans(1)) <= {"a"}


def test_an_objection_is_read_as_it_was_written():
    objection = Objection("b", "a", TIDY, "I hold it")
    assert read_objection(said(objection_message(objection), "b")) == objection
    assert read_objection(said(plan_message(TIDY), "b")) is None
    strange = Message(MessageKind.TEAM, "", {"objects_to": 7, "reason": None}, "a", "b")
    assert read_objection(strange) == Objection("b", "a", None, "")
