"""The parts of a square lattice that are connected by free moves."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

MOVES = ((1, 0), (-1, 0), (0, 1), (0, -1))
"""The moves of the last axis of steps, in columns and rows."""


def steps_between(
    free: NDArray[np.bool_], east: NDArray[np.bool_], north: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Which moves are free: those between free cells on a free way.

    Args:
        free: (columns, rows), the cells that are free.
        east: (columns, rows), whether the way from a cell to the next column is free; the last column's is
            not used.
        north: (columns, rows), whether the way to the next row is.

    Returns:
        (columns, rows, 4), for every cell and each of `MOVES`.
    """
    steps = np.zeros((*free.shape, len(MOVES)), np.bool_)
    steps[:-1, :, 0] = free[:-1] & east[:-1] & free[1:]
    steps[1:, :, 1] = steps[:-1, :, 0]
    steps[:, :-1, 2] = free[:, :-1] & north[:, :-1] & free[:, 1:]
    steps[:, 1:, 3] = steps[:, :-1, 2]
    return steps


@numba.njit(cache=True, nogil=True)
def largest_part(free: NDArray[np.bool_], steps: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The largest part of the free cells that is connected by free moves.

    Args:
        free: (columns, rows), the cells that are free.
        steps: (columns, rows, 4), whether each of `MOVES` from there is free (see `steps_between`).

    Returns:
        (columns, rows); of equally large parts the one with the smallest cell, nothing if no cell is free.
    """
    columns, rows = free.shape
    part_of = np.full((columns, rows), -1, np.int64)
    queue = np.empty((columns * rows, 2), np.int64)
    best, most, part = -1, 0, 0
    for column in range(columns):
        for row in range(rows):
            if not free[column, row] or part_of[column, row] >= 0:
                continue
            part_of[column, row] = part
            queue[0, 0], queue[0, 1] = column, row
            taken, size = 0, 1
            while taken < size:
                i, j = queue[taken, 0], queue[taken, 1]
                taken += 1
                for move in range(4):
                    if not steps[i, j, move]:
                        continue
                    neighbour_i, neighbour_j = i + MOVES[move][0], j + MOVES[move][1]
                    if part_of[neighbour_i, neighbour_j] < 0:
                        part_of[neighbour_i, neighbour_j] = part
                        queue[size, 0], queue[size, 1] = neighbour_i, neighbour_j
                        size += 1
            if size > most:
                best, most = part, size
            part += 1
    largest: NDArray[np.bool_] = part_of == (best if best >= 0 else -2)
    return largest
