"""The top-down view of a voxel grid, for pictures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.perception.object_table import ObjectTable
from adhoc.perception.voxels import STOOD

UNKNOWN, FREE, OCCUPIED = range(3)
"""The states of a map cell."""


@dataclass(frozen=True, eq=False)
class TopDown:
    """A copy of the known part of the map, for pictures. Arrays are indexed [x, y].

    state (X, Y) uint8: `UNKNOWN`, `FREE` or `OCCUPIED`; rooms (X, Y) int16 and categories (X, Y) int16:
    indexes into `room_ids` and `category_names`, -1 where unknown; heights (X, Y) float32: top of the
    highest thing seen, metres.
    """

    origin: tuple[float, float]
    """World position of the corner of cell [0, 0], metres."""
    cell: float
    state: NDArray[np.uint8]
    rooms: NDArray[np.int16]
    categories: NDArray[np.int16]
    heights: NDArray[np.float32]
    room_ids: tuple[str, ...]
    category_names: tuple[str, ...]


def draw_top_down(
    origin: tuple[float, float],
    cell: float,
    voxels: NDArray[np.uint64],
    band: np.uint64,
    floor: NDArray[np.uint8],
    topmost: NDArray[np.int32],
    table: ObjectTable,
) -> TopDown:
    """Flatten the known part of a grid whose cell [0, 0] has its corner at `origin`, metres."""
    occupied = (voxels & band) != 0
    known = occupied | (floor > 0)
    xs, ys = np.flatnonzero(known.any(1)), np.flatnonzero(known.any(0))
    window = (slice(xs[0], xs[-1] + 1), slice(ys[0], ys[-1] + 1)) if xs.size else (slice(0, 0), slice(0, 0))
    names = tuple(dict.fromkeys(table.categories))
    of_slot = np.array([-1, *(names.index(name) for name in table.categories)], np.int16)
    floor = floor[window].astype(np.int16)
    rooms = np.where((floor > 0) & (floor < STOOD), floor - 1, -1).astype(np.int16)
    state = np.where(occupied[window], OCCUPIED, np.where(floor > 0, FREE, UNKNOWN)).astype(np.uint8)
    words = voxels[window]
    heights = np.where(words > 0, np.floor(np.log2(np.maximum(words, 1).astype(np.float64))) + 1, 0)
    corner = np.array(origin) + cell * np.array([window[0].start, window[1].start])
    return TopDown(
        (float(corner[0]), float(corner[1])),
        cell,
        state,
        rooms,
        of_slot[topmost[window]],
        (heights * cell).astype(np.float32),
        tuple(table.room_ids[1:]),
        names,
    )
