"""Rays and boxes by the textbook, one at a time: what the fast ray-caster is judged by."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from adhoc.houses.solids import Box


def depth_bounds(boxes: Iterable[Box], eye, ray) -> tuple[float, float]:
    """The least and the greatest depth that are right: a ray along an edge may fall on either side of it."""
    larger = [resized(box, 1e-5) for box in boxes]
    smaller = [resized(box, -1e-5) for box in boxes]
    return tuple(min(slab_test(box, eye, ray) for box in group) for group in (larger, smaller))


def slab_test(box, origin, direction):
    """Where a ray meets a box, by the textbook, in units of the direction; inf if it misses."""
    cosine, sine = math.cos(box.yaw), math.sin(box.yaw)
    near, far = -math.inf, math.inf
    turn = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    start, along = turn @ (origin - np.array(box.center)), turn @ direction
    for axis in range(3):
        if along[axis] == 0.0:
            if abs(start[axis]) > box.half[axis]:
                return math.inf
            continue
        first, second = sorted((side * box.half[axis] - start[axis]) / along[axis] for side in (-1, 1))
        near, far = max(near, first), min(far, second)
    return near if 0.0 < near <= far else math.inf


def holds(box, point, margin):
    """Whether the point is inside the box, or within `margin` of it along each axis."""
    cosine, sine = math.cos(box.yaw), math.sin(box.yaw)
    dx, dy, dz = (point[axis] - box.center[axis] for axis in range(3))
    local = (cosine * dx + sine * dy, cosine * dy - sine * dx, dz)
    return all(abs(local[axis]) < box.half[axis] + margin for axis in range(3))


def resized(box, change):
    return Box(box.center, tuple(half + change for half in box.half), box.yaw)
