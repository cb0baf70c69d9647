"""From the pixels of a frame to semantic points, and from those to voxels and boxes (numba).

Paper, section Visual Semantic Perception: points from depth, instances and pose are voxelized and flattened
into a top-down map. Neighbouring pixels of a row mostly show the same instance, so a frame is read run by
run, and each run only as its kind needs: walls are not measured, floors neither measured nor voxelized.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.perception.voxels import FLOOR_KIND, ITEM, ROBOT, STRUCTURE, TOP_BIT, occupy, reach_of

LOCAL = 128
"""At most so many instances of one frame are measured."""

_CONTACT = 0.08

Array = NDArray[Any]


@numba.njit(cache=True, nogil=True)
def voxelize(
    depth: Array,
    instances: Array,
    slot_of: Array,
    kinds: Array,
    intrinsics: Array,
    world_from_camera: Array,
    max_depth: float,
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
    local_of: Array,
    slots: Array,
    boxes: Array,
    votes: Array,
) -> tuple[int, int]:
    """Scatter the points of one frame into the voxel grid and measure each instance.

    Fills, per instance of the frame (at most `LOCAL`), its slot in `slots`, the box around its points in
    `boxes` (x0, y0, z0, x1, y1, z1), and in `votes[i, j]` the number of pixels of instance j seen directly
    below and close to item i: what the item stands on.

    Returns the number of instances and of newly known cells.
    """
    height, width = depth.shape
    side = voxels.shape[0]
    across = (np.arange(width) - intrinsics[0, 2]) / intrinsics[0, 0]
    points, cells = np.empty((3, width)), np.empty((3, width), np.int32)
    item_row, item_local, item_z = np.full(width, -2, np.int64), np.empty(width, np.int64), np.empty(width)
    reach = reach_of(offsets)
    found, changed, last_item_row = 0, 0, -2
    for i in range(height):
        v = (i - intrinsics[1, 2]) / intrinsics[0, 0]
        _project(depth[i], across, v, world_from_camera, origin, 1.0 / cell, points, cells)
        below_items = last_item_row == i - 1
        end = 0
        while True:
            start, end = _next_run(depth[i], instances[i], end, max_depth)
            if start == end:
                break
            instance = instances[i, start]
            slot = slot_of[instance] if 0 <= instance < slot_of.shape[0] else -1
            if slot < 0:
                continue
            kind = kinds[slot]
            if kind != STRUCTURE and local_of[slot] < 0 and found < LOCAL:
                local_of[slot], slots[found] = found, slot
                boxes[found, :3], boxes[found, 3:] = np.inf, -np.inf
                found += 1
            local = local_of[slot] if kind != STRUCTURE else -1
            if local >= 0 and below_items:
                _count_contacts(depth, i, start, end, points[2], item_row, item_local, item_z, local, votes)
            if kind == FLOOR_KIND:
                continue
            if local >= 0:
                _grow_box(boxes[local], points, start, end)
                if kind == ITEM:
                    item_row[start:end], item_local[start:end] = i, local
                    item_z[start:end] = points[2, start:end]
                    last_item_row = i
            if kind == ROBOT:
                continue
            # Not a function of its own: called, this loop took half as long again.
            for j in range(np.uint64(start), np.uint64(end)):
                ix, iy, bit = cells[0, j], cells[1, j], min(max(cells[2, j], 0), TOP_BIT)
                if ix < 0 or iy < 0 or ix >= side or iy >= side:
                    continue
                word = voxels[ix, iy]
                voxel = np.uint64(1) << np.uint64(bit)
                if word < voxel + voxel:
                    topmost[ix, iy] = slot + 1
                if word & voxel:
                    continue
                voxels[ix, iy] = word | voxel
                if voxel & band and not word & band:
                    changed += occupy(ix, iy, offsets, reach, floor, blocked, known, dirty, per_tile)
    return found, changed


@numba.njit(cache=True, nogil=True)
def _next_run(depths: Array, owners: Array, start: int, max_depth: float) -> tuple[int, int]:
    """The next pixels of a row that show one instance within reach: from one column up to another."""
    width, one = np.uint64(len(depths)), np.uint64(1)
    column = np.uint64(start)
    while column < width and not depths[column] <= max_depth:
        column += one
    first = column
    while column < width and owners[column] == owners[first] and depths[column] <= max_depth:
        column += one
    return int(first), int(column)


@numba.njit(cache=True, nogil=True)
def _project(
    depths: Array,
    across: Array,
    v: float,
    world_from_camera: Array,
    origin: Array,
    inverse: float,
    points: Array,
    cells: Array,
) -> None:
    """World coordinates and voxels (3, W) of the pixels of a row; without meaning where nothing is hit."""
    for axis in range(3):
        middle = world_from_camera[axis, 1] * v + world_from_camera[axis, 2]
        right, eye = world_from_camera[axis, 0], world_from_camera[axis, 3]
        start = origin[axis] if axis < 2 else 0.0
        row, cell_row = points[axis], cells[axis]
        for j in range(len(depths)):
            row[j] = eye + depths[j] * (middle + right * across[j])
        for j in range(len(depths)):
            cell_row[j] = np.int32((row[j] - start) * inverse)


@numba.njit(cache=True, nogil=True)
def _count_contacts(
    depth: Array,
    i: int,
    start: int,
    end: int,
    heights: Array,
    item_row: Array,
    item_local: Array,
    item_z: Array,
    local: int,
    votes: Array,
) -> None:
    """Count the pixels of a run that lie directly below an item in the picture and close to it in space."""
    for j in range(start, end):
        if (
            item_row[j] == i - 1
            and item_local[j] != local
            and abs(depth[i - 1, j] - depth[i, j]) < _CONTACT
            and abs(item_z[j] - heights[j]) < _CONTACT
        ):
            votes[item_local[j], local] += 1


@numba.njit(cache=True, nogil=True)
def _grow_box(box: Array, points: Array, start: int, end: int) -> None:
    for axis in range(3):
        low, high = box[axis], box[axis + 3]
        for j in range(np.uint64(start), np.uint64(end)):
            low, high = min(low, points[axis, j]), max(high, points[axis, j])
        box[axis], box[axis + 3] = low, high
