"""The contract of a skill: the controller of one sub-skill."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass

from adhoc.core.calls import Call
from adhoc.core.values import Action, Capability, ObjectRecord, Observation, RoomRecord
from adhoc.perception.semantic_map import SemanticMap
from adhoc.skills.navigator import Navigator


@dataclass(frozen=True, eq=False)
class SkillView:
    """What a skill may look at in one step: the robot's own perception and memory, no ground truth."""

    observation: Observation
    map: SemanticMap
    navigator: Navigator
    capability: Capability
    objects: Mapping[str, ObjectRecord]
    rooms: Mapping[str, RoomRecord]
    focus_room: str | None = None
    """The room that the current sub-task is about, where it names one."""
    others: tuple[tuple[float, float], ...] = ()
    """Where teammates are or are heading, in metres; exploration keeps away from there."""


class Skill(ABC):
    """Turns one sub-skill into low-level actions, one a step (paper, section Sub-skill Execution).

    One instance serves one robot and is started anew for every call.
    """

    failure: str | None = None
    """After `step` returned None: why the sub-skill failed, or None if it succeeded."""

    @abstractmethod
    def start(self, call: Call, view: SkillView) -> None:
        """Begin `call`; forgets the previous one and clears `failure`."""

    @abstractmethod
    def step(self, view: SkillView) -> Action | None:
        """The next action, or None when finished (then see `failure`). Must finish on its own: a skill
        bounds its number of actions."""
