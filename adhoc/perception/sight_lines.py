"""Questions to the voxel grid: what blocks a line of sight, and where a free cell of a room is (numba)."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.perception.voxels import STRUCTURE, TOP_BIT

Array = NDArray[Any]


@numba.njit(cache=True, nogil=True)
def first_obstruction(
    eye: Array,
    target: Array,
    own_slot: int,
    kinds: Array,
    origin: Array,
    cell: float,
    voxels: Array,
    topmost: Array,
) -> float:
    """How far from the target, in metres, the line from `eye` first meets a filled voxel; 0 if it meets none.

    Columns whose topmost thing is the target itself (`own_slot`) are looked through. A wall on the way makes
    the answer infinite, however near it stands to the target: what leans on a wall is not seen through it.
    """
    dx, dy, dz = target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]
    distance = (dx * dx + dy * dy + dz * dz) ** 0.5
    steps = int(2 * distance / cell) + 1
    side = voxels.shape[0]
    last_x, last_y = int((target[0] - origin[0]) / cell), int((target[1] - origin[1]) / cell)
    answer = 0.0
    for index in range(steps):
        share = index / steps
        ix = int((eye[0] + dx * share - origin[0]) / cell)
        iy = int((eye[1] + dy * share - origin[1]) / cell)
        if ix < 0 or iy < 0 or ix >= side or iy >= side:
            continue
        above = topmost[ix, iy] - 1
        if above == own_slot or (ix == last_x and iy == last_y and above >= 0 and kinds[above] == STRUCTURE):
            continue
        bit = min(max(int((eye[2] + dz * share) / cell), 0), TOP_BIT)
        if voxels[ix, iy] & (np.uint64(1) << np.uint64(bit)):
            if above >= 0 and kinds[above] == STRUCTURE:
                return np.inf
            if answer == 0.0:
                answer = distance * (1 - share)
    return answer


@numba.njit(cache=True, nogil=True)
def nearest_free_cell(
    ix: int, iy: int, room: int, reach: int, floor: Array, blocked: Array
) -> tuple[int, int]:
    """The cell of `room` nearest to (ix, iy) where a robot fits, within `reach` cells; (-1, -1) if none."""
    side = floor.shape[0]
    best, answer = (reach + 1) ** 2, (-1, -1)
    for ring in range(reach + 1):
        if ring * ring > best:
            break
        for x in range(max(ix - ring, 0), min(ix + ring + 1, side)):
            inner = 2 * ring if abs(x - ix) < ring and ring > 0 else 1
            for y in range(iy - ring, iy + ring + 1, max(inner, 1)):
                if y < 0 or y >= side or floor[x, y] != room or blocked[x, y]:
                    continue
                distance = (x - ix) ** 2 + (y - iy) ** 2
                if distance < best:
                    best, answer = distance, (x, y)
    return answer
