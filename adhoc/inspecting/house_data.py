"""A house and a task as plain values, for the map of a page."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from adhoc.core.errors import AssetError
from adhoc.evaluation.floor_shapes import (
    LABELLED_AREA,
    OPENINGS,
    OTHER_ROOM,
    ROOM_COLOURS,
    WALL,
    WAY,
    footprint,
    hangs,
    middle_of,
    spaced,
)
from adhoc.evaluation.referee import in_reasonable_place
from adhoc.evaluation.scenario import Scenario
from adhoc.houses.house import House
from adhoc.worlds.world import ObjectTruth


def house_data(house: House) -> dict[str, Any]:
    """Rooms, walls, openings and the outlines of furniture, in metres, with the colours of pictures."""
    return {
        "id": house.id,
        "rooms": [
            {
                "id": room.id,
                "name": spaced(room.room_type),
                "colour": ROOM_COLOURS.get(room.room_type, OTHER_ROOM),
                "polygon": rounded(room.polygon),
                "middle": [round(it, 2) for it in middle_of(room.polygon)],
            }
            for room in house.rooms
        ],
        "wall": WALL,
        "walls": [rounded((wall.start, wall.end)) for wall in house.walls],
        "openings": [
            {
                "colour": WAY if hole.passable else OPENINGS.get(hole.kind, WAY),
                "passable": hole.passable,
                "line": rounded((hole.start, hole.end)),
            }
            for hole in house.openings
        ],
        "furniture": [
            {
                "id": thing.id,
                "name": spaced(thing.category),
                "named": thing.size[0] * thing.size[1] >= LABELLED_AREA,
                "polygon": rounded(footprint(thing)),
                "at": [round(it, 2) for it in thing.position[:2]],
            }
            for thing in house.objects
            if not thing.pickupable and not hangs(thing)
        ],
    }


def target_data(scenario: Scenario) -> list[dict[str, Any]]:
    """The misplaced objects in order, each with the furniture where it may belong by the referee's rule.

    Objects that the rule does not know have none.
    """
    house = scenario.house
    return [
        {
            "object": thing.id,
            "name": spaced(thing.category),
            "mass": thing.mass,
            "places": _places(house, thing.category),
        }
        for thing in (house.object(displacement.object_id) for displacement in scenario.misplaced)
    ]


def _places(house: House, category: str) -> list[str]:
    types = {room.id: room.room_type for room in house.rooms}
    found = []
    for thing in house.objects:
        if not thing.is_receptacle or thing.pickupable or thing.room not in types:
            continue
        there = ObjectTruth("", category, thing.position, thing.room, thing.id, thing.category)
        try:
            if in_reasonable_place(there, types[thing.room]):
                found.append(thing.id)
        except AssetError:
            return []
    return found


def rounded(points: Iterable[Sequence[float]]) -> list[list[float]]:
    """Points to the centimetre."""
    return [[round(number, 2) for number in point[:2]] for point in points]
