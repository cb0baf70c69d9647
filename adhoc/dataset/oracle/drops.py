"""Where an object can be dropped without shutting anybody in."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Point
from adhoc.dataset.checks.box_arrays import BoxArrays
from adhoc.dataset.oracle.fields import FAR, cell_field
from adhoc.dataset.oracle.lattice import Lattice
from adhoc.dataset.oracle.stances import AIMS, TILTS
from adhoc.dataset.oracle.vacancy import fits_at
from adhoc.houses.floor_plan import contains
from adhoc.houses.house import Room

ROBOT_RADIUS = 0.2
_MARGIN = 0.05
"""Metres around the expected place that have to be free too, since candidate places lie on a grid."""
_MOST_LOST = 4
"""So many cells may be cut off from the rest: a corner that nobody needs."""


class Drops:
    """The places before a robot, where the world lays what it drops.

    Args:
        lattice: the cells.
        rooms: the rooms of the house, in the order that the lattice counts them in.
        boxes: everything that the object could lie on or touch, without itself and the floors.
        half: half extents of the object.
    """

    def __init__(self, lattice: Lattice, rooms: Sequence[Room], boxes: BoxArrays, half: Point) -> None:
        self._lattice = lattice
        self._rooms = rooms
        self._boxes = boxes
        self._half = half
        self._known: dict[tuple[int, int], bool] = {}

    def are_harmless(self, stance: int) -> bool:
        """Whether the object would come to lie right before a robot in that stance, in the same room, and all
        cells that were connected would stay so, but for a few."""
        cell, aim = divmod(stance, AIMS)
        key = (cell, aim // TILTS)
        if key not in self._known:
            self._known[key] = self._is_harmless(*key)
        return self._known[key]

    def _is_harmless(self, cell: int, heading: int) -> bool:
        x, y = self._place(cell, heading)
        half_x, half_y = self._half[0] + _MARGIN, self._half[1] + _MARGIN
        polygon = self._rooms[self._lattice.room[cell]].polygon
        corners = [(x + side * half_x, y + end * half_y) for side in (-1, 1) for end in (-1, 1)]
        if not all(contains(polygon, corner) for corner in corners):
            return False
        if not fits_at((x, y), (half_x, half_y), (0.0, 2 * self._half[2] + _MARGIN), self._boxes):
            return False
        return self._lost(cell, (x, y), (half_x, half_y)) <= _MOST_LOST

    def _place(self, cell: int, heading: int) -> tuple[float, float]:
        ahead = ROBOT_RADIUS + math.hypot(*self._half[:2])
        x, y = self._lattice.points[cell].tolist()
        return x + ahead * math.cos(heading * math.pi / 2), y + ahead * math.sin(heading * math.pi / 2)

    def _lost(self, cell: int, place: tuple[float, float], half: tuple[float, float]) -> int:
        """How many cells could no longer be reached, without those that the object covers."""
        offset = np.maximum(0.0, np.abs(self._lattice.points - place) - half)
        covered = np.hypot(offset[:, 0], offset[:, 1]) < ROBOT_RADIUS
        covered[cell] = False
        moves = self._lattice.moves(())
        after = np.where((moves >= 0) & covered[moves], -1, moves).astype(np.int32)
        return int((_reached(moves, cell) & ~covered & ~_reached(after, cell)).sum())


def _reached(moves: NDArray[np.int32], cell: int) -> NDArray[np.bool_]:
    costs = np.full(len(moves), FAR, np.int32)
    costs[cell] = 0
    return np.asarray(cell_field(moves, costs, np.zeros(len(moves), np.int32))[0] < FAR)
