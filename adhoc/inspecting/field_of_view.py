"""What a robot's camera covers, as an outline on the floor plan."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Observation

RAYS = 17
"""Points of an outline, from the left edge of the picture to its right edge."""
ROWS = 32
"""At most so many rows of a picture are looked at: an outline needs no more."""
CORNER = 2.0
"""The corner of a picture of 90 degrees is less than this much farther than its middle."""


def unit_of(reach: float) -> float:
    """Metres that one whole number of an outline stands for, of a camera that sees `reach` metres far."""
    return CORNER * reach / 127


def view_outline(observation: Observation, reach: float) -> NDArray[np.int8]:
    """How far the camera sees in `RAYS` columns of its picture: behind low things, but not through walls.

    Houses have no ceiling: what is seen above a wall is no part of the floor, and does not count.

    Args:
        observation: Its depth counts.
        reach: Metres along the optical axis within which something counts as seen.

    Returns:
        (RAYS, 2), from the robot, along the axes of the world, in units of `unit_of(reach)`.
    """
    height, width = observation.depth.shape
    columns = np.linspace(0, width - 1, RAYS).round().astype(int)
    rows = np.arange(0, height, max(1, height // ROWS))
    seen = observation.depth[np.ix_(rows, columns)].astype(np.float64)
    is_sky = ~np.isfinite(seen) & np.isfinite(seen).any(axis=0)
    depth = np.where(is_sky, 0.0, np.minimum(seen, reach))
    matrix, turn = observation.camera.intrinsics, observation.camera.world_from_camera[:2, :3]
    across = (columns - matrix[0, 2]) / matrix[0, 0] * depth
    down = (rows[:, None] - matrix[1, 2]) / matrix[1, 1] * depth
    x, y = (turn[axis, 0] * across + turn[axis, 1] * down + turn[axis, 2] * depth for axis in (0, 1))
    farthest = (x * x + y * y).argmax(axis=0), np.arange(RAYS)
    points = np.stack([x[farthest], y[farthest]], axis=-1) / unit_of(reach)
    return np.clip(points.round(), -127, 127).astype(np.int8)
