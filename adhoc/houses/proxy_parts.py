"""The pieces that furniture proxies are made of, in the frame of the piece of furniture.

That frame has its origin on the floor below the middle; +y is the front (in real houses the -y side is the
one that stands against a wall), z is up; metres.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from adhoc.core.values import Point
from adhoc.houses.solids import Box, Surface


class Area(NamedTuple):
    """A rectangle of the floor plan."""

    x0: float
    x1: float
    y0: float
    y1: float

    def inset(self, margin: float) -> Area:
        """The rectangle without a margin all around."""
        return Area(self.x0 + margin, self.x1 - margin, self.y0 + margin, self.y1 - margin)


class Part(NamedTuple):
    """An upright box over an area, from height z0 to z1."""

    area: Area
    z0: float
    z1: float


class Board(NamedTuple):
    """A place to put things: an area at height z, with the free height above it."""

    area: Area
    z: float
    clearance: float


class Load(NamedTuple):
    """A thing that lies in or on a piece of furniture: heights of its bottom and top above the piece's."""

    bottom: float
    top: float


@dataclass(frozen=True)
class Proxy:
    """A piece of furniture as boxes, and where things can be put on or into it."""

    parts: tuple[Part, ...]
    boards: tuple[Board, ...] = ()


def footprint(size: Point) -> Area:
    """The whole area of a piece of that size."""
    return Area(-size[0] / 2, size[0] / 2, -size[1] / 2, size[1] / 2)


def corner_posts(area: Area, z1: float, width: float) -> tuple[Part, ...]:
    """Four legs from the floor to z1 at the corners of the area."""
    xs = ((area.x0, area.x0 + width), (area.x1 - width, area.x1))
    ys = ((area.y0, area.y0 + width), (area.y1 - width, area.y1))
    return tuple(Part(Area(*x, *y), 0.0, z1) for x in xs for y in ys)


def stacked(
    area: Area, levels: Sequence[float], loads: Sequence[Load], thickness: float, margin: float
) -> Proxy:
    """Boards over one area with their tops at `levels`, ascending; the last is open to the sky.

    A board is thinner where a load below it needs the room. Those with a hand's breadth of free height are
    places to put things; if none has it, the highest is.
    """
    parts = tuple(
        Part(area, max(0.0, level - _free_thickness(level, loads, thickness)), level) for level in levels
    )
    boards = [
        Board(area.inset(margin), part.z1, above - part.z1)
        for part, above in zip(parts, [*(part.z0 for part in parts[1:]), math.inf])
        if above - part.z1 >= LEAST_CLEARANCE
    ]
    return Proxy(parts, tuple(boards))


LEAST_CLEARANCE = 0.1
THINNEST_BOARD = 0.004


def shelf_levels(loads: Iterable[Load], height: float, usual: Iterable[float]) -> list[float]:
    """Heights of the shelves below the top: just under the things inside, and the usual ones elsewhere.

    Things whose bottoms are within a hand's breadth share a shelf. A usual shelf is left out where it would
    cut a thing or come close to another shelf.
    """
    inside = sorted(load for load in loads if load.bottom < height - SAME_LEVEL)
    levels: list[float] = []
    for load in inside:
        if not levels or load.bottom - levels[-1] > SHELF_GAP:
            levels.append(max(THINNEST_BOARD, load.bottom - RESTING_GAP))
    for level in usual:
        cut = any(load.bottom - RESTING_GAP < level < load.top + THINNEST_BOARD for load in inside)
        if not cut and all(abs(level - other) > SHELF_GAP for other in (*levels, height)):
            levels.append(level)
    return sorted(levels)


SAME_LEVEL = 0.02
SHELF_GAP = 0.12
RESTING_GAP = 0.001


def placed_box(part: Part, base: Point, yaw: float) -> Box:
    """The part of a piece that stands at `base`, turned by `yaw`, as a box of the world."""
    (x0, x1, y0, y1), z0, z1 = part
    center = _placed(((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2), base, yaw)
    return Box(center, ((x1 - x0) / 2, (y1 - y0) / 2, (z1 - z0) / 2), yaw)


def placed_surface(board: Board, base: Point, yaw: float) -> Surface:
    """The board of a piece that stands at `base`, turned by `yaw`, as a surface of the world."""
    (x0, x1, y0, y1), z, clearance = board
    center = _placed(((x0 + x1) / 2, (y0 + y1) / 2, z), base, yaw)
    return Surface(center, ((x1 - x0) / 2, (y1 - y0) / 2), yaw, clearance)


def _placed(point: Point, base: Point, yaw: float) -> Point:
    cos_yaw, sin_yaw = math.cos(yaw), math.sin(yaw)
    x, y, z = point
    return base[0] + cos_yaw * x - sin_yaw * y, base[1] + sin_yaw * x + cos_yaw * y, base[2] + z


def _free_thickness(level: float, loads: Sequence[Load], thickness: float) -> float:
    tops = [load.top for load in loads if load.bottom < level - SAME_LEVEL and load.top > level - thickness]
    return max(THINNEST_BOARD, level - max(tops)) if tops else thickness
