"""Which floor cells a frame sees, and of which room they are (numba).

At a grazing angle the pixels of a floor are sparser than cells, so that scattering them would leave holes
that look like frontiers. Therefore each floor cell in view is projected into the picture instead.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.perception.voxels import FLOOR_KIND, STOOD, mark_tiles

_FAR = 1000.0
_LEVEL = 1e-7
_MARGIN = 1e-3

Array = NDArray[Any]


@numba.njit(cache=True, nogil=True)
def see_floor(
    depth: Array,
    instances: Array,
    slot_of: Array,
    kinds: Array,
    room_of_slot: Array,
    intrinsics: Array,
    world_from_camera: Array,
    max_depth: float,
    origin: Array,
    cell: float,
    band: np.uint64,
    voxels: Array,
    floor: Array,
    known: Array,
    dirty: Array,
    per_tile: int,
    room_sums: Array,
) -> int:
    """Label the floor cells that one frame sees with their room; returns the number of newly known cells.

    A cell is floor when a pixel just below its projection shows floor, and the other three pixels around
    it show floor too or something farther away. `room_sums[k]` grows by (x, y, 1) for each cell of room k.
    """
    height, width = depth.shape
    side = voxels.shape[0]
    tiles = side // per_tile
    focal, centre_u, centre_v = intrinsics[0, 0], intrinsics[0, 2], intrinsics[1, 2]
    camera = world_from_camera[:3, 3]
    low_x, high_x, low_y, high_y = _floor_in_view(intrinsics, world_from_camera, max_depth, width)
    ix0 = max(int((low_x - origin[0]) / cell), 0)
    ix1 = min(int((high_x - origin[0]) / cell) + 1, side)
    iy0 = max(int((low_y - origin[1]) / cell), 0)
    iy1 = min(int((high_y - origin[1]) / cell) + 1, side)
    right_x, right_y = world_from_camera[0, 0], world_from_camera[1, 0]
    down_x, down_y, down_z = world_from_camera[0, 1], world_from_camera[1, 1], world_from_camera[2, 1]
    ahead_x, ahead_y, ahead_z = world_from_camera[0, 2], world_from_camera[1, 2], world_from_camera[2, 2]
    changed = 0
    sides = _sides_of_view(intrinsics, world_from_camera, max_depth, height, width)
    for ix in range(ix0, ix1):
        x = origin[0] + (ix + 0.5) * cell - camera[0]
        low_y, high_y = _stretch_in_view(sides, x)
        if low_y > high_y:
            continue
        first = max(iy0, int((max(low_y, -_FAR) + camera[1] - origin[1]) / cell) - 1)
        last = min(iy1, int((min(high_y, _FAR) + camera[1] - origin[1]) / cell) + 2)
        for iy in range(first, last):
            before = floor[ix, iy]
            if 0 < before < STOOD:
                continue
            y = origin[1] + (iy + 0.5) * cell - camera[1]
            along = ahead_x * x + ahead_y * y - ahead_z * camera[2]
            if along <= 0.05 or along > max_depth:
                continue
            u = focal * (right_x * x + right_y * y) / along + centre_u
            if u < 0 or u >= width - 1:
                continue
            v = focal * (down_x * x + down_y * y - down_z * camera[2]) / along + centre_v
            if v < 0 or v >= height - 1:
                continue
            i, j = int(v), int(u)
            room = 0
            clear = True
            for k in range(4):
                row, column = i + 1 - k // 2, j + k % 2
                instance = instances[row, column]
                slot = slot_of[instance] if 0 <= instance < slot_of.shape[0] else -1
                if slot >= 0 and kinds[slot] == FLOOR_KIND:
                    if room == 0 and k < 2:
                        room = room_of_slot[slot]
                elif not along + 0.02 < depth[row, column] < np.inf:
                    clear = False
                    break
            if not clear or room == 0:
                continue
            floor[ix, iy] = room
            room_sums[room, 0] += x + camera[0]
            room_sums[room, 1] += y + camera[1]
            room_sums[room, 2] += 1.0
            mark_tiles(dirty, ix, iy, 1, per_tile, tiles)
            if before == 0 and not voxels[ix, iy] & band:
                known[ix // per_tile * tiles + iy // per_tile] += 1
                changed += 1
    return changed


@numba.njit(cache=True, nogil=True)
def _sides_of_view(
    intrinsics: Array, world_from_camera: Array, max_depth: float, height: int, width: int
) -> Array:
    """The floor in view as six half-planes a + b x + c y >= 0, x and y from the camera; rows (a, b, c)."""
    focal, camera_z = intrinsics[0, 0], world_from_camera[2, 3]
    rays = np.empty((3, 3))
    for axis in range(3):
        rays[axis, 0] = -world_from_camera[2, axis] * camera_z
        rays[axis, 1:] = world_from_camera[:2, axis]
    right, down, ahead = rays
    sides = np.empty((6, 3))
    sides[0] = ahead
    sides[1] = -ahead
    sides[1, 0] += max_depth
    sides[2] = focal * right + intrinsics[0, 2] * ahead
    sides[3] = (width - 1 - intrinsics[0, 2]) * ahead - focal * right
    sides[4] = focal * down + intrinsics[1, 2] * ahead
    sides[5] = (height - 1 - intrinsics[1, 2]) * ahead - focal * down
    return sides


@numba.njit(cache=True, nogil=True)
def _stretch_in_view(sides: Array, x: float) -> tuple[float, float]:
    """From where to where the half-planes hold along y at x, give or take rounding; empty if low > high."""
    low, high = -np.inf, np.inf
    for side in range(sides.shape[0]):
        constant, slope = sides[side, 0] + sides[side, 1] * x, sides[side, 2]
        if slope > _LEVEL:
            low = max(low, -constant / slope)
        elif slope < -_LEVEL:
            high = min(high, -constant / slope)
        elif constant < -_MARGIN:
            return np.inf, -np.inf
    return low, high


@numba.njit(cache=True, nogil=True)
def _floor_in_view(
    intrinsics: Array, world_from_camera: Array, max_depth: float, width: int
) -> tuple[float, float, float, float]:
    """A box (x0, x1, y0, y1) around the floor that a camera can see: its apex, and its farthest edge."""
    x, y, height = world_from_camera[0, 3], world_from_camera[1, 3], world_from_camera[2, 3]
    ahead_x, ahead_y, ahead_z = world_from_camera[0, 2], world_from_camera[1, 2], world_from_camera[2, 2]
    level = (ahead_x * ahead_x + ahead_y * ahead_y) ** 0.5
    spread = max_depth * width / 2 / intrinsics[0, 0]
    if level < 0.2:
        return x - spread, x + spread, y - spread, y + spread
    reach = min((max_depth + ahead_z * height) / level, 2 * max_depth)
    nearest = 0.0
    if ahead_z < 0:
        nearest = min(nearest, -level * height)
    low_x = high_x = x + nearest * ahead_x / level
    low_y = high_y = y + nearest * ahead_y / level
    for side in (-spread, spread):
        for distance in (0.0, reach):
            corner_x = x + distance * ahead_x / level + side * world_from_camera[0, 0]
            corner_y = y + distance * ahead_y / level + side * world_from_camera[1, 0]
            low_x, high_x = min(low_x, corner_x), max(high_x, corner_x)
            low_y, high_y = min(low_y, corner_y), max(high_y, corner_y)
    return low_x, high_x, low_y, high_y


@numba.njit(cache=True, nogil=True)
def stand_on(
    floor: Array,
    voxels: Array,
    band: np.uint64,
    known: Array,
    dirty: Array,
    per_tile: int,
    ix: int,
    iy: int,
    reach: int,
) -> int:
    """Mark the cells under a robot as floor: it stands there, and no camera looks at its own feet."""
    side = floor.shape[0]
    tiles = side // per_tile
    changed = 0
    for x in range(max(ix - reach, 0), min(ix + reach + 1, side)):
        for y in range(max(iy - reach, 0), min(iy + reach + 1, side)):
            if floor[x, y] == 0 and (x - ix) ** 2 + (y - iy) ** 2 <= reach * reach:
                floor[x, y] = STOOD
                mark_tiles(dirty, x, y, 1, per_tile, tiles)
                if not voxels[x, y] & band:
                    known[x // per_tile * tiles + y // per_tile] += 1
                    changed += 1
    return changed
