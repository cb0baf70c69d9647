"""Stances: a cell, one of four headings and one of four tilts of the camera, as one number.

A stance is `16 * cell + 4 * heading + tilt`; heading counts quarter turns counter-clockwise from +x, tilt
counts from 30 degrees up (0) to 60 degrees down (3).
"""

from __future__ import annotations

import math
from enum import IntEnum

from adhoc.core.values import Action, ActionName, Pose

AIMS = 16
"""Stances a cell."""
TILTS = 4
HEADINGS = 4
LEVEL = 1
"""The tilt of a camera that looks straight ahead."""
TILT_STEP = math.pi / 6
_ALIGNED = 1e-3


class Deed(IntEnum):
    """What a robot does in one step of a route. The first four are the moves of `lattice_parts.MOVES`."""

    EAST = 0
    WEST = 1
    NORTH = 2
    SOUTH = 3
    TURN_LEFT = 4
    TURN_RIGHT = 5
    LOOK_DOWN = 6
    LOOK_UP = 7
    WAIT = 8
    ACT = 9


_QUARTER_OF_MOVE = (0, 2, 1, 3)
_MOVES = (ActionName.MOVE_AHEAD, ActionName.MOVE_LEFT, ActionName.MOVE_BACK, ActionName.MOVE_RIGHT)
_TURNS = {
    Deed.TURN_LEFT: ActionName.ROTATE_LEFT,
    Deed.TURN_RIGHT: ActionName.ROTATE_RIGHT,
    Deed.LOOK_DOWN: ActionName.LOOK_DOWN,
    Deed.LOOK_UP: ActionName.LOOK_UP,
}


def aim_of(pose: Pose) -> int | None:
    """The heading and tilt of a pose as a number below 16; None if they are not on the grid."""
    quarters, tilts = pose.yaw / (math.pi / 2), pose.pitch / TILT_STEP
    heading, tilt = round(quarters), round(tilts) + LEVEL
    if max(abs(quarters - heading), abs(tilts + LEVEL - tilt)) > _ALIGNED or not 0 <= tilt < TILTS:
        return None
    return TILTS * (heading % HEADINGS) + tilt


def pose_of(point: tuple[float, float], aim: int) -> Pose:
    """The pose of a robot that stands at a point with that aim."""
    heading, tilt = divmod(aim, TILTS)
    return Pose(point[0], point[1], heading * math.pi / 2, (tilt - LEVEL) * TILT_STEP)


def action_of(deed: Deed, heading: int) -> Action | None:
    """The action that carries out a deed of motion at a heading; None for waiting."""
    if deed is Deed.WAIT:
        return None
    if deed in _TURNS:
        return Action(_TURNS[deed])
    return Action(_MOVES[(_QUARTER_OF_MOVE[deed] - heading) % 4])
