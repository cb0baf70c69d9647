"""What is measured of a house, room by room, to tell generated houses from real ones.

Every room gives numbers (its area, how many things it holds, ...) and counts by name (which furniture,
which receptacles, ...). A house of several rooms gives one more set about the whole. All come from `House`
values alone, so that real and generated houses are measured alike.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from adhoc.dataset.likeness.floor_shares import covered_share, free_shares, share_at_wall, share_turned
from adhoc.houses import floor_plan
from adhoc.houses.house import House, HouseObject, Room

WHOLE_HOUSE = "whole house"
"""The group of what is measured once per house of several rooms."""

AREA = "floor area (m²)"
AREA_RATIO = "area over mean room of the house"
SIDES = "shorter over longer side"
CEILING = "ceiling height (m)"
"""Of a house; in houses of several rooms it is no statistic of the rooms, which share it."""
WINDOWS = "windows"
DOORS = "doors"
OPEN_SIDES = "sides open to another room"
FURNITURE = "furniture pieces"
WALL_THINGS = "things on walls"
FIXTURES = "fixed things on furniture"
ITEMS = "items"
HOLDING = "receptacles that hold items"
AT_WALL = "furniture at a wall (share)"
TURNED = "furniture not along the walls (share)"
COVERED = "floor covered by furniture (share)"
FREE = "free space (share)"
"""Share of the floor where the middle of a robot of radius 0.2 m may be."""

FURNITURE_TYPES = "furniture types"
WALL_THING_TYPES = "types of things on walls"
FIXTURE_TYPES = "types of fixed things on furniture"
ITEM_TYPES = "item types"
RECEPTACLE_TYPES = "receptacle types"
HOLDER_TYPES = "what the items lie on or in"
ROOM_TYPES = "room types"

HANGS = 0.25
"""Furniture whose bottom is higher, in metres, hangs on a wall (paintings, some televisions)."""
INSIDE = 0.005
"""An item is inside its receptacle rather than on top if its bottom is lower than the receptacle's top by
more, in metres: objects rest up to 3 mm deep in what they lie on."""


@dataclass(frozen=True)
class RoomStatistics:
    """One room (or, in group `WHOLE_HOUSE`, one house): what was measured of it, by name of the statistic."""

    group: str
    """The room's type."""
    numbers: Mapping[str, Sequence[float]]
    """One number, or one for each receptacle of a type."""
    counts: Mapping[str, Mapping[str, int]]


def house_statistics(house: House) -> list[RoomStatistics]:
    """The statistics of every room, then, if there are several, of the whole house."""
    free = free_shares(house)
    rooms = [_of_room(house, room, free[room.id]) for room in house.rooms]
    return [*rooms, _of_house(house)] if len(rooms) > 1 else rooms


def is_item(thing: HouseObject) -> bool:
    """Whether a robot can pick it up."""
    return thing.pickupable


def is_fixture(thing: HouseObject) -> bool:
    """Whether it stands on furniture and cannot be carried (a television, a lamp)."""
    return not thing.pickupable and thing.parent is not None


def hangs(thing: HouseObject) -> bool:
    """Whether it is fixed to a wall above the floor."""
    bottom = thing.position[2] - thing.size[2] / 2
    return not thing.pickupable and thing.parent is None and bottom > HANGS


def is_furniture(thing: HouseObject) -> bool:
    """Whether it stands on the floor and cannot be carried."""
    return not (is_item(thing) or is_fixture(thing) or hangs(thing))


def lies_inside(thing: HouseObject, receptacle: HouseObject) -> bool:
    """Whether an object is inside its receptacle rather than on top of it."""
    bottom = thing.position[2] - thing.size[2] / 2
    return bottom < receptacle.position[2] + receptacle.size[2] / 2 - INSIDE


