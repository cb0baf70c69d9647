"""A house as boxes: what a world collides with and a sensor sees.

One `Solid` is one instance of segmentation: a room's floor, a wall, an object. It is made of one or
several oriented boxes (a fridge is an open shell with shelves, a sofa a seat and a back), so that what
lies inside or on it can be seen and reached.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from adhoc.core.values import Point


class SolidKind(str, Enum):
    """What a solid is, for collisions and for perception."""

    FLOOR = "floor"
    WALL = "wall"
    DOOR = "door"
    """A closed door's leaf, or the pane of a window."""
    FURNITURE = "furniture"
    """Any object that cannot be picked up."""
    ITEM = "item"
    """Any object that can be picked up."""


@dataclass(frozen=True)
class Box:
    """An upright box: `center` and `half` extents in metres, turned by `yaw` about the vertical."""

    center: Point
    half: Point
    yaw: float = 0.0


@dataclass(frozen=True)
class Surface:
    """A horizontal place of a receptacle where things can be put.

    `center` is the middle of the surface at its height; `half` its half extents along the axes turned by
    `yaw`; `clearance` the free height above it in metres (inf under the open sky).
    """

    center: Point
    half: tuple[float, float]
    yaw: float
    clearance: float


@dataclass(frozen=True)
class Solid:
    """One instance: what it is, its boxes, and where things can be put on or into it."""

    id: str
    """The object's or wall's id; for a floor, the room's id."""
    category: str
    """The object's category; `Floor`, `Wall`, `Door` or `Window` for the house itself."""
    kind: SolidKind
    boxes: tuple[Box, ...]
    surfaces: tuple[Surface, ...] = ()
    mass: float = 0.0
