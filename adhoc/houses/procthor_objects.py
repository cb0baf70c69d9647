"""Objects of ProcTHOR house JSON."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from adhoc.core.geometry import wrap_angle
from adhoc.core.values import Point
from adhoc.houses import floor_plan
from adhoc.houses.facts import category_facts
from adhoc.houses.house import FLOOR, HouseObject, Room
from adhoc.houses.json_fields import Fields

LOWEST_SHELF = 0.25
"""A loose object that no receptacle holds lies on the floor if its bottom is below this, in metres."""
MOST_LEVELS = 8
"""Objects lie in objects one level deep in ProcTHOR; a few more do no harm."""


def parse_objects(house: Fields, rooms: Sequence[Room]) -> tuple[HouseObject, ...]:
    """All objects, each before its children.

    The category is looked up by asset, since ids differ between ProcTHOR's vintages. Raises HouseError for
    wrong fields and AssetError for an asset that is not in the fact tables.
    """
    found: list[HouseObject] = []
    for fields in house.items("objects"):
        found += _parse_tree(fields, rooms, None, MOST_LEVELS)
    return tuple(found)


def _parse_tree(
    fields: Fields, rooms: Sequence[Room], parent: str | None, levels: int
) -> Iterator[HouseObject]:
    thing = _parse_object(fields, rooms, parent)
    yield thing
    if fields.has("children"):
        if levels == 0:
            raise fields.error("children", "missing: objects are nested too deeply here")
        for child in fields.items("children"):
            yield from _parse_tree(child, rooms, thing.id, levels - 1)


def _parse_object(fields: Fields, rooms: Sequence[Room], parent: str | None) -> HouseObject:
    facts = fields.asset("assetId")
    category = category_facts(facts.category)
    position = fields.fields("position").point()
    yaw, size = _parse_rotation(fields.fields("rotation"), facts.size)
    if parent is None and facts.pickupable and position[2] - size[2] / 2 < LOWEST_SHELF:
        parent = FLOOR
    return HouseObject(
        id=fields.text("id"),
        asset=facts.asset,
        category=facts.category,
        position=position,
        yaw=yaw,
        size=size,
        room=_room_of(rooms, position[:2]),
        parent=parent,
        pickupable=facts.pickupable,
        mass=facts.mass,
        is_receptacle=category.is_receptacle,
    )


def _parse_rotation(rotation: Fields, size: Point) -> tuple[float, Point]:
    """Our yaw in (-pi, pi], and the extents as tilted.

    Unity's yaw is in degrees and grows clockwise. An upright box cannot tilt: tilts (ten of 11660 real
    objects have one) are rounded to quarter turns, which exchange extents. Unity turns about z before x.
    """
    x, y, z = size
    if round(rotation.number("z") / 90) % 2:
        x, z = z, x
    if round(rotation.number("x") / 90) % 2:
        y, z = z, y
    return wrap_angle(-math.radians(rotation.number("y"))), (x, y, z)


def _room_of(rooms: Sequence[Room], point: tuple[float, float]) -> str:
    return min(rooms, key=lambda room: floor_plan.distance(room.polygon, point)).id
