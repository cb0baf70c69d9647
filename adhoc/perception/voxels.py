"""The voxel grid: what stands where (numba).

The grid is exact and small: each column of the map is one 64-bit word whose bit k says that something
other than floor was seen between k and k+1 cells above the floor (3.2 m at 5 cm). `erase` takes those
of one object out again. For frames see `semantic_points`, for the floor `floor_view`.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

IGNORED, FLOOR_KIND, STRUCTURE, FURNITURE, ITEM, ROBOT = range(6)
"""What a slot (a row of the object table) stands for."""

STOOD = 255
"""Floor value of a cell that a robot has stood on and whose room it has not seen."""

TOP_BIT = 62
"""The highest voxel of a column; what is higher counts as there."""

Array = NDArray[Any]


@numba.njit(cache=True, nogil=True)
def mark_tiles(dirty: Array, ix: int, iy: int, reach: int, per_tile: int, tiles: int) -> None:
    """Mark the tiles that lie within `reach` cells of a cell as changed."""
    side = tiles * per_tile
    x0, x1 = max(ix - reach, 0) // per_tile, min(ix + reach, side - 1) // per_tile
    y0, y1 = max(iy - reach, 0) // per_tile, min(iy + reach, side - 1) // per_tile
    for tx in range(x0, x1 + 1):
        for ty in range(y0, y1 + 1):
            dirty[tx * tiles + ty] = 1


@numba.njit(cache=True, nogil=True)
def inflate(blocked: Array, offsets: Array, ix: int, iy: int, side: int, change: int) -> None:
    """Count one obstacle cell more or less within a robot's radius of the cells around it."""
    for index in range(offsets.shape[0]):
        x, y = ix + offsets[index, 0], iy + offsets[index, 1]
        if 0 <= x < side and 0 <= y < side:
            blocked[x, y] += change


@numba.njit(cache=True, nogil=True)
def reach_of(offsets: Array) -> int:
    """How many cells away the farthest of some (x, y) offsets lies."""
    reach = 0
    for index in range(offsets.shape[0]):
        reach = max(reach, offsets[index, 0])
    return reach


@numba.njit(cache=True, nogil=True)
def occupy(
    ix: int,
    iy: int,
    offsets: Array,
    reach: int,
    floor: Array,
    blocked: Array,
    known: Array,
    dirty: Array,
    per_tile: int,
) -> int:
    """Note that a column got its first voxel in the band of obstacles; returns 1 if it was unknown before."""
    side = floor.shape[0]
    tiles = side // per_tile
    inflate(blocked, offsets, ix, iy, side, 1)
    mark_tiles(dirty, ix, iy, reach + 1, per_tile, tiles)
    if floor[ix, iy]:
        return 0
    known[ix // per_tile * tiles + iy // per_tile] += 1
    return 1


@numba.njit(cache=True, nogil=True)
def erase(
    box: Array,
    slot: int,
    origin: Array,
    cell: float,
    band: np.uint64,
    offsets: Array,
    voxels: Array,
    topmost: Array,
    floor: Array,
    blocked: Array,
    known: Array,
    dirty: Array,
    per_tile: int,
) -> int:
    """Free the voxels of an item that is no longer at `box`; returns how many cells became free.

    Only columns whose topmost thing is the item are touched. A voxel that it shared with what it lay on is
    freed too, and filled again by the next look at it.
    """
    side = voxels.shape[0]
    tiles = side // per_tile
    reach = reach_of(offsets)
    mask = np.uint64(0)
    for bit in range(min(max(int(box[2] / cell), 0), TOP_BIT), min(max(int(box[5] / cell), 0), TOP_BIT) + 1):
        mask |= np.uint64(1) << np.uint64(bit)
    freed = 0
    for ix in range(
        max(int((box[0] - origin[0]) / cell), 0), min(int((box[3] - origin[0]) / cell) + 1, side)
    ):
        for iy in range(
            max(int((box[1] - origin[1]) / cell), 0), min(int((box[4] - origin[1]) / cell) + 1, side)
        ):
            if topmost[ix, iy] != slot + 1:
                continue
            word = voxels[ix, iy]
            left = word & ~mask
            voxels[ix, iy] = left
            topmost[ix, iy] = 0
            if word & band and not left & band:
                inflate(blocked, offsets, ix, iy, side, -1)
                mark_tiles(dirty, ix, iy, reach + 1, per_tile, tiles)
                freed += 1
                if floor[ix, iy] == 0:
                    known[ix // per_tile * tiles + iy // per_tile] -= 1
    return freed
