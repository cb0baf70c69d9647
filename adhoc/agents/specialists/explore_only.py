"""A robot that only explores, whatever its hands could do."""

from __future__ import annotations

from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.policy import Ask
from adhoc.core.values import Capability
from adhoc.tasks.task import Task


class ExploreOnlyPolicy(HeuristicPolicy):
    """Explores with its team, tells what it finds, re-places nothing, and stops when all is explored.

    A team of such robots can never finish the task by itself: it is a type of team that a newcomer must be
    able to recognise (paper, 'PLASTIC Policy': 'several pre-defined teams', which it does not name). Its
    robots may well have hands; what they say of their capability is true.

    Args:
        member: Whether the robot belongs to the original team (see `HeuristicPolicy`).
        search_skill: The sub-skill that explores.
    """

    def __init__(self, member: bool = True, search_skill: str = "Explore") -> None:
        super().__init__(member=member, search_skill=search_skill)

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        super().reset(me, capability, task, seed, ask)
        self._able = False
