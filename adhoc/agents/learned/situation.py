"""What a sub-skill is chosen by: a robot's own state, its detections, and what it knows of the others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from adhoc.core.values import Capability, Pose

Spot = tuple[float, float]
"""x and y in metres, in the world frame."""


@dataclass(frozen=True)
class OwnState:
    """The robot's abilities, where it is, and what it is at (paper, appendix 'Learning-based Policy')."""

    name: str
    capability: Capability
    pose: Pose
    step: int
    steps_left: int
    """Actions that the battery still pays for."""
    holding: bool
    place_known: bool
    """Whether it knows a place for what it holds that it has not tried in vain."""
    idle: bool
    """Whether it found nothing left to explore when it last tried."""
    frontiers: int
    rooms_known: int
    rooms_explored: int
    room_types: Mapping[str, float] = field(default_factory=dict)
    """Probability of each room type for the room that it is in; empty while that is unknown."""

    @property
    def position(self) -> Spot:
        return (self.pose.x, self.pose.y)


@dataclass(frozen=True)
class Detection:
    """An object that was judged misplaced, by itself or by a teammate, and that nobody holds."""

    id: str
    position: Spot
    mass: float
    last_seen: int
    handled: bool
    """Whether another robot is after it."""
    given_up: bool
    """Whether this robot tried it in vain and leaves it for now."""
    certainty: float
    """Probability of the likeliest type of the room that it is in: the judgement depends on the type."""


@dataclass(frozen=True)
class Other:
    """Another robot of the team, as its latest message has it."""

    name: str
    position: Spot | None
    capability: Capability
    busy: bool
    """Whether it is after an object or holds one."""
    idle: bool
    """Whether it has nothing left to explore."""
    stopped: bool
    unable: frozenset[str] = frozenset()
    """Objects that it tried in vain."""


@dataclass(frozen=True)
class Situation:
    """One robot at one moment; any number of detections and others, in any order."""

    own: OwnState
    detections: tuple[Detection, ...] = ()
    others: tuple[Other, ...] = ()
