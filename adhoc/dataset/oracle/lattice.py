"""The cells that robots stand on, and the moves between them while some objects lie on the floor."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.houses.house import Room
from adhoc.houses.lattice_parts import MOVES
from adhoc.houses.solids import Solid

Ints = NDArray[np.int32]

APART = 1
"""Robots whose cells differ by at most this many columns and rows touch: they have a radius of 0.2 m, and
cells are 0.25 m wide."""

_ALIGNED = 1e-3
_HIDES = 0.21
"""A robot is seen as a square; its corners are so far from its axis, in metres."""


class Lattice:
    """The free cells of a house, numbered from 0 in order of column and row.

    Args:
        rooms: the rooms of the house.
        fixed: everything that stays where it is.
        loose: objects by id that may be carried away.
        stands: where robots stand now: cells that are free whatever the arithmetic says, since it is a few
            millimetres more careful than the simulator.

    Attributes:
        points: (cells, 2) float64, where the cells are, in metres.
        room: (cells,) int16, index of the room below each cell.
        near: (cells, 9) int32, the cells that a robot keeps others from, its own included; -1 fills.
    """

    def __init__(
        self,
        rooms: Sequence[Room],
        fixed: Sequence[Solid],
        loose: Mapping[str, Solid],
        stands: Iterable[tuple[float, float]] = (),
    ) -> None:
        self._open = FreeCells(rooms, fixed)
        for x, y in stands:
            if self._is_on_lattice(x, y):
                self._free_cell(*self._open.index(x, y))
        free = self._open.free
        self._number = np.full(free.shape, -1, np.int32)
        self._number[free] = np.arange(int(free.sum()))
        self._cells = np.argwhere(free)
        self.points = (self._cells + np.array(self._open.origin)) * self._open.grid_size
        self.room: NDArray[np.int16] = self._open.room[free]
        self.near = self._neighbourhoods()
        self._free_moves = self._open.steps[free]
        self._passes: dict[str, NDArray[np.bool_]] = {}
        self._covered: dict[str, NDArray[np.int64]] = {}
        for name, solid in loose.items():
            around = FreeCells(rooms, [solid])
            passes = around.steps[free]
            if not passes[self._free_moves].all():
                self._passes[name] = passes
                self._covered[name] = np.flatnonzero(~around.free[free])
        self._targets = np.stack([self._shifted(move) for move in MOVES], axis=1)
        self._tables: dict[frozenset[str], Ints] = {}

    def __len__(self) -> int:
        return len(self._cells)

    @property
    def obstacles(self) -> frozenset[str]:
        """The ids of the loose objects that are in the way of some move."""
        return frozenset(self._passes)

    def covered_by(self, obstacle: str) -> NDArray[np.int64]:
        """The cells where a robot would touch one of the `obstacles`."""
        return self._covered[obstacle]

    def between(self, cell: int, point: tuple[float, float]) -> NDArray[np.int64]:
        """The cells from which a robot could hide a point from one on `cell`, but for those around that."""
        x, y = self.points[cell].tolist()
        dx, dy = point[0] - x, point[1] - y
        squared = max(dx * dx + dy * dy, 1e-9)
        offset = self.points - (x, y)
        along = np.clip((offset @ (dx, dy)) / squared, 0.0, 1.0)
        beside = np.hypot(offset[:, 0] - along * dx, offset[:, 1] - along * dy)
        hiding = np.flatnonzero(beside < _HIDES)
        return hiding[~np.isin(hiding, self.near[cell])]

    def cell_at(self, x: float, y: float) -> int | None:
        """The number of the free cell at a point; None if there is none within a millimetre."""
        i, j = self._open.index(x, y)
        if not (0 <= i < self._number.shape[0] and 0 <= j < self._number.shape[1]):
            return None
        number = int(self._number[i, j])
        return number if number >= 0 and self._is_on_lattice(x, y) else None

    def moves(self, lying: Iterable[str]) -> Ints:
        """(cells, 4) int32, the cell that each of `lattice_parts.MOVES` leads to, -1 where it is not free,
        while the loose objects of those ids lie where they were."""
        key = frozenset(lying) & self.obstacles
        if key not in self._tables:
            free = self._free_moves
            for name in sorted(key):
                free = free & self._passes[name]
            self._tables[key] = np.ascontiguousarray(np.where(free, self._targets, -1).astype(np.int32))
        return self._tables[key]

    def close(self, cells: Iterable[int], steps: Iterable[tuple[int, int]] = ()) -> None:
        """Keep robots from entering cells, and from single moves, given as (cell, move)."""
        closed = np.zeros(len(self), np.bool_)
        closed[list(cells)] = True
        leads_there = (self._targets >= 0) & closed[self._targets]
        self._free_moves = self._free_moves & ~leads_there
        for cell, move in steps:
            self._free_moves[cell, move] = False
        self._tables.clear()

    def _is_on_lattice(self, x: float, y: float) -> bool:
        cell_x, cell_y = self._open.point(*self._open.index(x, y))
        return max(abs(cell_x - x), abs(cell_y - y)) < _ALIGNED

    def _free_cell(self, i: int, j: int) -> None:
        """Count a cell in which a robot stands as free, with the moves to its free neighbours."""
        columns, rows = self._open.free.shape
        if not (0 <= i < columns and 0 <= j < rows) or self._open.free[i, j]:
            return
        self._open.free[i, j] = True
        for move, (di, dj) in enumerate(MOVES):
            if 0 <= i + di < columns and 0 <= j + dj < rows and self._open.free[i + di, j + dj]:
                self._open.steps[i, j, move] = True
                self._open.steps[i + di, j + dj, move ^ 1] = True

    def _shifted(self, move: tuple[int, int]) -> Ints:
        """The number of the cell that lies `move` beside each cell, -1 where there is none."""
        columns, rows = self._number.shape
        i, j = self._cells[:, 0] + move[0], self._cells[:, 1] + move[1]
        inside = (i >= 0) & (i < columns) & (j >= 0) & (j < rows)
        found = self._number[np.clip(i, 0, columns - 1), np.clip(j, 0, rows - 1)]
        return np.where(inside, found, -1).astype(np.int32)

    def _neighbourhoods(self) -> Ints:
        span = range(-APART, APART + 1)
        return np.ascontiguousarray(np.stack([self._shifted((i, j)) for i in span for j in span], axis=1))
