"""Judging floors of cells: which can be built, and how good one is."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

OUTSIDE = -1
"""What a floor has on cells outside of the house."""
FEWEST_CELLS = 2
"""Cells of the smallest room: no real single-room house has fewer."""
NARROW_PENALTY = 0.3
"""What a cell less than two cells wide costs, against a cell that the wrong room has."""

Array = NDArray[Any]


@numba.njit(cache=True, nogil=True)
def is_sound(floor: Array, count: Array) -> bool:
    """Whether no room is too small, has a hole (by Euler's number) or touches itself at a corner alone."""
    euler = np.zeros(count.size, np.int64)
    cells = np.zeros(count.size, np.int64)
    rows, columns = floor.shape
    for row in range(rows):
        for column in range(columns):
            here = floor[row, column]
            if here == OUTSIDE:
                continue
            cells[here] += 1
            right = neighbour(floor, row, column, 2)
            below = neighbour(floor, row, column, 0)
            euler[here] += 1 - (right == here) - (below == here)
            if row + 1 < rows and column + 1 < columns:
                across = floor[row + 1, column + 1]
                euler[here] += right == here and below == here and across == here
                if across == here and right != here and below != here:
                    return False
                if right == below and right != OUTSIDE and right != here and right != across:
                    return False
    leaf = count == 0
    return bool((euler[leaf] == 1).all() and (cells[leaf] >= FEWEST_CELLS).all())


@numba.njit(cache=True, nogil=True)
def score(floor: Array, count: Array, part: Array) -> float:
    """The share of cells that have the right room, less a penalty for narrow places; at least 0."""
    cells = np.zeros(count.size)
    narrow = 0
    rows, columns = floor.shape
    for row in range(rows):
        for column in range(columns):
            if floor[row, column] != OUTSIDE:
                cells[floor[row, column]] += 1.0
                narrow += not _is_wide(floor, row, column)
    whole = cells.sum()
    right = 0.0
    for node in range(count.size):
        if count[node] == 0:
            right += min(cells[node] / whole, part[node])
    return float(max(0.0, right - NARROW_PENALTY * narrow / whole))


@numba.njit(cache=True, nogil=True)
def _is_wide(floor: Array, row: int, column: int) -> bool:
    """Whether the cell is part of a square of two by two cells of its room."""
    here = floor[row, column]
    for down in (0, 1):
        for right in (2, 3):
            other_row = row + (1 if down == 0 else -1)
            if (
                neighbour(floor, row, column, down) == here
                and neighbour(floor, row, column, right) == here
                and neighbour(floor, other_row, column, right) == here
            ):
                return True
    return False


@numba.njit(cache=True, nogil=True)
def neighbour(floor: Array, row: int, column: int, step: int) -> int:
    """What lies beside a cell: after it (0) or before it (1) in its column, or in its row (2, 3)."""
    row += (step == 0) - (step == 1)
    column += (step == 2) - (step == 3)
    if 0 <= row < floor.shape[0] and 0 <= column < floor.shape[1]:
        return int(floor[row, column])
    return OUTSIDE
