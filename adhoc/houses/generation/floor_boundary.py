"""The outline of a house on a grid of cells: a rectangle with corners cut off, after ProcTHOR's law."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from adhoc.core.errors import HouseError

ROOM_SIDE = 3
"""Cells that one room adds to the side of a square house, about."""
SHORTEST_SIDE = 2
LARGEST_CUT = 6
"""The most cells that one cut takes off a corner."""
CUTS_A_PER_ROOM, CUTS_B, MOST_CUTS = 0.5, 6.0, 10
"""The number of cuts is MOST_CUTS times a beta-distributed number, rounded."""
ATTEMPTS = 100

Sides = tuple[tuple[int, int], tuple[int, int]]


def draw_boundary(
    rooms: int, generator: np.random.Generator, sides: Sides | None = None, fewest_cells: int = 2
) -> NDArray[np.bool_]:
    """Which cells (depth, length) of the grid are inside a house of that many rooms.

    `sides` are the lowest and highest depth and length in cells; by default both follow from the number of
    rooms. The cells are connected side by side, and no two of them touch at a corner alone. Raises
    HouseError if a hundred draws have fewer than `fewest_cells` cells or fall apart.
    """
    for _ in range(ATTEMPTS):
        inside = _cut(rooms, generator, *_draw_size(rooms, generator, sides))
        if inside.sum() >= fewest_cells and _is_sound(inside):
            return inside
    raise HouseError(f"no outline for {rooms} rooms was found in {ATTEMPTS} draws")


def _draw_size(rooms: int, generator: np.random.Generator, sides: Sides | None) -> tuple[int, int]:
    usual = math.sqrt(rooms) * ROOM_SIDE
    lowest, highest = max(SHORTEST_SIDE, int(usual - 2)), int(usual + 2) - 1
    (low, high), (low_length, high_length) = sides or ((lowest, highest), (lowest, highest))
    return int(generator.integers(low, high + 1)), int(generator.integers(low_length, high_length + 1))


def _cut(rooms: int, generator: np.random.Generator, depth: int, length: int) -> NDArray[np.bool_]:
    inside = np.ones((depth, length), dtype=np.bool_)
    for _ in range(round(generator.beta(CUTS_A_PER_ROOM * rooms, CUTS_B) * MOST_CUTS)):
        corner = int(generator.integers(4))
        along = int(generator.integers(1, max(2, min(length - 1, LARGEST_CUT // 2))))
        across = int(generator.integers(1, min(LARGEST_CUT // along, depth - 1) + 1))
        rows = slice(0, across) if corner < 2 else slice(depth - across, depth)
        columns = slice(0, along) if corner % 2 else slice(length - along, length)
        inside[rows, columns] = False
    return inside


def _is_sound(inside: NDArray[np.bool_]) -> bool:
    """Whether all cells are connected by their sides, and none touch at a corner alone."""
    a, b, c, d = inside[:-1, :-1], inside[:-1, 1:], inside[1:, :-1], inside[1:, 1:]
    if bool(((a & d & ~b & ~c) | (b & c & ~a & ~d)).any()):
        return False
    left = {(int(row), int(column)) for row, column in np.argwhere(inside)}
    waiting = [left.pop()]
    while waiting:
        row, column = waiting.pop()
        for cell in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
            if cell in left:
                left.remove(cell)
                waiting.append(cell)
    return not left
