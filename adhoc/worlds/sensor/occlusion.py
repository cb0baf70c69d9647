"""Whether boxes could show in a picture at all: a cheap test before a picture is copied and drawn over."""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.worlds.sensor.ray_casting import NEAREST

_SLACK = 1e-5

Floats = NDArray[np.float64]


@numba.njit(cache=True, nogil=True)
def may_show(
    centers: Floats,
    halves: Floats,
    instances: NDArray[np.int32],
    layers: NDArray[np.uint8],
    asked_layers: int,
    own_instance: int,
    intrinsics: Floats,
    world_from_camera: Floats,
    depth: NDArray[np.float32],
) -> bool:
    """Whether any box of some layers may be in front of what a picture shows.

    True is a guess, from upright cylinders around the boxes; False is certain: `cast_boxes`, which
    explains the arguments, would leave the picture unchanged.
    """
    height, width = depth.shape
    ahead_z, down_z = abs(world_from_camera[2, 2]), abs(world_from_camera[2, 1])
    ahead_level = math.sqrt(max(1.0 - ahead_z * ahead_z, 0.0)) + _SLACK
    down_level = math.sqrt(max(1.0 - down_z * down_z, 0.0)) + _SLACK
    for box in range(centers.shape[0]):
        if (layers[box] & asked_layers) == 0 or instances[box] == own_instance:
            continue
        right, down, ahead = 0.0, 0.0, 0.0
        for axis in range(3):
            offset = centers[box, axis] - world_from_camera[axis, 3]
            right += offset * world_from_camera[axis, 0]
            down += offset * world_from_camera[axis, 1]
            ahead += offset * world_from_camera[axis, 2]
        around = math.sqrt(halves[box, 0] ** 2 + halves[box, 1] ** 2) + _SLACK
        tall = halves[box, 2] + _SLACK
        deep, high = ahead_level * around + ahead_z * tall, down_level * around + down_z * tall
        nearest, farthest = ahead - deep, ahead + deep
        if farthest < NEAREST:
            continue
        if nearest < NEAREST:
            return True
        left, last_column = _pixels(
            right, around, nearest, farthest, intrinsics[0, 0], intrinsics[0, 2], width
        )
        top, last_row = _pixels(down, high, nearest, farthest, intrinsics[1, 1], intrinsics[1, 2], height)
        for row in range(top, last_row + 1):
            for column in range(left, last_column + 1):
                if depth[row, column] > nearest * (1.0 - _SLACK):
                    return True
    return False


@numba.njit(cache=True, nogil=True)
def _pixels(
    middle: float, half: float, nearest: float, farthest: float, focal: float, center: float, count: int
) -> tuple[int, int]:
    """First and last column (or row) that something between two depths can cover; none if first > last."""
    low, high = middle - half, middle + half
    low = low / (nearest if low < 0.0 else farthest) * focal + center
    high = high / (farthest if high < 0.0 else nearest) * focal + center
    if high < 0.0 or low > count - 1.0:
        return 1, 0
    return int(max(low, 0.0)), int(min(high + 1.0, count - 1.0))
