"""From a floor of cells to rooms in metres, and to the straight stretches of wall between them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adhoc.houses.generation.floor_judging import OUTSIDE
from adhoc.houses.house import Corner, Room

FIRST_ROOM = 2
"""The number of the first room: in ProcTHOR, 0 is an empty cell and 1 the outside."""
METRE_DIGITS = 3
"""Corners are rounded to millimetres, as in ProcTHOR."""

_Cell = tuple[int, int]


@dataclass(frozen=True)
class Contact:
    """A straight stretch along which two rooms meet, or a room meets the outside.

    `rooms` are positions in the list of rooms, the lower first; OUTSIDE comes first. `start` is the lower
    end, in metres.
    """

    rooms: tuple[int, int]
    start: Corner
    end: Corner

    @property
    def length(self) -> float:
        """Metres from end to end."""
        return math.dist(self.start, self.end)

    def point(self, along: float) -> Corner:
        """The point `along` metres from the start, to the millimetre."""
        ax, ay = self.start
        if ay == self.end[1]:
            return round(ax + along, METRE_DIGITS), ay
        return ax, round(ay + along, METRE_DIGITS)


def room_id(position: int) -> str:
    """The id of the room at that position, e.g. `room|2` for the first."""
    return f"room|{position + FIRST_ROOM}"


def outline_rooms(floor: NDArray[np.int8], room_types: Sequence[str], cell: float) -> tuple[Room, ...]:
    """The rooms of a floor whose cells are `cell` metres wide; their corners go round clockwise."""
    return tuple(
        Room(room_id(index), room_type, _outline(floor == index, cell))
        for index, room_type in enumerate(room_types)
    )


def find_contacts(floor: NDArray[np.int8], cell: float) -> tuple[Contact, ...]:
    """Every stretch between two rooms or between a room and the outside, each as long as it can be."""
    padded = np.pad(floor, 1, constant_values=OUTSIDE)
    found = [
        Contact(rooms, _corner(line, low, cell), _corner(line, high, cell))
        for rooms, line, low, high in _stretches(padded[:-1, 1:-1], padded[1:, 1:-1])
    ]
    found += [
        Contact(rooms, _corner(low, line, cell), _corner(high, line, cell))
        for rooms, line, low, high in _stretches(padded[1:-1, :-1].T, padded[1:-1, 1:].T)
    ]
    return tuple(found)


def _stretches(before: NDArray[Any], after: NDArray[Any]) -> list[tuple[tuple[int, int], int, int, int]]:
    """Runs of cells along each line that part the same two rooms: rooms, line, where it begins and ends."""
    found = []
    for line, (row, next_row) in enumerate(zip(before.tolist(), after.tolist())):
        position = 0
        for (low, high), run in groupby((min(pair), max(pair)) for pair in zip(row, next_row)):
            length = sum(1 for _ in run)
            if low != high:
                found.append(((low, high), line, position, position + length))
            position += length
    return found


def _outline(inside: NDArray[np.bool_], cell: float) -> tuple[Corner, ...]:
    """The corners of one room without a hole, clockwise (x is the first index of a cell, y the second)."""
    following: dict[_Cell, _Cell] = {}
    padded = np.pad(inside, 1).tolist()
    for x in range(len(padded) - 2):
        for y in range(len(padded[0]) - 2):
            if padded[x + 1][y + 1]:
                if not padded[x][y + 1]:
                    following[x, y] = (x, y + 1)
                if not padded[x + 2][y + 1]:
                    following[x + 1, y + 1] = (x + 1, y)
                if not padded[x + 1][y]:
                    following[x + 1, y] = (x, y)
                if not padded[x + 1][y + 2]:
                    following[x, y + 1] = (x + 1, y + 1)
    start = min(following)
    corners, last, here = [start], start, following[start]
    while here != start:
        after = following[here]
        if (after[0] - here[0], after[1] - here[1]) != (here[0] - last[0], here[1] - last[1]):
            corners.append(here)
        last, here = here, after
    return tuple(_corner(x, y, cell) for x, y in corners)


def _corner(x: int, y: int, cell: float) -> Corner:
    return round(x * cell, METRE_DIGITS), round(y * cell, METRE_DIGITS)
