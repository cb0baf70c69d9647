"""Upright boxes that may be turned about the vertical, as rows of numbers for fast checks.

A row is x0, y0, z0, x1, y1, z1, cosine, sine: bounds along axes that are turned, about the world's origin, by
the angle of that cosine and sine. Boxes along the axes of the world have cosine 1 and sine 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray

from adhoc.houses.generation.pieces import Bounds, Piece

FloatArray = NDArray[np.float64]

COLUMNS = 8


def turned_rows(
    boxes: Sequence[Bounds], middle: tuple[float, float] = (0.0, 0.0), degrees: float = 0.0
) -> FloatArray:
    """The boxes, turned together counter-clockwise about a point, as rows (n, 8)."""
    rows = np.empty((len(boxes), COLUMNS))
    rows[:, :6] = np.array(boxes).reshape(-1, 6)
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    x, y = middle
    rows[:, 0:6:3] += cosine * x + sine * y - x
    rows[:, 1:6:3] += cosine * y - sine * x - y
    rows[:, 6:] = cosine, sine
    return rows


def rows_of(piece: Piece) -> FloatArray:
    """The boxes that a piece is built of where nothing lies in or on it, as rows (n, 8)."""
    return turned_rows(piece.boxes(), (piece.x, piece.y), piece.askew)


def bounding_row(piece: Piece) -> FloatArray:
    """The box around a piece, turned with it, as one row (1, 8)."""
    return turned_rows([piece.straight().bounds], (piece.x, piece.y), piece.askew)


def stacked_rows(rows: Iterable[FloatArray]) -> FloatArray:
    """All rows one below the other; (0, 8) for none."""
    return np.concatenate([np.empty((0, COLUMNS)), *rows])


def are_apart(ones: FloatArray, others: FloatArray, gap: float) -> bool:
    """Whether every box of the first rows stays at least `gap` metres away from every one of the second."""
    return bool(_all_apart(ones, others, gap))


@njit(cache=True)
def _all_apart(ones: FloatArray, others: FloatArray, gap: float) -> bool:
    for i in range(len(ones)):
        for k in range(len(others)):
            one, other = ones[i], others[k]
            if one[2] - other[5] >= gap or other[2] - one[5] >= gap:
                continue
            if not (_apart_along(one, other, gap) or _apart_along(other, one, gap)):
                return False
    return True


@njit(cache=True)
def _apart_along(one: FloatArray, other: FloatArray, gap: float) -> bool:
    """Whether a line along one of the first box's own axes separates the two."""
    cosine = one[6] * other[6] + one[7] * other[7]
    sine = one[6] * other[7] - one[7] * other[6]
    x, y = (other[0] + other[3]) / 2, (other[1] + other[4]) / 2
    half_x, half_y = (other[3] - other[0]) / 2, (other[4] - other[1]) / 2
    reach_x = abs(cosine) * half_x + abs(sine) * half_y
    reach_y = abs(sine) * half_x + abs(cosine) * half_y
    middle_x, middle_y = cosine * x - sine * y, sine * x + cosine * y
    return bool(
        middle_x - reach_x - one[3] >= gap
        or one[0] - middle_x - reach_x >= gap
        or middle_y - reach_y - one[4] >= gap
        or one[1] - middle_y - reach_y >= gap
    )
