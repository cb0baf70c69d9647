"""Furnishing a bare house: furniture, things on the walls, and items, after ProcTHOR's habits."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from numpy.random import Generator

from adhoc.houses.floor_plan import Rectangle
from adhoc.houses.generation.items import ItemLaying, draw_house_bias
from adhoc.houses.generation.pieces import drawn
from adhoc.houses.generation.room_furnishing import Placed, RoomFurnishing
from adhoc.houses.generation.shell import Shell
from adhoc.houses.generation.turning import turned_askew
from adhoc.houses.generation.walkways import Walkways
from adhoc.houses.generation.wall_things import hang_things
from adhoc.houses.house import FLOOR, HouseObject, Opening, Room

TRIES = ((1, 0.005), (4, 0.01), (5, 0.02), (6, 0.1), (7, 0.865))
"""How many pieces or groups are tried in each room of a house, with probabilities (ProcTHOR's)."""
BEFORE_DOORS = 0.8
"""Metres kept free before and behind doors."""
BEFORE_OPEN_WALLS = 0.4
"""Metres kept free on either side where a wall is left out between two rooms."""


def furnish(shell: Shell, generator: Generator) -> tuple[HouseObject, ...]:
    """The objects of a house, each before what it holds.

    Furniture stands before walls or in the middle of rooms such that robots still come everywhere; items lie
    where they belong and where a robot can see them. Nothing but `generator` decides.

    Args:
        shell: the bare house.
        generator: the random numbers.
    """
    walkways = Walkways(shell.rooms, shell.walls)
    tries = drawn(TRIES, generator)
    furnished = []
    for room in shell.rooms:
        holes = [hole for hole in shell.openings if room.id in hole.rooms and hole.kind != "window"]
        kept_free = [_strip(hole) for hole in holes]
        furnishing = RoomFurnishing(room, walkways, kept_free, generator)
        furnishing.run(tries)
        furnished.append(turned_askew(furnishing.placed, room, walkways, kept_free))
    cells = walkways.cells(len(shell.rooms))
    used: set[str] = set()
    bias = draw_house_bias(generator)
    numbers: Counter[str] = Counter()
    objects: list[HouseObject] = []
    for room, placed, places in zip(shell.rooms, furnished, cells):
        standing = [entry.piece for entry in placed]
        hung = hang_things(room, shell.openings, shell.height, standing, places, used, generator)
        ItemLaying(room.room_type, placed, hung, places, generator).run(bias)
        hanging = [Placed(piece, None) for piece in hung]
        objects += _objects(room, placed, numbers)
        objects += _objects(room, hanging, numbers)
    return tuple(objects)


def _strip(hole: Opening) -> Rectangle:
    """What is kept free before and behind an opening."""
    free = BEFORE_OPEN_WALLS if hole.kind == "open" else BEFORE_DOORS
    (ax, ay), (bx, by) = hole.start, hole.end
    dx, dy = (0.0, free) if ay == by else (free, 0.0)
    return min(ax, bx) - dx, min(ay, by) - dy, max(ax, bx) + dx, max(ay, by) + dy


def _objects(room: Room, placed: list[Placed], numbers: Counter[str]) -> Iterator[HouseObject]:
    room_number = room.id.split("|")[-1]
    for index, entry in enumerate(placed):
        if entry.on is None:
            hangs = entry.piece.bottom > 0
            parent = FLOOR if entry.piece.facts.pickupable and not hangs else None
            object_id = _name(entry, room_number, numbers)
            yield entry.piece.house_object(object_id, room.id, parent)
            for child in placed:
                if child.on == index:
                    yield child.piece.house_object(_name(child, room_number, numbers), room.id, object_id)


def _name(entry: Placed, room_number: str, numbers: Counter[str]) -> str:
    category = entry.piece.facts.category
    numbers[category] += 1
    return f"{category}|{room_number}|{numbers[category] - 1}"
