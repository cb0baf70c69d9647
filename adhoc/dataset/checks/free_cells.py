"""Where robots fit in a house and which moves between cells are free, computed without a simulator."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.checks.box_arrays import FloatArray, box_arrays
from adhoc.houses import floor_plan
from adhoc.houses.house import Room
from adhoc.houses.lattice_parts import largest_part, steps_between
from adhoc.houses.solids import Solid, SolidKind

SAFETY = -1e-6
"""A robot keeps this distance to every box, in metres. Below 0 it may just touch, as in the simulator, where
contact begins at a tenth of a millimetre of penetration; that tenth is what keeps this side conservative."""

_OUTLINE = 0.01
"""A point this near to a room's outline counts as in the room, as in `worlds.scene`."""


class FreeCells:
    """The lattice of robots in a house: what `worlds.free_space` finds out by collision tests, by arithmetic.

    Robots are upright cylinders that stand at multiples of `grid_size` through the world's origin and move
    to one of four neighbours; a move is tested at its thirds, like `worlds.motion.Motion` does. A cell or
    move that is free here is free in a `PyBulletWorld` of the same sizes; the reverse fails only within a few
    millimetres of contact, where the simulator rounds off edges.

    Args:
        rooms: the rooms of the house; the centre of a robot stays inside them.
        solids: the boxes of the house; floors are no obstacles.
        grid_size: metres of one move.
        radius: of a robot, in metres.
        height: of a robot, in metres; boxes that begin above it are no obstacles.

    Attributes:
        origin: lattice column and row of the array index (0, 0).
        free: (columns, rows) bool, where a robot fits.
        steps: (columns, rows, 4) bool, whether both ends and the way to the neighbour of
            `lattice_parts.MOVES` are free.
        connected: (columns, rows) bool, the largest part connected by free moves; of equally large ones the
            part with the smallest cell.
        room: (columns, rows) int16, index of the room below the cell, -1 outside the house.
    """

    def __init__(
        self,
        rooms: Sequence[Room],
        solids: Sequence[Solid],
        grid_size: float = 0.25,
        radius: float = 0.2,
        height: float = 1.7,
    ) -> None:
        self.grid_size = grid_size
        self.radius = radius
        self._edges, self._ends = _outlines(rooms)
        self._discs = _obstacles(solids, height)
        columns, rows = zip(*(corner for room in rooms for corner in room.polygon))
        self.origin = (math.floor(min(columns) / grid_size), math.floor(min(rows) / grid_size))
        shape = (
            math.ceil(max(columns) / grid_size) - self.origin[0] + 1,
            math.ceil(max(rows) / grid_size) - self.origin[1] + 1,
        )
        third = grid_size / 3
        here = self._at(shape, 0.0, 0.0)
        east = self._at(shape, third, 0.0)[0] & self._at(shape, 2 * third, 0.0)[0]
        north = self._at(shape, 0.0, third)[0] & self._at(shape, 0.0, 2 * third)[0]
        self.free: NDArray[np.bool_]
        self.room: NDArray[np.int16]
        self.free, self.room = here
        self.steps: NDArray[np.bool_] = steps_between(self.free, east, north)
        self.connected: NDArray[np.bool_] = largest_part(self.free, self.steps)

    def point(self, i: int, j: int) -> tuple[float, float]:
        """Where a cell is: x and y in metres."""
        return (self.origin[0] + i) * self.grid_size, (self.origin[1] + j) * self.grid_size

    def index(self, x: float, y: float) -> tuple[int, int]:
        """The cell nearest to a point; it may lie outside the arrays if the point does."""
        return round(x / self.grid_size) - self.origin[0], round(y / self.grid_size) - self.origin[1]

    def fits(self, x: float, y: float) -> bool:
        """Whether a robot fits at a point."""
        free, _ = self._test(np.array([x]), np.array([y]))
        return bool(free[0, 0])

    def room_at(self, x: float, y: float) -> int:
        """Index of the room below a point, -1 outside the house."""
        _, rooms = self._test(np.array([x]), np.array([y]))
        return int(rooms[0, 0])

    def _at(
        self, shape: tuple[int, int], shift_x: float, shift_y: float
    ) -> tuple[NDArray[np.bool_], NDArray[np.int16]]:
        """Whether a robot fits at every cell, shifted, and the room there."""
        xs = (self.origin[0] + np.arange(shape[0])) * self.grid_size + shift_x
        ys = (self.origin[1] + np.arange(shape[1])) * self.grid_size + shift_y
        return self._test(xs, ys)

    def _test(self, xs: FloatArray, ys: FloatArray) -> tuple[NDArray[np.bool_], NDArray[np.int16]]:
        rooms = np.full((len(xs), len(ys)), -1, np.int16)
        _find_rooms(xs, ys, self._edges, self._ends, rooms)
        free = rooms >= 0
        _block(xs, ys, *self._discs, self.radius + SAFETY, free)
        return free, rooms


