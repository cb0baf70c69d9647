"""Where in a free rectangle of a room furniture is put: in a corner, at an edge, or in the middle.

The margins and probabilities are ProcTHOR's unless said otherwise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from adhoc.houses.facts_furniture import CORNER, EDGE, MIDDLE
from adhoc.houses.floor_plan import Rectangle, contains, edges
from adhoc.houses.house import Corner

EDGE_RATHER_THAN_MIDDLE = 0.7
FRONT, AROUND = 0.5, 0.35
"""Metres kept free in front of pieces at walls, and around those in the middle."""
WALL_GAP = 0.025
"""Metres between a piece and the middle line of its wall."""
BESIDE = 0.015
"""Metres kept free beside pieces, where a wall of half that thickness may be. Our own."""

_SAME = 1e-6
_TURN_OF_SIDE = {(0, -1): 0, (1, 0): 1, (0, 1): 2, (-1, 0): 3}
"""Quarter turns of a piece that stands with its back to that side."""


@dataclass(frozen=True)
class Anchor:
    """A place in a free rectangle: in a corner or at an edge of the room, or anywhere in the middle.

    `sides` are the walls that a piece stands at: (-1, 0) for the one on the lower x side, and so on.
    """

    kind: str
    sides: tuple[tuple[int, int], ...]

    def turns(self, width: float, depth: float, rectangle: Rectangle) -> list[int]:
        """The quarter turns in which something of that size may stand here, off all walls."""
        across, along = rectangle[2] - rectangle[0] - 2 * WALL_GAP, rectangle[3] - rectangle[1] - 2 * WALL_GAP
        turns = range(4) if self.kind == MIDDLE else [_TURN_OF_SIDE[side] for side in self.sides]
        return [
            turn
            for turn in turns
            if (width < across and depth < along and turn % 2 == 0)
            or (depth < across and width < along and turn % 2 == 1)
        ]

    def admits(self, sizes: NDArray[np.float64], rectangle: Rectangle) -> NDArray[np.bool_]:
        """Which sizes (n, 2), width and depth, fit into the rectangle with their margins."""
        across, along = rectangle[2] - rectangle[0], rectangle[3] - rectangle[1]
        beside, before = 2 * BESIDE, FRONT + 2 * WALL_GAP
        if self.kind == MIDDLE:
            beside = before = 2 * AROUND
        elif self.kind == CORNER:
            beside = 2 * WALL_GAP
        width, depth = sizes[:, 0] + beside, sizes[:, 1] + before
        upright = (width < across) & (depth < along)
        lying = (depth < across) & (width < along)
        if self.kind != EDGE:
            return np.asarray(upright | lying)
        return upright if self.sides[0][0] == 0 else lying

    def middle(
        self, rectangle: Rectangle, extent: tuple[float, float], generator: Generator
    ) -> tuple[float, float]:
        """The middle of something of that extent along x and y that stands here."""
        x0, y0, x1, y1 = rectangle
        x = _along(x0, x1, extent[0], [sx for sx, _ in self.sides if sx], generator)
        y = _along(y0, y1, extent[1], [sy for _, sy in self.sides if sy], generator)
        return x, y

    def with_margin(self, footprint: Rectangle, turn: int) -> Rectangle:
        """The footprint of what stands here with what is kept free around it."""
        x0, y0, x1, y1 = footprint
        if self.kind == MIDDLE:
            return x0 - AROUND, y0 - AROUND, x1 + AROUND, y1 + AROUND
        back, beside = 2 * WALL_GAP, BESIDE
        margins = ((beside, back, beside, FRONT), (FRONT, beside, back, beside))[turn % 2]
        if turn >= 2:
            margins = (margins[2], margins[3], margins[0], margins[1])
        return x0 - margins[0], y0 - margins[1], x1 + margins[2], y1 + margins[3]


def draw_anchor(polygon: Sequence[Corner], rectangle: Rectangle, generator: Generator) -> Anchor:
    """A place in a rectangle of a room: in a corner of the room if it has one, else mostly at an edge."""
    x0, y0, x1, y1 = rectangle
    corners = [
        Anchor(CORNER, ((sx, 0), (0, sy)))
        for x, sx in ((x0, -1), (x1, 1))
        for y, sy in ((y0, -1), (y1, 1))
        if _is_convex_corner(polygon, (x, y))
    ]
    if corners:
        return corners[int(generator.integers(len(corners)))]
    at_walls = [
        Anchor(EDGE, (side,))
        for start, end, side in (
            ((x0, y0), (x1, y0), (0, -1)),
            ((x0, y0), (x0, y1), (-1, 0)),
            ((x1, y0), (x1, y1), (1, 0)),
            ((x0, y1), (x1, y1), (0, 1)),
        )
        if lies_on_outline(polygon, start, end)
    ]
    if at_walls and generator.random() < EDGE_RATHER_THAN_MIDDLE:
        return at_walls[int(generator.integers(len(at_walls)))]
    return Anchor(MIDDLE, ())


def _along(low: float, high: float, extent: float, sides: Sequence[int], generator: Generator) -> float:
    """The middle of something in an interval: at the wall on that side, or anywhere."""
    if sides:
        gap = WALL_GAP + extent / 2
        return round(low + gap if sides[0] < 0 else high - gap, 5)
    slack = max(0.0, high - low - extent - 2 * BESIDE)
    return round(low + BESIDE + extent / 2 + slack * float(generator.random()), 3)


def _is_convex_corner(polygon: Sequence[Corner], point: Corner) -> bool:
    """Whether the room has a corner here, with three of the four quadrants around it outside."""
    x, y = point
    if not any(abs(x - cx) < _SAME and abs(y - cy) < _SAME for cx, cy in polygon):
        return False
    around = [(x + dx, y + dy) for dx in (-0.001, 0.001) for dy in (-0.001, 0.001)]
    return sum(contains(polygon, corner) for corner in around) == 1


def lies_on_outline(polygon: Sequence[Corner], start: Corner, end: Corner) -> bool:
    """Whether a line, parallel to an axis, lies on an edge of the room."""
    for first, second in edges(polygon):
        axis = 0 if first[1] == second[1] else 1
        low, high = sorted((first[axis], second[axis]))
        on_line = all(abs(point[1 - axis] - first[1 - axis]) < _SAME for point in (start, end))
        if (
            on_line
            and low - _SAME <= min(start[axis], end[axis])
            and max(start[axis], end[axis]) <= high + _SAME
        ):
            return True
    return False
