"""Whether everything stands, lies or hangs where the house says: on the floor, a receptacle, a wall."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from adhoc.core.values import Point
from adhoc.houses.facts_furniture import standing
from adhoc.houses.house import FLOOR, House, HouseObject
from adhoc.houses.solids import Box, Solid, SolidKind, Surface

GAP = 0.02
"""Metres that a thing may be above what bears it, or off its wall, as in the check of gravity."""
_SLACK = 0.002
"""Metres by which boxes may be inside each other, as in the check of penetration."""


def unsupported(house: House, solids: Iterable[Solid]) -> Iterator[tuple[str, str]]:
    """The id of every object that nothing bears, and how it hovers.

    Furniture, held fixed under gravity, stands on the floor or hangs on a wall. An item has its bottom just
    above one of its receptacle's surfaces, and its centre over it. What is fixed to a piece of furniture, a
    faucet say, has its centre within the piece's outline and its bottom no higher than the piece's top.
    """
    by_id = {solid.id: solid for solid in solids}
    objects = {thing.id: thing for thing in house.objects}
    walls = [box for solid in by_id.values() if solid.kind is SolidKind.WALL for box in solid.boxes]
    for thing in house.objects:
        boxes = by_id[thing.id].boxes
        bottom = min(box.center[2] - box.half[2] for box in boxes)
        if thing.parent is None:
            hangs = _may_hang(thing) and any(_touch(box, wall) for box in boxes for wall in walls)
            if bottom > GAP and not hangs:
                yield thing.id, f"stands {bottom:.2f} m above the floor and hangs on no wall"
        elif thing.parent == FLOOR:
            if bottom > GAP:
                yield thing.id, f"lies {bottom:.2f} m above the floor"
        elif thing.pickupable:
            if not any(_bears(surface, thing.position, bottom) for surface in by_id[thing.parent].surfaces):
                yield thing.id, f"lies on no surface of {thing.parent}, its bottom is {bottom:.2f} m high"
        elif not _holds(objects[thing.parent], thing.position, bottom):
            yield thing.id, f"is not on {thing.parent}, its bottom is {bottom:.2f} m high"


def _may_hang(thing: HouseObject) -> bool:
    """Pictures and the like do, and so do televisions; what stands on floors never."""
    return thing.category == "Television" or not standing(thing.category).on_floor


def _bears(surface: Surface, center: Point, bottom: float) -> bool:
    is_over = _is_within(center, surface.center, surface.half, surface.yaw)
    return is_over and -_SLACK <= bottom - surface.center[2] <= GAP


def _holds(piece: HouseObject, center: Point, bottom: float) -> bool:
    half = (piece.size[0] / 2, piece.size[1] / 2)
    is_over = _is_within(center, piece.position, half, piece.yaw)
    return is_over and bottom <= piece.position[2] + piece.size[2] / 2 + GAP


def _is_within(point: Point, center: Point, half: tuple[float, float], yaw: float) -> bool:
    """Whether a point is over a rectangle that is turned by `yaw`."""
    x, y = _inward(yaw, point[0] - center[0], point[1] - center[1])
    return abs(x) <= half[0] + _SLACK and abs(y) <= half[1] + _SLACK


def _touch(box: Box, wall: Box) -> bool:
    """Whether a box is within the gap of a wall's, both seen along the wall."""
    if abs(box.center[2] - wall.center[2]) > box.half[2] + wall.half[2]:
        return False
    x, y = _inward(wall.yaw, box.center[0] - wall.center[0], box.center[1] - wall.center[1])
    turn = box.yaw - wall.yaw
    reach_x = abs(math.cos(turn)) * box.half[0] + abs(math.sin(turn)) * box.half[1]
    reach_y = abs(math.sin(turn)) * box.half[0] + abs(math.cos(turn)) * box.half[1]
    return abs(x) <= reach_x + wall.half[0] + GAP and abs(y) <= reach_y + wall.half[1] + GAP


def _inward(yaw: float, x: float, y: float) -> tuple[float, float]:
    """A difference of positions in axes turned by `yaw`."""
    return math.cos(yaw) * x + math.sin(yaw) * y, math.cos(yaw) * y - math.sin(yaw) * x
