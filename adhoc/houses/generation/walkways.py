"""Where robots can drive between the furniture, on the lattice of their moves.

A cheap copy of the lattice of worlds: cells at multiples of the grid size through the world's origin, moves
between them checked in thirds. It treats furniture as the boxes around it and is therefore on the safe side.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numba import njit
from numpy.typing import NDArray

from adhoc.houses import floor_plan
from adhoc.houses.build import WALL_THICKNESS
from adhoc.houses.floor_plan import Rectangle
from adhoc.houses.house import Room, Wall
from adhoc.houses.lattice_parts import largest_part, steps_between
from adhoc.houses.shell_solids import wall_solid

GRID_SIZE = 0.25
RADIUS = 0.2
ROBOT_HEIGHT = 1.7
SLACK = 0.01
"""Metres by which robots are taken to be broader than they are."""
PARTS = 3
"""Steps in which a move is checked."""


class Walkways:
    """The cells of a house that robots can reach from each other, while furniture is put up.

    Args:
        rooms: the rooms; cells outside of them are not free.
        walls: their walls; doors that robots can pass are open.
    """

    def __init__(self, rooms: Sequence[Room], walls: Sequence[Wall]) -> None:
        xs, ys = zip(*(corner for room in rooms for corner in room.polygon))
        self._low = math.floor(min(xs) / GRID_SIZE), math.floor(min(ys) / GRID_SIZE)
        columns = math.ceil(max(xs) / GRID_SIZE) - self._low[0] + 1
        lines = math.ceil(max(ys) / GRID_SIZE) - self._low[1] + 1
        self._blocked = np.zeros((columns * PARTS, lines * PARTS), dtype=np.uint8)
        self._room = np.full((columns, lines), -1, dtype=np.int16)
        self._marked: dict[int, list[Rectangle]] = {}
        for index, room in enumerate(rooms):
            for x0, y0, x1, y1 in floor_plan.rectangles(room.polygon):
                self._room[self._columns(x0, x1), self._lines(y0, y1)] = index
        for wall in walls:
            for box in wall_solid(_with_closed_doors(wall), WALL_THICKNESS).boxes:
                if box.center[2] - box.half[2] < ROBOT_HEIGHT:
                    (x, y, _), (dx, dy, _) = box.center, box.half
                    self.block((x - dx, y - dy, x + dx, y + dy))
        self._bare = self.reached_by_room(len(rooms))

    def block(self, rectangle: Rectangle, askew: float = 0.0) -> None:
        """Count a rectangle as an obstacle, once more if it is one already.

        It is turned about its middle by `askew` degrees.
        """
        _mark(self._blocked, *self._local(rectangle), math.radians(askew), 1)

    def unblock(self, rectangle: Rectangle, askew: float = 0.0) -> None:
        """Take back a `block`."""
        _mark(self._blocked, *self._local(rectangle), math.radians(askew), -1)

    def reached(self) -> NDArray[np.bool_]:
        """The largest connected part of the free cells, (columns, lines)."""
        clear = self._blocked == 0
        free = (self._room >= 0) & clear[::PARTS, ::PARTS]
        between = range(1, PARTS)
        east = np.logical_and.reduce([clear[part::PARTS, ::PARTS] for part in between])
        north = np.logical_and.reduce([clear[::PARTS, part::PARTS] for part in between])
        reached: NDArray[np.bool_] = largest_part(free, steps_between(free, east, north))
        return reached

    def reached_by_room(self, rooms: int) -> NDArray[np.int64]:
        """How many cells of each room belong to the largest part."""
        return np.bincount(self._room[self.reached()], minlength=rooms)

    def cells(self, rooms: int) -> list[NDArray[np.float64]]:
        """For every room, the middles (n, 2) of its cells in the largest part."""
        reached = self.reached()
        return [
            (np.argwhere(reached & (self._room == room)) + self._low) * GRID_SIZE for room in range(rooms)
        ]

    def are_sound(self, least_share: float, near: NDArray[np.float64], reach: float) -> bool:
        """Whether robots still come everywhere.

        That is: to at least `least_share` of the cells of every room that bare walls left to it, and to
        within `reach` metres of every rectangle of `near` (n, 4).
        """
        reached = self.reached()
        counts = np.bincount(self._room[reached], minlength=len(self._bare))
        if (counts < np.maximum(1, least_share * self._bare)).any():
            return False
        low = np.array(self._low, dtype=np.float64)
        return bool(_all_near(reached, low, near, reach))

    def _columns(self, x0: float, x1: float) -> slice:
        return slice(math.ceil(x0 / GRID_SIZE) - self._low[0], math.floor(x1 / GRID_SIZE) - self._low[0] + 1)

    def _lines(self, y0: float, y1: float) -> slice:
        return slice(math.ceil(y0 / GRID_SIZE) - self._low[1], math.floor(y1 / GRID_SIZE) - self._low[1] + 1)

    def _local(self, rectangle: Rectangle) -> tuple[float, float, float, float]:
        """The rectangle in steps of the fine lattice."""
        step = GRID_SIZE / PARTS
        x, y = self._low[0] * GRID_SIZE, self._low[1] * GRID_SIZE
        x0, y0, x1, y1 = rectangle
        return (x0 - x) / step, (y0 - y) / step, (x1 - x) / step, (y1 - y) / step


def _with_closed_doors(wall: Wall) -> Wall:
    return replace(wall, openings=tuple(hole for hole in wall.openings if hole.passable))


@njit(cache=True)
def _mark(
    blocked: NDArray[np.uint8], x0: float, y0: float, x1: float, y1: float, angle: float, change: int
) -> None:
    radius = (RADIUS + SLACK) / GRID_SIZE * PARTS
    columns, lines = blocked.shape
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y, half_x, half_y = (x0 + x1) / 2, (y0 + y1) / 2, (x1 - x0) / 2, (y1 - y0) / 2
    reach_x = abs(cosine) * half_x + abs(sine) * half_y + radius
    reach_y = abs(sine) * half_x + abs(cosine) * half_y + radius
    for i in range(max(0, math.ceil(x - reach_x)), min(columns, math.floor(x + reach_x) + 1)):
        for j in range(max(0, math.ceil(y - reach_y)), min(lines, math.floor(y + reach_y) + 1)):
            dx = max(0.0, abs(cosine * (i - x) + sine * (j - y)) - half_x)
            dy = max(0.0, abs(cosine * (j - y) - sine * (i - x)) - half_y)
            if dx * dx + dy * dy < radius * radius:
                blocked[i, j] += change


@njit(cache=True)
def _all_near(
    reached: NDArray[np.bool_], low: NDArray[np.float64], near: NDArray[np.float64], reach: float
) -> bool:
    columns, lines = reached.shape
    for k in range(len(near)):
        x0, y0, x1, y1 = near[k, 0], near[k, 1], near[k, 2], near[k, 3]
        found = False
        for i in range(
            max(0, math.ceil((x0 - reach) / GRID_SIZE - low[0])),
            min(columns, math.floor((x1 + reach) / GRID_SIZE - low[0]) + 1),
        ):
            x = (i + low[0]) * GRID_SIZE
            dx = max(x0 - x, 0.0, x - x1)
            for j in range(
                max(0, math.ceil((y0 - reach) / GRID_SIZE - low[1])),
                min(lines, math.floor((y1 + reach) / GRID_SIZE - low[1]) + 1),
            ):
                if reached[i, j]:
                    y = (j + low[1]) * GRID_SIZE
                    dy = max(y0 - y, 0.0, y - y1)
                    if dx * dx + dy * dy < reach * reach:
                        found = True
                        break
            if found:
                break
        if not found:
            return False
    return True
