"""The free rectangles of a room's floor."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray

from adhoc.houses import floor_plan
from adhoc.houses.floor_plan import Rectangle
from adhoc.houses.house import Corner

FloatArray = NDArray[np.float64]

_SAME = 1e-6


class FloorSpace:
    """The floor of a room, of which rectangles are taken one after the other."""

    def __init__(self, polygon: Sequence[Corner]) -> None:
        self._floor = np.array(floor_plan.rectangles(polygon), dtype=np.float64)
        self._taken: list[Rectangle] = []

    def take(self, rectangle: Rectangle) -> None:
        """Count a rectangle, which may reach beyond the room, as no longer free."""
        self._taken.append(rectangle)

    def free_rectangles(self) -> FloatArray:
        """All free rectangles (n, 4) whose sides lie on lines of the outline or of what was taken.

        Smaller ones lie in larger ones; ascending by their lower corner, then by their upper one.
        """
        taken = np.array(self._taken, dtype=np.float64).reshape(-1, 4)
        low, high = self._floor[:, :2].min(axis=0), self._floor[:, 2:].max(axis=0)
        both = np.concatenate([self._floor, taken])
        xs = np.unique(np.clip(both[:, [0, 2]], low[0], high[0]))
        ys = np.unique(np.clip(both[:, [1, 3]], low[1], high[1]))
        found: FloatArray = _rectangles(xs, ys, self._floor, taken)
        return found

    def is_free(self, rectangle: Rectangle) -> bool:
        """Whether all of a rectangle is floor of which nothing is taken."""
        x0, y0, x1, y1 = rectangle
        free = self.free_rectangles()
        low, high = np.array((x0, y0)) + _SAME, np.array((x1, y1)) - _SAME
        return bool(((free[:, :2] <= low) & (high <= free[:, 2:])).all(axis=1).any())


@njit(cache=True)
def _rectangles(xs: FloatArray, ys: FloatArray, floor: FloatArray, taken: FloatArray) -> FloatArray:
    columns, rows = len(xs) - 1, len(ys) - 1
    free = np.zeros((columns, rows), dtype=np.bool_)
    for i in range(columns):
        x = (xs[i] + xs[i + 1]) / 2
        for j in range(rows):
            y = (ys[j] + ys[j + 1]) / 2
            for k in range(len(floor)):
                if floor[k, 0] < x < floor[k, 2] and floor[k, 1] < y < floor[k, 3]:
                    free[i, j] = True
                    break
            for k in range(len(taken)):
                if taken[k, 0] < x < taken[k, 2] and taken[k, 1] < y < taken[k, 3]:
                    free[i, j] = False
                    break
    found = np.empty((1024, 4))
    count = 0
    for i in range(columns):
        for j in range(rows):
            limit = rows
            for k in range(i, columns):
                if not free[k, j]:
                    break
                end = j
                while end < limit and free[k, end]:
                    end += 1
                limit = end
                for m in range(j, limit):
                    if count == len(found):
                        larger = np.empty((2 * count, 4))
                        larger[:count] = found
                        found = larger
                    found[count, 0] = xs[i]
                    found[count, 1] = ys[j]
                    found[count, 2] = xs[k + 1]
                    found[count, 3] = ys[m + 1]
                    count += 1
    return found[:count].copy()
