"""A house without furniture, as the first half of the generator makes it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adhoc.core.errors import HouseError
from adhoc.houses.generation.floor_boundary import draw_boundary
from adhoc.houses.generation.floor_growth import TRIES, grow_rooms
from adhoc.houses.generation.floor_judging import FEWEST_CELLS
from adhoc.houses.generation.room_doors import plan_passages
from adhoc.houses.generation.room_outlines import find_contacts, outline_rooms, room_id
from adhoc.houses.generation.room_specs import HouseSpec, draw_spec
from adhoc.houses.generation.wall_holes import NARROWEST_CONTACT, cut_doors, cut_windows
from adhoc.houses.house import Opening, Room, Wall
from adhoc.houses.procthor_writing import raise_walls

CELL_SIDE = (1.6, 2.2)
"""Metres, lowest and highest, of the cells that floors are made of."""
LOWEST_CEILING, CEILING_RANGE = 2.5, 4.5
CEILING_BETA = (1.25, 5.5)
"""The ceiling is at LOWEST_CEILING + CEILING_RANGE * Beta metres."""
ATTEMPTS = 20
"""Outlines that are tried, and FLOORS of the best floors on each, until the doors can be placed."""
FLOORS = 20


@dataclass(frozen=True)
class Shell:
    """Rooms, walls with their openings, and the height of the ceiling in metres."""

    rooms: tuple[Room, ...]
    walls: tuple[Wall, ...]
    openings: tuple[Opening, ...]
    height: float


def draw_shell(rooms: int, generator: np.random.Generator) -> Shell:
    """A house of that many rooms with doors and windows, after ProcTHOR's statistics.

    All lengths are whole millimetres, and everything is drawn from `generator`, so equal generators give
    equal shells on every machine. The lower corner of the house's outline is at the world's origin. Every
    room can be reached through doors, frames and left-out walls, all of them wide enough for a robot of 0.2 m
    radius on a lattice of 0.25 m; bathrooms have one door. One door, to the outside, is closed.

    Raises HouseError if there is no kind of house with so many rooms, or if no floor suits after
    a bounded number of draws.
    """
    spec = draw_spec(rooms, generator)
    for _ in range(ATTEMPTS):
        shell = _draw_on_outline(spec, rooms, generator)
        if shell is not None:
            return shell
    raise HouseError(f"no floor for {rooms} rooms was found on {ATTEMPTS} outlines")


def _draw_on_outline(spec: HouseSpec, rooms: int, generator: np.random.Generator) -> Shell | None:
    inside = draw_boundary(rooms, generator, spec.sides, FEWEST_CELLS * rooms)
    cell = _whole_millimetres(generator.uniform(*CELL_SIDE))
    for floor in grow_rooms(spec.rooms, inside, generator, TRIES if rooms > 1 else 1)[:FLOORS]:
        contacts = find_contacts(floor, cell)
        passages = plan_passages(spec.rooms, contacts, NARROWEST_CONTACT, generator)
        if passages is None:
            continue
        placed = outline_rooms(floor, [room.room_type for room in spec.rooms.leaves()], cell)
        height = _whole_millimetres(LOWEST_CEILING + CEILING_RANGE * generator.beta(*CEILING_BETA))
        doors = cut_doors(passages, contacts, generator)
        windows = cut_windows(placed, contacts, passages.exterior, generator, height)
        left_out = [frozenset(map(room_id, pair)) for pair in passages.left_out]
        return _raise(placed, height, (*doors, *windows), left_out)
    return None


def _raise(
    rooms: tuple[Room, ...], height: float, holes: tuple[Opening, ...], left_out: list[frozenset[str]]
) -> Shell:
    """The shell, its openings in the order in which a file of the house lists them."""
    walls, openings = raise_walls(rooms, height, holes, left_out)
    cut = [hole for wall in walls for hole in wall.openings]
    ordered = tuple(
        hole
        for kind, holes_of_kind in (("door", cut), ("window", cut), ("open", openings))
        for hole in holes_of_kind
        if hole.kind == kind
    )
    return Shell(rooms, walls, ordered, height)


def _whole_millimetres(length: float) -> float:
    return round(float(length), 3)