def _of_room(house: House, room: Room, free: float) -> RoomStatistics:
    things = [thing for thing in house.objects if thing.room == room.id]
    furniture = [thing for thing in things if is_furniture(thing)]
    on_walls = [thing for thing in things if hangs(thing)]
    fixtures = [thing for thing in things if is_fixture(thing)]
    items = [thing for thing in things if is_item(thing)]
    held = _held_by(house, things)
    xs, ys = zip(*room.polygon)
    sides = sorted((max(xs) - min(xs), max(ys) - min(ys)))
    area = floor_plan.area(room.polygon)
    openings = [opening for opening in house.openings if room.id in opening.rooms]
    numbers: dict[str, Sequence[float]] = {
        AREA: [area],
        SIDES: [sides[0] / sides[1]],
        WINDOWS: [sum(opening.kind == "window" for opening in openings)],
        DOORS: [sum(opening.kind == "door" for opening in openings)],
        FURNITURE: [len(furniture)],
        WALL_THINGS: [len(on_walls)],
        FIXTURES: [len(fixtures)],
        ITEMS: [len(items)],
        HOLDING: [sum(bool(things) for _, things in held)],
        COVERED: [covered_share(room, furniture)],
        FREE: [free],
        **_items_by_receptacle(held),
    }
    if furniture:
        numbers[AT_WALL] = [share_at_wall(room, furniture)]
        numbers[TURNED] = [share_turned(furniture)]
    if len(house.rooms) > 1:
        numbers[AREA_RATIO] = [area / (_floor_area(house) / len(house.rooms))]
        numbers[OPEN_SIDES] = [sum(opening.kind == "open" for opening in openings)]
    else:
        numbers[CEILING] = [max(wall.height for wall in house.walls)]
    categories = {thing.id: thing.category for thing in house.objects}
    counts = {
        FURNITURE_TYPES: _by_category(furniture),
        WALL_THING_TYPES: _by_category(on_walls),
        FIXTURE_TYPES: _by_category(fixtures),
        ITEM_TYPES: _by_category(items),
        RECEPTACLE_TYPES: _by_category(thing for thing, _ in held),
        HOLDER_TYPES: Counter(categories.get(item.parent or "", item.parent or "nothing") for item in items),
    }
    return RoomStatistics(room.room_type, numbers, counts)


def _of_house(house: House) -> RoomStatistics:
    ways = [opening for opening in house.openings if opening.passable]
    numbers: dict[str, Sequence[float]] = {
        AREA: [_floor_area(house)],
        CEILING: [max(wall.height for wall in house.walls)],
        "ways between rooms": [len(ways)],
        "sides left open": [sum(opening.kind == "open" for opening in ways)],
        WINDOWS: [sum(opening.kind == "window" for opening in house.openings)],
        "exterior doors": [sum(o.kind == "door" and o.rooms[0] == o.rooms[1] for o in house.openings)],
        FURNITURE: [sum(is_furniture(thing) for thing in house.objects)],
        ITEMS: [sum(is_item(thing) for thing in house.objects)],
    }
    return RoomStatistics(WHOLE_HOUSE, numbers, {ROOM_TYPES: Counter(room.room_type for room in house.rooms)})


def _held_by(house: House, things: Iterable[HouseObject]) -> list[tuple[HouseObject, list[HouseObject]]]:
    """The receptacles among `things` that cannot be carried, each with the items on and in it."""
    items: dict[str, list[HouseObject]] = {}
    for thing in house.objects:
        if is_item(thing) and thing.parent is not None:
            items.setdefault(thing.parent, []).append(thing)
    return [(thing, items.get(thing.id, [])) for thing in things if thing.is_receptacle]


def _items_by_receptacle(
    held: Iterable[tuple[HouseObject, list[HouseObject]]],
) -> dict[str, list[float]]:
    numbers: dict[str, list[float]] = {}
    for receptacle, items in held:
        inside = sum(lies_inside(item, receptacle) for item in items)
        numbers.setdefault(f"items on a {receptacle.category}", []).append(len(items) - inside)
        numbers.setdefault(f"items in a {receptacle.category}", []).append(inside)
    return numbers


def _by_category(things: Iterable[HouseObject]) -> Counter[str]:
    return Counter(thing.category for thing in things)


def _floor_area(house: House) -> float:
    return sum(floor_plan.area(room.polygon) for room in house.rooms)
