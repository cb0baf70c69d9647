"""Merging walls: ProcTHOR gives every shared edge a wall from each side; here it becomes one.

Two coincident walls would make a sensor's instance segmentation flicker between them, so the walls on one
line are cut where any of them ends and put together again, one piece per set of rooms.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from adhoc.houses.house import Corner

TOLERANCE = 0.01
"""Coordinates closer than this, in metres, are one: ProcTHOR rounds corners to millimetres."""


@dataclass(frozen=True)
class WallSide:
    """One wall of the file: the side that one room (or the outside: `room` is None) sees.

    `start` and `end` are its ground points in the order of the file, in metres; one coordinate is equal.
    """

    id: str
    room: str | None
    start: Corner
    end: Corner
    height: float
    empty: bool

    @property
    def axis(self) -> int:
        """0 if the wall runs along x, 1 if along y."""
        return 0 if abs(self.end[0] - self.start[0]) >= abs(self.end[1] - self.start[1]) else 1

    @property
    def offset(self) -> float:
        """The coordinate that all of its points share."""
        return self.start[1 - self.axis]

    @property
    def low(self) -> float:
        return min(self.start[self.axis], self.end[self.axis])

    @property
    def high(self) -> float:
        return max(self.start[self.axis], self.end[self.axis])

    def point(self, along: float) -> Corner:
        """The point `along` metres from `start` towards `end`."""
        length = self.high - self.low
        (ax, ay), (bx, by) = self.start, self.end
        return ax + (bx - ax) * along / length, ay + (by - ay) * along / length


@dataclass(frozen=True)
class Stretch:
    """A merged piece of wall, or of opening (`empty`), with the rooms on its sides in file order."""

    axis: int
    offset: float
    low: float
    high: float
    height: float
    rooms: tuple[str, ...]
    empty: bool

    @property
    def start(self) -> Corner:
        return (self.low, self.offset) if self.axis == 0 else (self.offset, self.low)

    @property
    def end(self) -> Corner:
        return (self.high, self.offset) if self.axis == 0 else (self.offset, self.high)

    def holds(self, point: Corner, slack: float = 2 * TOLERANCE) -> bool:
        """Whether the point lies on the stretch."""
        along, across = point[self.axis], point[1 - self.axis]
        return abs(across - self.offset) <= slack and self.low - slack <= along <= self.high + slack


def merge_walls(sides: Sequence[WallSide]) -> tuple[Stretch, ...]:
    """The stretches that the sides make together; no two of them coincide anywhere.

    A stretch is `empty` where two rooms meet and neither has a wall there. Where only one room is (towards
    the outside), a wall stays a wall even if the file calls it empty, so that no robot drives out.
    """
    return tuple(stretch for line in _lines(sides) for stretch in _merge_line(line))


def _lines(sides: Sequence[WallSide]) -> Iterator[list[WallSide]]:
    """The sides that lie on one line, for each line."""
    for axis in (0, 1):
        line: list[WallSide] = []
        for side in sorted((s for s in sides if s.axis == axis), key=lambda s: s.offset):
            if line and side.offset - line[-1].offset > TOLERANCE:
                yield line
                line = []
            line.append(side)
        if line:
            yield line


def _merge_line(line: list[WallSide]) -> list[Stretch]:
    merged: list[Stretch] = []
    cuts = _distinct(cut for side in line for cut in (side.low, side.high))
    for low, high in pairwise(cuts):
        middle = (low + high) / 2
        here = [side for side in line if side.low < middle < side.high]
        if not here:
            continue
        piece = _piece(here, low, high)
        if merged and _continues(merged[-1], piece):
            merged[-1] = _joined(merged[-1], piece)
        else:
            merged.append(piece)
    return merged


def _piece(here: list[WallSide], low: float, high: float) -> Stretch:
    rooms = tuple(dict.fromkeys(side.room for side in here if side.room is not None))
    empty = len(rooms) > 1 and all(side.empty for side in here)
    height = max(side.height for side in here)
    return Stretch(here[0].axis, here[0].offset, low, high, height, rooms, empty)


def _continues(last: Stretch, piece: Stretch) -> bool:
    return (
        last.high == piece.low
        and set(last.rooms) == set(piece.rooms)
        and last.empty == piece.empty
        and last.height == piece.height
    )


def _joined(last: Stretch, piece: Stretch) -> Stretch:
    return Stretch(last.axis, last.offset, last.low, piece.high, last.height, last.rooms, last.empty)


def _distinct(values: Iterable[float]) -> list[float]:
    """The values in order, without those closer than the tolerance to the one before."""
    distinct: list[float] = []
    for value in sorted(values):
        if not distinct or value - distinct[-1] > TOLERANCE:
            distinct.append(value)
    return distinct
