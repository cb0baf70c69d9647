"""Which floor robots know, and since when: cells that were added, a few bytes a step."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from adhoc.houses.house import House
from adhoc.perception.semantic_map import SemanticMap

CELL = 0.1
"""Side of a cell in metres: finer than an eye needs at the size of a screen."""


@dataclass(frozen=True)
class FloorGrid:
    """The cells of a house: number `column * rows + row`, counted from the corner (x, y) in metres."""

    x: float
    y: float
    columns: int
    rows: int
    cell: float = CELL

    @classmethod
    def of(cls, house: House) -> FloorGrid:
        """The cells that cover all rooms."""
        xs, ys = zip(*(corner for room in house.rooms for corner in room.polygon))
        x, y = math.floor(min(xs)), math.floor(min(ys))
        return cls(x, y, math.ceil((max(xs) - x) / CELL), math.ceil((max(ys) - y) / CELL))

    def known(self, space: SemanticMap) -> NDArray[np.bool_]:
        """Whether a map knows the floor in the middle of each cell: (columns * rows,)."""
        if not space.anchored:
            return np.zeros(self.columns * self.rows, np.bool_)
        side = len(space.floor)
        known = np.zeros((self.columns, self.rows), np.bool_)
        columns, rows = (
            np.floor((start + (np.arange(count) + 0.5) * self.cell - origin) / space.settings.cell).astype(
                int
            )
            for start, count, origin in (
                (self.x, self.columns, space.origin[0]),
                (self.y, self.rows, space.origin[1]),
            )
        )
        inside = np.ix_((columns >= 0) & (columns < side), (rows >= 0) & (rows < side))
        known[inside] = space.floor[np.ix_(columns[inside[0].ravel()], rows[inside[1].ravel()])] > 0
        return known.ravel()


@dataclass
class FloorLog:
    """What one robot came to know: at each key frame the cells that are new, as runs."""

    grid: FloorGrid
    entries: list[tuple[int, list[int]]] = field(default_factory=list)
    """(step, [cells skipped since the last run, length of a run, ...])"""
    _known: NDArray[np.bool_] | None = None
    _revision: int = -1

    def note(self, step: int, space: SemanticMap) -> None:
        """Note what a map knows at a step beyond what it knew before."""
        if space.revision == self._revision:
            return
        self._revision = space.revision
        now = self.grid.known(space)
        new = now if self._known is None else now & ~self._known
        if new.any():
            self.entries.append((step, runs_of(new)))
        self._known = now if self._known is None else now | self._known


def runs_of(cells: NDArray[np.bool_]) -> list[int]:
    """The lengths of stretches of cells that are out and in, in turn, beginning with those that are out;
    what is out at the end is left away."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], cells, [False])).astype(np.int8)))
    return np.diff(np.concatenate(([0], edges))).tolist()  # type: ignore[no-any-return]
