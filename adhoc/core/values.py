"""The values that robots and worlds exchange.

All are frozen. Units: metres, radians, kilograms, steps. Frames: see `core.geometry`. They map to the
paper's 5-tuple (section Problem Formulation): state S (`Observation`), capability C (`Capability`),
action A (`Action`); messages M are in `core.messages`, memory H in `core.plans.Context`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Pose:
    """Where a robot stands and looks: x, y in metres; yaw and pitch in radians (pitch > 0 looks down)."""

    x: float
    y: float
    yaw: float = 0.0
    pitch: float = 0.0


@dataclass(frozen=True)
class Capability:
    """What a robot can do: the paper's tuple (navigation, manipulation, height, payload, battery)."""

    can_navigate: bool = True
    can_manipulate: bool = True
    camera_height: float = 1.6
    """Metres above the floor: 0.9 (low) or 1.6 (high) in the paper; any positive value works."""
    payload: float = 20.0
    """The heaviest object, in kilograms, that the robot can pick up."""
    max_steps: int = 500
    """The number of actions that a full battery pays for."""


class ActionName(str, Enum):
    """The paper's twelve low-level actions (appendix, Implementation Details)."""

    MOVE_AHEAD = "MoveAhead"
    MOVE_BACK = "MoveBack"
    MOVE_RIGHT = "MoveRight"
    MOVE_LEFT = "MoveLeft"
    ROTATE_RIGHT = "RotateRight"
    ROTATE_LEFT = "RotateLeft"
    LOOK_UP = "LookUp"
    LOOK_DOWN = "LookDown"
    STOP = "Stop"
    PICK_UP = "PickUp"
    PUT_DOWN = "PutDown"
    DROP = "Drop"


MANIPULATION = frozenset({ActionName.PICK_UP, ActionName.PUT_DOWN, ActionName.DROP})
"""The actions that need a manipulator; the others need navigation (Stop needs nothing)."""


@dataclass(frozen=True)
class Action:
    """One low-level action. `target` is the object id of PickUp or the receptacle id of PutDown."""

    name: ActionName
    target: str | None = None

    def __str__(self) -> str:
        return self.name.value if self.target is None else f"{self.name.value} {self.target}"


class Failure(str, Enum):
    """Why a world refused an action. The value is the sentence that a person or a model reads."""

    NO_NAVIGATION = "the robot has no navigation ability"
    NO_MANIPULATION = "the robot has no manipulation ability"
    TOO_HEAVY = "the object is heavier than the robot's payload"
    TOO_FAR = "the target is too far away"
    NOT_VISIBLE = "the target is not visible"
    HAND_FULL = "the robot already holds an object"
    HAND_EMPTY = "the robot holds nothing"
    NOT_PICKUPABLE = "the object cannot be picked up"
    NOT_A_RECEPTACLE = "the target is not a receptacle"
    NO_FREE_PLACE = "there is no free place for the object"
    BLOCKED = "the way is blocked"
    LOOK_LIMIT = "the camera cannot tilt further"
    OUT_OF_BATTERY = "the battery is empty"
    STOPPED = "the robot has stopped"
    NO_TARGET = "the action names no target"


@dataclass(frozen=True)
class ActionResult:
    """What became of an action: done (`failure` is None), or refused with a reason and its detail."""

    action: Action
    failure: Failure | None = None
    detail: str = ""

    @property
    def ok(self) -> bool:
        return self.failure is None


@dataclass(frozen=True, eq=False)
class Camera:
    """A pinhole camera: `intrinsics` (3, 3) and `world_from_camera` (4, 4)."""

    intrinsics: NDArray[np.float64]
    world_from_camera: NDArray[np.float64]


@dataclass(frozen=True)
class Label:
    """What instance segmentation says of one instance in the frame: its id and its category."""

    id: str
    category: str


@dataclass(frozen=True, eq=False)
class Observation:
    """What one robot perceives at one step. `labels` holds the instances in the frame and no others.

    depth (H, W) float32, metres along the optical axis, inf where nothing is hit;
    instances (H, W) int32, keys of `labels`, -1 where nothing is hit; rgb (H, W, 3) uint8 or None.
    """

    step: int
    depth: NDArray[np.float32]
    instances: NDArray[np.int32]
    labels: Mapping[int, Label]
    camera: Camera
    pose: Pose
    held: str | None
    """The id of the object in the hand."""
    steps_left: int
    """Actions that the battery still pays for."""
    last_result: ActionResult | None
    """What became of the previous action; None at the first step."""
    rgb: NDArray[np.uint8] | None = None


@dataclass(frozen=True)
class ObjectRecord:
    """What a robot knows of one object, by its own detection or by a teammate's word."""

    id: str
    category: str
    position: Point
    room: str | None = None
    """Id of the room it is in; None while unknown."""
    receptacle: str | None = None
    """Id of the receptacle it is in or on, `Floor`, or None while unknown."""
    receptacle_category: str | None = None
    """Category of that receptacle (`Floor` for the floor); None while unknown."""
    misplaced: bool | None = None
    """The robot's own judgement, or a teammate's; None while undecided or not applicable."""
    mass: float = 0.0
    """Kilograms, as expected of the category (a camera cannot weigh)."""
    is_receptacle: bool = False
    is_pickupable: bool = False
    last_seen: int = 0
    """Step of the last detection or report."""
    source: str = "me"
    """Who detected it: `me`, or a teammate's name."""


@dataclass(frozen=True)
class RoomRecord:
    """What a robot knows of one room."""

    id: str
    room_type: str | None = None
    """Inferred from the detected categories; None while undecided."""
    position: tuple[float, float] = (0.0, 0.0)
    """A point of the room, in metres, to navigate to."""
    explored: bool = False
    explored_by: str | None = None
    """`me` or a teammate's name, where `explored`."""


@dataclass(frozen=True)
class Place:
    """A kind of place where an object may belong: a receptacle category in a room type."""

    receptacle: str
    room_type: str
