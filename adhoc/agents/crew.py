"""What the members of an LLM-based team say to each other in private: their plans, and objections to them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from adhoc.agents.communication import call_payload, read_call
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Objection


def plan_message(
    sub_task: Call | None, stopped: bool = False, revised: Mapping[str, Call] | None = None
) -> Message:
    """What a member is at; said at every step, and to all when it has planned. `revised` are the plans that
    others made again because it objected."""
    text = f"I plan: {sub_task}" if sub_task is not None else "I have no plan"
    plans = {name: call_payload(plan) for name, plan in (revised or {}).items()}
    payload = {"plan": call_payload(sub_task), "stopped": stopped, "revised": plans}
    return Message(MessageKind.TEAM, text, payload)


def objection_message(objection: Objection) -> Message:
    """Asks the member whose plan it is to plan again; its answer is its plan."""
    payload = {"objects_to": call_payload(objection.sub_task), "reason": objection.reason}
    text = f"I object to {objection.sub_task}: {objection.reason}"
    return Message(MessageKind.TEAM, text, payload, recipient=objection.planner)


def read_objection(message: Message) -> Objection | None:
    """What `objection_message` wrote; None for anything else."""
    reason = message.payload.get("reason")
    if message.kind is not MessageKind.TEAM or "objects_to" not in message.payload:
        return None
    sub_task = read_call(message.payload["objects_to"])
    return Objection(
        message.sender, message.recipient or "", sub_task, reason if isinstance(reason, str) else ""
    )


_FIELDS = frozenset({"plan", "stopped", "revised"})


class Crew:
    """The latest plans of the other members of the team, by their own word.

    Members speak at every step; one that was silent for `patience` steps is broken. A stranger's message of
    the same kind makes it no member unless it has the same form.
    """

    def __init__(self, patience: int = 5) -> None:
        self._patience = patience
        self._plans: dict[str, Call | None] = {}
        self._stopped: dict[str, bool] = {}
        self._heard: dict[str, int] = {}
        self._said: dict[str, int] = {}

    def hear(self, message: Message, step: int) -> None:
        """Take in one message of that step; whatever is no plan of a member is left alone."""
        payload: Mapping[str, Any] = message.payload
        if message.kind is not MessageKind.TEAM or payload.keys() != _FIELDS:
            return
        if message.step < self._said.get(message.sender, -1):
            return  # What was said later was heard at once, since it was said to all before they planned.
        self._said[message.sender] = message.step
        self._set(message.sender, payload["plan"])
        self._stopped[message.sender] = payload["stopped"] is True
        self._heard[message.sender] = step

        revised = payload["revised"]
        for name, plan in revised.items() if isinstance(revised, Mapping) else ():
            if self.is_member(name) and message.step >= self._said[name]:
                self._set(name, plan)

    def hear_all(self, inbox: Sequence[Message], step: int) -> None:
        """Take in what arrived at that step."""
        for message in inbox:
            self.hear(message, step)

    def plans(self, step: int) -> dict[str, Call]:
        """The plans of the members that are at work, those made last at the end."""
        broken = self.broken(step)
        return {
            name: plan
            for name, plan in self._plans.items()
            if plan is not None and not self._stopped[name] and name not in broken
        }

    def broken(self, step: int) -> tuple[str, ...]:
        """The members that fell silent without having stopped, in alphabetical order."""
        return tuple(
            sorted(
                name
                for name, heard in self._heard.items()
                if heard < step - self._patience and not self._stopped[name]
            )
        )

    def heard(self, name: str) -> int:
        """The step at which that member was last heard."""
        return self._heard[name]

    def is_member(self, name: str) -> bool:
        """Whether that robot has ever told a plan of the team."""
        return name in self._heard

    def _set(self, name: str, payload: Any) -> None:
        """Note a plan; one that is new becomes the last."""
        plan = read_call(payload)
        if self._plans.get(name) != plan:
            self._plans.pop(name, None)
        self._plans[name] = plan
