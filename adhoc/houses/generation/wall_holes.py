"""Cutting doors, door frames and windows into the walls, with ProcTHOR's assets, sizes and heights."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from adhoc.houses.facts import asset, wall_hole
from adhoc.houses.generation.floor_judging import OUTSIDE
from adhoc.houses.generation.room_doors import Pair, Passages, choose_contact
from adhoc.houses.generation.room_outlines import FIRST_ROOM, METRE_DIGITS, Contact, room_id
from adhoc.houses.house import Opening, Room

DOORS = (
    *(f"Doorway_{number}" for number in (4, 5, 6, 8, 9, 10)),
    *(f"Doorway_Double_{number}" for number in (1, 2, 4, 5, 7, 8, 9)),
)
FRAMES = (
    *(f"Doorframe_{number}" for number in (2, 5, 6, 7, 10)),
    *(f"Doorframe_Double_{number}" for number in (1, 3, 4, 5, 6, 8, 9, 10)),
)
WINDOWS = (
    "Window_Bay_2",
    *(f"Window_Fixed_60x{height}" for height in (36, 48, 72)),
    *(f"Window_Hung_{size}" for size in ("32x60", "36x32", "44x60", "48x24", "48x32", "48x44")),
    *(f"Window_Slider_{size}" for size in ("36x36", "48x36", "48x48", "60x36")),
)
"""The assets of ProcTHOR's training split, the ones that its published training houses show."""

JAMB = 0.05
"""Metres of wall that a door leaves free on both sides, at least."""
NARROWEST_CONTACT = 1.2
"""Metres of wall that the narrowest doors need, with room to spare."""
DOOR_GAP = 0.5
"""Metres between two doors of one room that are tried for: ProcTHOR's padding behind a door."""
PLACEMENTS = 10

WINDOW_ROOMS = frozenset({"Bedroom", "Kitchen", "LivingRoom"})
WINDOW_COUNTS = ((0, 0.125), (1, 0.375), (2, 0.5))
"""How many windows are tried for in a room, and how often."""
EYE_WALL = 3.0
"""Windows are centred between the floor and the ceiling, or this height in metres if that is lower."""
SPARE_WALLS = 1
"""Walls that are tried for a room's windows beyond as many as there are windows."""
FREE_WALL = (0.15, 0.6)
"""ProcTHOR puts windows where furniture leaves the wall free. Here windows come first, so the free part of
each wall is drawn, as a share between these two: that gives about as many windows of about the same widths
as real single-room houses have."""


def cut_doors(
    passages: Passages, contacts: Sequence[Contact], generator: np.random.Generator
) -> tuple[Opening, ...]:
    """The doors and frames between rooms, and the closed door to the outside."""
    openings: list[Opening] = []
    for assets, pairs in ((DOORS, passages.doors), (FRAMES, passages.frames)):
        for pair in pairs:
            walls = [
                contact
                for contact in contacts
                if contact.rooms == pair and contact.length >= NARROWEST_CONTACT
            ]
            openings.append(_cut_apart(pair, assets, walls, openings, generator))
    exterior = passages.exterior
    openings.append(_cut_apart(exterior.rooms, DOORS, [exterior], openings, generator))
    return tuple(openings)


def cut_windows(
    rooms: Sequence[Room],
    contacts: Sequence[Contact],
    exterior: Contact,
    generator: np.random.Generator,
    ceiling: float,
) -> tuple[Opening, ...]:
    """Up to two windows for every room but bathrooms: one on a wall, and none beside the exterior door."""
    return tuple(
        window
        for index, room in enumerate(rooms)
        if room.room_type in WINDOW_ROOMS
        for window in _windows_of(
            index,
            [contact for contact in contacts if contact.rooms == (OUTSIDE, index) and contact != exterior],
            generator,
            ceiling,
        )
    )


def _cut_apart(
    pair: Pair,
    assets: Iterable[str],
    walls: Sequence[Contact],
    others: Sequence[Opening],
    generator: np.random.Generator,
) -> Opening:
    """A door on one of the walls, away from the doors of its rooms if one of a few draws is."""
    door = _cut_door(pair, assets, walls, generator)
    for _ in range(PLACEMENTS):
        beside = (other for other in others if set(other.rooms) & set(door.rooms))
        if all(_gap(door, other) >= DOOR_GAP for other in beside):
            break
        door = _cut_door(pair, assets, walls, generator)
    return door


def _cut_door(
    pair: Pair, assets: Iterable[str], walls: Sequence[Contact], generator: np.random.Generator
) -> Opening:
    wall = choose_contact(walls, generator)
    fitting = [name for name in assets if asset(name).size[0] + 2 * JAMB <= wall.length]
    name = fitting[int(generator.integers(len(fitting)))]
    width, _, height = (round(extent, METRE_DIGITS) for extent in asset(name).size)
    low = JAMB + generator.random() * (wall.length - width - 2 * JAMB)
    low = round(low, METRE_DIGITS)
    first, second = pair if generator.random() < 0.5 else pair[::-1]
    if OUTSIDE in pair:
        first = second = max(pair)
    return Opening(
        f"door|{pair[0] + FIRST_ROOM}|{pair[1] + FIRST_ROOM}",
        "door",
        (room_id(first), room_id(second)),
        wall.point(low),
        wall.point(low + width),
        0.0,
        height,
        OUTSIDE not in pair,
        name,
    )


def _gap(first: Opening, second: Opening) -> float:
    """Metres between the nearest points of two holes along axes."""
    spans = [
        max(
            min(first.start[axis], first.end[axis]) - max(second.start[axis], second.end[axis]),
            min(second.start[axis], second.end[axis]) - max(first.start[axis], first.end[axis]),
            0.0,
        )
        for axis in (0, 1)
    ]
    return math.hypot(*spans)


def _windows_of(
    room: int, walls: list[Contact], generator: np.random.Generator, ceiling: float
) -> Iterator[Opening]:
    wanted, placed = _window_count(generator), 0
    for _ in range(wanted + SPARE_WALLS if wanted else 0):
        if placed == wanted or not walls:
            return
        wall = choose_contact(walls, generator)
        walls = [other for other in walls if other != wall]
        name = f"window|{room + FIRST_ROOM}|{placed}"
        window = _cut_window(name, room_id(room), wall, generator, ceiling)
        if window is not None:
            placed += 1
            yield window


def _window_count(generator: np.random.Generator) -> int:
    rest = generator.random()
    for count, chance in WINDOW_COUNTS:
        rest -= chance
        if rest < 0:
            return count
    return WINDOW_COUNTS[-1][0]


def _cut_window(
    name: str, room: str, wall: Contact, generator: np.random.Generator, ceiling: float
) -> Opening | None:
    """A window on a part of the wall as long as furniture would leave free; None if none is so narrow."""
    free = wall.length * generator.uniform(*FREE_WALL)
    begin = generator.random() * (wall.length - free)
    fitting = [asset_id for asset_id in WINDOWS if wall_hole(asset_id)[0] < free - 2 * JAMB]
    if not fitting:
        return None
    asset_id = fitting[int(generator.integers(len(fitting)))]
    width, height = (round(extent, METRE_DIGITS) for extent in wall_hole(asset_id))
    low = round(begin + JAMB + generator.random() * (free - 2 * JAMB - width), METRE_DIGITS)
    bottom = round((min(ceiling, EYE_WALL) - height) / 2, METRE_DIGITS)
    return Opening(
        name,
        "window",
        (room, room),
        wall.point(low),
        wall.point(low + width),
        bottom,
        round(bottom + height, METRE_DIGITS),
        False,
        asset_id,
    )
