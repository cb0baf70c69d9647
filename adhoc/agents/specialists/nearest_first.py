"""A robot that goes for whatever is nearest, each for itself."""

from __future__ import annotations

from functools import partial

from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.core.geometry import planar_distance
from adhoc.skills.explore import Explore
from adhoc.skills.library import standard_skills


class NearestFirstPolicy(HeuristicPolicy):
    """Takes the misplaced object nearest to itself, whoever else is nearer or after it already; else explores
    the nearest frontier, however small and however close to a teammate.

    Where a heuristic team divides the work, the robots of this one get into each other's way: several may
    run for one object, and the late ones find it gone.

    Args:
        member: Whether the robot belongs to the original team (see `HeuristicPolicy`).
        search_skill: The sub-skill that explores.
        attempts: How often an object is tried; then it is left to others.
        retry_after: Steps before an object is tried again.
    """

    def __init__(
        self, member: bool = True, search_skill: str = "Explore", attempts: int = 3, retry_after: int = 30
    ) -> None:
        explore = partial(Explore, size_bonus=0.0, crowd_penalty=0.0)
        super().__init__(
            member=member,
            skills={**standard_skills(), "Explore": explore},
            search_skill=search_skill,
            attempts=attempts,
            retry_after=retry_after,
        )

    def _choose_object(self) -> str | None:
        unable = self._unable_now()
        payload = self._capability.payload if self._by_hand else float("inf")
        possible = [
            (round(planar_distance(self._position, record.position), 3), record.id)
            for record in self._memory.attention()
            if record.id not in unable and record.mass <= payload
        ]
        return min(possible)[1] if possible else None
