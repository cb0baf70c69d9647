"""Things with a place in a house that is being furnished."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

from numpy.random import Generator

from adhoc.core.geometry import wrap_angle
from adhoc.core.values import Point
from adhoc.houses.build import object_solid
from adhoc.houses.facts import AssetFacts, category_facts
from adhoc.houses.floor_plan import Rectangle
from adhoc.houses.house import HouseObject
from adhoc.houses.proxy_parts import Load

DIGITS = 5
"""Decimals of all lengths, in metres: those that houses are written with."""

RESTING_GAP = 0.001
"""Metres between what is put on something and its support."""

SHELF_SHARE = {"Desk": 0.4, "SideTable": 0.4}
"""Height of the shelf of tables that also hold things inside, as a share of their own (in real houses a third
of what belongs to them lies there)."""
SHELVED_HEIGHTS = (0.45, 0.95)
"""Metres: lower tables have no room for a shelf, higher ones have one of another kind."""

Bounds = tuple[float, float, float, float, float, float]
"""An upright box: x0, y0, z0, x1, y1, z1."""


class Support(NamedTuple):
    """A place to put things: a rectangle at a height, with the free height above it."""

    x0: float
    y0: float
    x1: float
    y1: float
    z: float
    clearance: float


@dataclass(frozen=True)
class Piece:
    """An asset at a place: the middle of its footprint, the height of its bottom, and how it is turned.

    `turn` counts quarter turns counter-clockwise; with 0 the front faces +y. `size` is its extents before
    the turn. `askew` is by how many degrees more, with one decimal, it is turned about its middle.
    """

    facts: AssetFacts
    x: float
    y: float
    bottom: float
    turn: int
    size: Point
    askew: float = 0.0

    @property
    def extent(self) -> tuple[float, float]:
        """Its extents along x and y as turned by quarters."""
        width, depth, _ = self.size
        return (depth, width) if self.turn % 2 else (width, depth)

    @property
    def rectangle(self) -> Rectangle:
        """Its footprint; of a piece that is askew, the upright rectangle around it."""
        width, depth = self.extent
        if self.askew:
            cosine, sine = abs(math.cos(math.radians(self.askew))), abs(math.sin(math.radians(self.askew)))
            width, depth = cosine * width + sine * depth, sine * width + cosine * depth
        return self.x - width / 2, self.y - depth / 2, self.x + width / 2, self.y + depth / 2

    @property
    def bounds(self) -> Bounds:
        """Its bounding box."""
        x0, y0, x1, y1 = self.rectangle
        return x0, y0, self.bottom, x1, y1, self.bottom + self.size[2]

    @property
    def front(self) -> tuple[int, int]:
        """The direction that its front faces, if it is not askew."""
        return FRONTS[self.turn % 4]

    def straight(self) -> Piece:
        """The piece in its place, but not askew."""
        return replace(self, askew=0.0) if self.askew else self

    def turned_with(self, holder: Piece) -> Piece:
        """The piece after it was laid on a straight `holder`, which was then turned askew with it."""
        if not holder.askew:
            return self
        x, y = rotated(self.x - holder.x, self.y - holder.y, holder.askew)
        return replace(self, x=round(holder.x + x, DIGITS), y=round(holder.y + y, DIGITS), askew=holder.askew)

    def boxes(self) -> tuple[Bounds, ...]:
        """The boxes that it is built of where nothing lies in or on it, if it is not askew."""
        return tuple(
            (
                self.x + x0,
                self.y + y0,
                self.bottom + z0,
                self.x + x1,
                self.y + y1,
                self.bottom + z1,
            )
            for x0, y0, z0, x1, y1, z1 in _shape(self.facts, self.size, self.turn % 4).boxes
        )

    def supports(self) -> tuple[Support, ...]:
        """Where things can be put on or into it, if it is not askew."""
        return tuple(
            Support(
                self.x + part.x0,
                self.y + part.y0,
                self.x + part.x1,
                self.y + part.y1,
                self.bottom + part.z,
                part.clearance,
            )
            for part in _shape(self.facts, self.size, self.turn % 4).supports
        )

    def house_object(self, object_id: str, room: str, parent: str | None) -> HouseObject:
        """The object of the house, with the values that reading a written house gives."""
        return HouseObject(
            object_id,
            self.facts.asset,
            self.facts.category,
            (
                round(self.x, DIGITS) + 0.0,
                round(self.y, DIGITS) + 0.0,
                round(self.bottom + self.size[2] / 2, DIGITS),
            ),
            _yaw(90.0 * (self.turn % 4) + self.askew),
            self.size,
            room,
            parent,
            self.facts.pickupable,
            self.facts.mass,
            category_facts(self.facts.category).is_receptacle,
        )


def drawn(chances: Sequence[tuple[int, float]], generator: Generator) -> int:
    """A number from (number, probability) pairs."""
    left = float(generator.random())
    for number, probability in chances:
        left -= probability
        if left < 0:
            return number
    return chances[-1][0]


FRONTS = ((0, 1), (-1, 0), (0, -1), (1, 0))


def rotated(x: float, y: float, degrees: float) -> tuple[float, float]:
    """The point after a rotation counter-clockwise about the origin."""
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return cosine * x - sine * y, sine * x + cosine * y


def turned(x: float, y: float, turn: int) -> tuple[float, float]:
    """The point after so many quarter turns counter-clockwise about the origin."""
    return ((x, y), (-y, x), (-x, -y), (y, -x))[turn % 4]


@dataclass(frozen=True)
class _Shape:
    boxes: tuple[Bounds, ...]
    supports: tuple[Support, ...]


def _yaw(degrees: float) -> float:
    """The yaw that a reader computes from ProcTHOR's degrees, which grow clockwise."""
    return wrap_angle(-math.radians(round(-degrees % 360.0, 1)))


@cache
def _shape(facts: AssetFacts, size: Point, turn: int) -> _Shape:
    thing = Piece(facts, 0.0, 0.0, 0.0, 0, size).house_object("", "", None)
    solid = object_solid(thing, _shelf_load(facts.category, size))
    base = thing.position[2] - size[2] / 2
    boxes = []
    for box in solid.boxes:
        (x0, y0), (x1, y1) = _turned_rectangle(box.center[:2], box.half[:2], turn)
        boxes.append((x0, y0, box.center[2] - box.half[2] - base, x1, y1, box.center[2] + box.half[2] - base))
    supports = []
    for surface in solid.surfaces:
        (x0, y0), (x1, y1) = _turned_rectangle(surface.center[:2], surface.half, turn)
        supports.append(Support(x0, y0, x1, y1, surface.center[2] - base, surface.clearance))
    return _Shape(tuple(boxes), tuple(supports))


def _shelf_load(category: str, size: Point) -> tuple[Load, ...]:
    """A thin load that stands for what may lie below a table's top: a table has a shelf where things lie."""
    if category not in SHELF_SHARE or not SHELVED_HEIGHTS[0] <= size[2] < SHELVED_HEIGHTS[1]:
        return ()
    shelf = round(SHELF_SHARE[category] * size[2], 3)
    return (Load(shelf + RESTING_GAP, shelf + 2 * RESTING_GAP),)


def _turned_rectangle(
    center: tuple[float, float], half: tuple[float, float], turn: int
) -> tuple[tuple[float, float], tuple[float, float]]:
    x, y = turned(*center, turn)
    half_x, half_y = (half[1], half[0]) if turn % 2 else half
    return (x - half_x, y - half_y), (x + half_x, y + half_y)
