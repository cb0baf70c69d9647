"""The pre-defined teams that PLASTIC learns (paper, section 'PLASTIC Policy', which does not name them)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.learned.decision import SubSkillKind
from adhoc.agents.learned.policy import LearnedPolicy
from adhoc.agents.learned.situation import Situation
from adhoc.agents.policy import Policy
from adhoc.agents.specialists.explore_only import ExploreOnlyPolicy
from adhoc.agents.specialists.nearest_first import NearestFirstPolicy
from adhoc.agents.specialists.room_by_room import RoomByRoomPolicy
from adhoc.core.errors import ConfigurationError
from adhoc.training.expert import Expert


@dataclass(frozen=True)
class TeamType:
    """One pre-defined team.

    `make` makes the policy of a member; it is sent to other processes, so it is a class, a function of a
    module, or a `functools.partial` of one. `replaces` says whether members ever re-place anything.
    """

    make: Callable[[], Policy]
    replaces: bool = True


TYPE_NAMES = ("heuristic", "learned", "explore_only", "nearest_first", "room_by_room")
"""Of the pre-defined teams."""


def team_types(
    names: Sequence[str] = TYPE_NAMES, team_checkpoints: str | None = None
) -> Mapping[str, TeamType]:
    """The pre-defined teams of these names.

    `team_checkpoints` is the folder of the learned team's checkpoints, None for the shipped one. Raises
    ConfigurationError for an unknown name.
    """
    known = {
        "heuristic": TeamType(HeuristicPolicy),
        "learned": TeamType(partial(LearnedPolicy, checkpoints=team_checkpoints)),
        "explore_only": TeamType(ExploreOnlyPolicy, replaces=False),
        "nearest_first": TeamType(NearestFirstPolicy),
        "room_by_room": TeamType(RoomByRoomPolicy),
    }
    for name in names:
        if name not in known:
            raise ConfigurationError(f"type {name!r} of team: must be one of {', '.join(known)}")
    return {name: known[name] for name in names}


class ExpertBeside:
    """What is right for a newcomer beside a team of a known type.

    It is what the learned team's expert says, but for this: beside a team that never re-places anything,
    an object does not wait for a teammate that is closer.

    Args:
        expert: Knows the metadata of the task.
        team: The type of the team.
    """

    def __init__(self, expert: Expert, team: TeamType) -> None:
        self._expert, self._team = expert, team

    def __call__(self, situation: Situation) -> SubSkillKind:
        """The right kind of sub-skill."""
        if self._team.replaces:
            return self._expert(situation)
        handless = (
            replace(it, capability=replace(it.capability, can_manipulate=False)) for it in situation.others
        )
        return self._expert(replace(situation, others=tuple(handless)))
