"""A policy with a fault: around any policy, which knows nothing of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import replace

from adhoc.agents.dialects.speaking import Speaking
from adhoc.agents.policy import Ask, Policy, Turn
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Capability, Observation
from adhoc.perception.semantic_map import SemanticMap
from adhoc.tasks.task import Task

PUBLIC_REPORTS = frozenset(
    {MessageKind.REFLECTED, MessageKind.REPLY, MessageKind.TASK_STATE, MessageKind.DETECTION}
)
"""What a robot tells everybody, or whoever asked. What a team says to itself is in a format that is its own
affair, and an intention is not told but asked."""


class ImperfectPolicy(Policy):
    """Decides as `policy` does, by what the fault lets it see and judge, and says what the fault makes of it.

    A fault overrides `sees`, `judges_by` or `tells`; what it does not override is without fault. It may draw
    from streams of its own, named after the robot (`core.streams`).
    """

    def __init__(self, policy: Policy) -> None:
        self.policy = policy
        self.acts_apart = policy.acts_apart
        self._sight: tuple[Observation, Observation] | None = None

    def sees(self, observation: Observation) -> Observation:
        """What the robot takes its observation for."""
        return observation

    def judges_by(self, task: Task) -> Task:
        """What the robot takes its task for."""
        return task

    def tells(self, report: Message) -> Message:
        """What it says in place of one of its `PUBLIC_REPORTS`."""
        return report

    @property
    def map(self) -> SemanticMap | None:
        """See `Policy`."""
        return self.policy.map

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self.me, self.seed, self._sight = me, seed, None
        self.policy.reset(me, capability, self.judges_by(task), seed, ask)

    def confer(self, observation: Observation, inbox: Sequence[Message]) -> None:
        """See `Policy`."""
        self.policy.confer(self._seen(observation), inbox)

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`."""
        turn = self.policy.act(self._seen(observation), inbox)
        return replace(turn, outbox=tuple(map(self._told, turn.outbox)))

    def respond(self, message: Message) -> Message | None:
        """See `Policy`."""
        answer = self.policy.respond(message)
        return None if answer is None else self._told(answer)

    def _seen(self, observation: Observation) -> Observation:
        """What is seen of an observation; both parts of a step see the same."""
        if self._sight is None or self._sight[0] is not observation:
            self._sight = (observation, self.sees(observation))
        return self._sight[1]

    def _told(self, message: Message) -> Message:
        return self.tells(message) if message.kind in PUBLIC_REPORTS else message


def with_fault(policy: Policy, fault: Callable[[Policy], Policy]) -> Policy:
    """The policy with a fault, below the dialect that it speaks: lies are told in it too."""
    if not isinstance(policy, Speaking):
        return fault(policy)
    speaking = copy(policy)
    speaking.policy = with_fault(policy.policy, fault)
    return speaking
