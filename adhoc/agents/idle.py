"""A newcomer that does nothing: the control of every comparison."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.agents.policy import Ask, Policy, Turn
from adhoc.core.messages import Message
from adhoc.core.values import Action, ActionName, Capability, Observation
from adhoc.tasks.task import Task


class IdlePolicy(Policy):
    """Stops at once where it joins, and neither says nor answers anything.

    It is not in the paper. What a team gains or loses beside it comes of one more body in the way alone, so
    it tells how much of another newcomer's improvement is more than that.
    """

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`."""
        return Turn(Action(ActionName.STOP))
