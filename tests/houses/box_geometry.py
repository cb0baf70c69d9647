"""Plain geometry of boxes for tests, independent of the library's."""

from __future__ import annotations

import math

import numpy as np


def axes(box):
    """The box's own axes as rows."""
    cos_yaw, sin_yaw = math.cos(box.yaw), math.sin(box.yaw)
    return np.array([[cos_yaw, sin_yaw, 0.0], [-sin_yaw, cos_yaw, 0.0], [0.0, 0.0, 1.0]])


def penetration(first, second):
    """How deep two boxes are in each other, in metres; negative or zero when apart (separating axes)."""
    offset = np.subtract(second.center, first.center)
    depths = [
        abs(axes(first) @ axis) @ np.array(first.half)
        + abs(axes(second) @ axis) @ np.array(second.half)
        - abs(offset @ axis)
        for axis in (*axes(first), *axes(second))
    ]
    return min(depths)


def holds(box, points):
    """Which of the (N, 3) points are strictly inside the box."""
    local = (np.asarray(points) - box.center) @ axes(box).T
    return (np.abs(local) < np.array(box.half) - 1e-9).all(axis=1)


def blocked(eye, points, boxes):
    """Which of the straight lines from the eye to the (N, 3) points pass through a box."""
    hit = np.zeros(len(points), bool)
    for box in boxes:
        start = axes(box) @ (np.asarray(eye) - box.center)
        way = (np.asarray(points) - box.center) @ axes(box).T - start
        way = np.where(np.abs(way) < 1e-12, 1e-12, way)
        near, far = (-np.array(box.half) - start) / way, (np.array(box.half) - start) / way
        enter = np.minimum(near, far).max(axis=1)
        leave = np.maximum(near, far).min(axis=1)
        hit |= (enter < leave) & (leave > 1e-9) & (enter < 1 - 1e-6)
    return hit


def skin(box, count=5):
    """Points just outside every face of the box: (6 * count ** 2, 3)."""
    spread = np.linspace(-0.9, 0.9, count)
    a, b = (grid.ravel() for grid in np.meshgrid(spread, spread))
    faces = []
    for axis in range(3):
        for side in (-1.002, 1.002):
            face = np.empty((len(a), 3))
            face[:, axis], face[:, (axis + 1) % 3], face[:, (axis + 2) % 3] = side, a, b
            faces.append(face)
    return np.concatenate(faces) * np.array(box.half) @ axes(box) + box.center