def _outlines(rooms: Sequence[Room]) -> tuple[FloatArray, NDArray[np.int64]]:
    """The edges (M, 4) of all rooms one after the other, and where the edges of each room end (R,)."""
    edges = [(*start, *end) for room in rooms for start, end in floor_plan.edges(room.polygon)]
    return np.array(edges, np.float64), np.cumsum([len(room.polygon) for room in rooms])


def _obstacles(
    solids: Sequence[Solid], height: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Centres, half extents, headings and reaches on the floor plan of the boxes that a robot can touch."""
    boxes = box_arrays(solid.boxes for solid in solids if solid.kind is not SolidKind.FLOOR)
    bottoms, tops = boxes.centers[:, 2] - boxes.halves[:, 2], boxes.centers[:, 2] + boxes.halves[:, 2]
    touched = (tops > 0.0) & (bottoms < height)
    return boxes.centers[touched], boxes.halves[touched], boxes.headings[touched], boxes.reaches()[touched]


@numba.njit(cache=True, nogil=True)
def _find_rooms(
    xs: FloatArray, ys: FloatArray, edges: FloatArray, ends: NDArray[np.int64], rooms: NDArray[np.int16]
) -> None:
    """Fill in the room below every point of the lattice `xs` by `ys`, as `worlds.scene` finds it."""
    for room in range(len(ends) - 1, -1, -1):
        start = 0 if room == 0 else ends[room - 1]
        outline = edges[start : ends[room]]
        first_x = np.searchsorted(xs, outline[:, 0].min())
        last_x = np.searchsorted(xs, outline[:, 0].max(), side="right")
        first_y = np.searchsorted(ys, outline[:, 1].min())
        last_y = np.searchsorted(ys, outline[:, 1].max(), side="right")
        for i in range(first_x, last_x):
            for j in range(first_y, last_y):
                if _contains(outline, xs[i], ys[j]):
                    rooms[i, j] = room
    for i in range(len(xs)):
        for j in range(len(ys)):
            if rooms[i, j] < 0:
                rooms[i, j] = _bordering_room(xs[i], ys[j], edges, ends)


@numba.njit(cache=True, nogil=True)
def _contains(outline: FloatArray, x: float, y: float) -> bool:
    inside = False
    for edge in range(outline.shape[0]):
        ax, ay, bx, by = outline[edge, 0], outline[edge, 1], outline[edge, 2], outline[edge, 3]
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            inside = not inside
    return inside


@numba.njit(cache=True, nogil=True)
def _bordering_room(x: float, y: float, edges: FloatArray, ends: NDArray[np.int64]) -> int:
    """The room whose outline is nearest to a point outside all rooms, -1 if none is within the tolerance."""
    room, found, nearest = 0, -1, _OUTLINE
    for edge in range(edges.shape[0]):
        if edge == ends[room]:
            room += 1
        ax, ay, bx, by = edges[edge, 0], edges[edge, 1], edges[edge, 2], edges[edge, 3]
        if not (
            min(ax, bx) - _OUTLINE <= x <= max(ax, bx) + _OUTLINE
            and min(ay, by) - _OUTLINE <= y <= max(ay, by) + _OUTLINE
        ):
            continue
        length = (bx - ax) ** 2 + (by - ay) ** 2
        along = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length if length > 0.0 else 0.0
        along = min(1.0, max(0.0, along))
        distance = math.hypot(x - ax - along * (bx - ax), y - ay - along * (by - ay))
        if distance < nearest or (found < 0 and distance <= nearest):
            found, nearest = room, distance
    return found


@numba.njit(cache=True, nogil=True)
def _block(
    xs: FloatArray,
    ys: FloatArray,
    centers: FloatArray,
    halves: FloatArray,
    headings: FloatArray,
    reaches: FloatArray,
    radius: float,
    free: NDArray[np.bool_],
) -> None:
    """Mark every point of the lattice `xs` by `ys` where a disc of `radius` meets a box as not free."""
    for box in range(centers.shape[0]):
        x, y, cosine, sine = centers[box, 0], centers[box, 1], headings[box, 0], headings[box, 1]
        first_x = np.searchsorted(xs, x - reaches[box, 0] - radius)
        last_x = np.searchsorted(xs, x + reaches[box, 0] + radius, side="right")
        first_y = np.searchsorted(ys, y - reaches[box, 1] - radius)
        last_y = np.searchsorted(ys, y + reaches[box, 1] + radius, side="right")
        for i in range(first_x, last_x):
            for j in range(first_y, last_y):
                dx, dy = xs[i] - x, ys[j] - y
                beside = max(0.0, abs(cosine * dx + sine * dy) - halves[box, 0])
                before = max(0.0, abs(cosine * dy - sine * dx) - halves[box, 1])
                if beside * beside + before * before < radius * radius:
                    free[i, j] = False
