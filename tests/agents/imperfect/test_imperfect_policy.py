from __future__ import annotations

from dataclasses import replace

import pytest

from adhoc.agents.imperfect.imperfect_policy import ImperfectPolicy
from adhoc.agents.policy import Policy, Turn
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName, Capability
from adhoc.tasks.tidying_up import TidyingUp


class Speaker(Policy):
    """Says one thing of every kind, and answers in kind."""

    acts_apart = True

    def reset(self, me, capability, task, seed, ask):
        self.given = (me, capability, task, seed, ask)

    def act(self, observation, inbox):
        said = tuple(Message(kind, "hello", recipient="you") for kind in MessageKind)
        return Turn(Action(ActionName.ROTATE_LEFT), said, {"heard": len(inbox)})

    def respond(self, message):
        return None if message.kind is MessageKind.JOIN else Message(message.kind, "hello")


class Loud(ImperfectPolicy):
    def tells(self, report):
        return replace(report, text=report.text.upper())


@pytest.mark.parametrize("fault", [Loud, ImperfectPolicy])
def test_a_fault_touches_public_reports_alone(fault):
    turn = fault(Speaker()).act(object(), [Message(MessageKind.TEAM, "x")] * 3)
    loud = {it.kind.value for it in turn.outbox if it.text == "HELLO"}
    assert loud == ({"reflected", "reply", "task_state", "detection"} if fault is Loud else set())
    assert [it.kind for it in turn.outbox] == list(MessageKind)
    assert {it.recipient for it in turn.outbox} == {"you"}
    assert (turn.action, turn.trace) == (Action(ActionName.ROTATE_LEFT), {"heard": 3})


def test_answers_are_reports_and_silence_stays_silence():
    loud = Loud(Speaker())
    assert loud.respond(Message(MessageKind.REPLY, "?")).text == "HELLO"
    assert loud.respond(Message(MessageKind.TEAM, "?")).text == "hello"
    assert loud.respond(Message(MessageKind.JOIN, "?")) is None


def test_the_policy_is_told_what_its_robot_is_told():
    loud, task = Loud(Speaker()), TidyingUp()
    given = ("me", Capability(), task, 4, len)
    loud.reset(*given)
    assert loud.policy.given == given
    assert loud.acts_apart is True
