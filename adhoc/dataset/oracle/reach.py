"""From which cells a robot could reach a solid at best: near enough, and not behind a wall (numba)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.checks.box_arrays import FloatArray, box_arrays
from adhoc.houses.solids import Box, Solid, SolidKind

_SHORTER = 0.05
"""Walls are taken to be so much shorter, in metres, where they end at an opening: what is called hidden is
hidden for certain."""
_JOINED = 0.03
"""A wall that ends this near to another one, in metres, ends at no opening."""
_SPACING = 0.04
"""Metres between the points of an outline that are looked at, less than walls are shortened by."""
_LOW, _HIGH = 0.05, 2.0
"""A wall that begins below and ends above these heights, in metres, is looked over by no robot."""

Mask = NDArray[np.bool_]
Line = tuple[float, float, float, float]


def within_reach(boxes: Sequence[Box], points: FloatArray, reach: float) -> Mask:
    """The points (N,) from which some point of the boxes is at most `reach` metres away, horizontally."""
    arrays = box_arrays([boxes])
    near = np.zeros(len(points), np.bool_)
    for center, half, heading in zip(arrays.centers, arrays.halves, arrays.headings):
        dx, dy = points[:, 0] - center[0], points[:, 1] - center[1]
        beside = np.maximum(0.0, np.abs(heading[0] * dx + heading[1] * dy) - half[0])
        before = np.maximum(0.0, np.abs(heading[0] * dy - heading[1] * dx) - half[1])
        near |= np.hypot(beside, before) <= reach
    return near


class Walls:
    """The walls of a house, as lines of sight meet them on the floor plan."""

    def __init__(self, solids: Iterable[Solid]) -> None:
        lines = [
            _middle_line(box)
            for solid in solids
            if solid.kind is SolidKind.WALL
            for box in solid.boxes
            if box.center[2] - box.half[2] <= _LOW and box.center[2] + box.half[2] >= _HIGH
        ]
        self._segments = np.array([_shortened(line, lines) for line in lines], np.float64).reshape(-1, 4)

    def hide(self, boxes: Sequence[Box], points: FloatArray) -> Mask:
        """The points (N,) from which walls hide every point of the boxes, for certain."""
        outline = np.concatenate([_outline(box) for box in boxes])
        hidden = np.ones(len(points), np.bool_)
        _show(points, outline, self._segments, hidden)
        return hidden


def _middle_line(box: Box) -> Line:
    """The middle line of a wall's box on the floor plan."""
    along = box.yaw if box.half[0] >= box.half[1] else box.yaw + math.pi / 2
    length = max(box.half[:2])
    x, y = length * math.cos(along), length * math.sin(along)
    return box.center[0] - x, box.center[1] - y, box.center[0] + x, box.center[1] + y


def _shortened(line: Line, lines: Sequence[Line]) -> Line:
    """The line without a bit at each end that meets no other line."""
    ax, ay, bx, by = line
    length = math.hypot(bx - ax, by - ay)
    if length <= 2 * _SHORTER:
        return line
    x, y = _SHORTER * (bx - ax) / length, _SHORTER * (by - ay) / length
    others = [other for other in lines if other is not line]
    if not any(_distance(ax, ay, other) <= _JOINED for other in others):
        ax, ay = ax + x, ay + y
    if not any(_distance(bx, by, other) <= _JOINED for other in others):
        bx, by = bx - x, by - y
    return ax, ay, bx, by


def _distance(x: float, y: float, line: Line) -> float:
    ax, ay, bx, by = line
    squared = (bx - ax) ** 2 + (by - ay) ** 2
    along = min(1.0, max(0.0, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / squared)) if squared else 0.0
    return math.hypot(x - ax - along * (bx - ax), y - ay - along * (by - ay))


def _outline(box: Box) -> FloatArray:
    """Points (N, 2) on the outline of a box."""
    half_x, half_y = box.half[:2]
    across = np.linspace(-half_x, half_x, 2 + math.ceil(2 * half_x / _SPACING))
    along = np.linspace(-half_y, half_y, 2 + math.ceil(2 * half_y / _SPACING))
    sides = [
        *(np.stack([across, np.full_like(across, y)], axis=1) for y in (-half_y, half_y)),
        *(np.stack([np.full_like(along, x), along], axis=1) for x in (-half_x, half_x)),
    ]
    cosine, sine = math.cos(box.yaw), math.sin(box.yaw)
    turn = np.array([[cosine, sine], [-sine, cosine]])
    outline: FloatArray = np.concatenate(sides) @ turn + np.array(box.center[:2])
    return outline


@numba.njit(cache=True, nogil=True)
def _show(points: FloatArray, outline: FloatArray, segments: FloatArray, hidden: Mask) -> None:
    for point in range(points.shape[0]):
        x, y = points[point, 0], points[point, 1]
        for target in range(outline.shape[0]):
            to_x, to_y = outline[target, 0], outline[target, 1]
            free = True
            for wall in range(segments.shape[0]):
                ax, ay, bx, by = segments[wall, 0], segments[wall, 1], segments[wall, 2], segments[wall, 3]
                if (
                    _side(x, y, to_x, to_y, ax, ay) * _side(x, y, to_x, to_y, bx, by) <= 0.0
                    and _side(ax, ay, bx, by, x, y) * _side(ax, ay, bx, by, to_x, to_y) < 0.0
                ):
                    free = False
                    break
            if free:
                hidden[point] = False
                break


@numba.njit(cache=True, nogil=True)
def _side(ax: float, ay: float, bx: float, by: float, x: float, y: float) -> float:
    """On which side of the line from a to b a point lies, by its sign."""
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax)
