"""Frontiers: free cells that border on the unknown, kept up to date square metre by square metre (numba)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.perception.voxels import STOOD

REAL, BRIDGE, VISITED = 1, 2, 4
"""Values of a frontier cell: it borders on the unknown; only on what teammates have inspected; counted."""

LONGEST = 80
"""A cluster of this many cells is closed and another begun: a frontier is at most 4 m long."""

Array = NDArray[Any]


@dataclass(frozen=True)
class Frontier:
    """A cluster of free, traversable cells next to unknown ones, all in one room."""

    size: int
    """Number of cells."""
    centroid: tuple[float, float]
    point: tuple[float, float]
    """The cell of the frontier that is nearest to the centroid, metres; a robot fits there."""
    room: str | None
    """Id of the room of its cells; None where only the robot itself stood."""
    told: bool = False
    """Whether all that is unknown beyond it has been inspected by teammates."""


@numba.njit(cache=True, nogil=True)
def refresh_tiles(
    dirty: Array,
    per_tile: int,
    floor: Array,
    voxels: Array,
    band: np.uint64,
    blocked: Array,
    told: Array,
    dismissed: Array,
    known: Array,
    inspected_share: float,
    frontier: Array,
    tile_counts: Array,
    inspected: Array,
) -> None:
    """Find the frontier cells of the changed tiles, and which tiles are inspected now; clears `dirty`."""
    side = floor.shape[0]
    tiles = side // per_tile
    area = per_tile * per_tile
    for tile in range(tiles * tiles):
        if not dirty[tile]:
            continue
        dirty[tile] = 0
        total = 0
        x0, y0 = tile // tiles * per_tile, tile % tiles * per_tile
        for ix in range(x0, x0 + per_tile):
            for iy in range(y0, y0 + per_tile):
                value = 0
                if (
                    floor[ix, iy] > 0
                    and not blocked[ix, iy]
                    and not dismissed[ix, iy]
                    and not voxels[ix, iy] & band
                ):
                    for k in range(4):
                        nx, ny = ix + (k == 0) - (k == 1), iy + (k == 2) - (k == 3)
                        if nx < 0 or ny < 0 or nx >= side or ny >= side:
                            continue
                        if floor[nx, ny] == 0 and not voxels[nx, ny] & band:
                            if told[nx // per_tile * tiles + ny // per_tile]:
                                value = max(value, BRIDGE)
                            else:
                                value = REAL
                                break
                frontier[ix, iy] = value
                if value:
                    total += 1
        tile_counts[tile] = total
        enough = known[tile] >= inspected_share * area or (total == 0 and known[tile] >= 0.2 * area)
        if inspected[tile] == 0 and enough:
            inspected[tile] = 1


@numba.njit(cache=True, nogil=True)
def cluster(
    frontier: Array, tile_counts: Array, per_tile: int, floor: Array, smallest: int, largest: int, rows: Array
) -> int:
    """Group neighbouring frontier cells of one room; returns how many groups of `smallest` cells or more.

    Each group fills a row: size, middle x, middle y, cell x, cell y, room number, value; in cells.
    """
    side = floor.shape[0]
    tiles = side // per_tile
    cells = np.empty((largest, 2), np.int64)
    groups = 0
    for tile in range(tiles * tiles):
        if tile_counts[tile] == 0:
            continue
        x0, y0 = tile // tiles * per_tile, tile % tiles * per_tile
        for ix in range(x0, x0 + per_tile):
            for iy in range(y0, y0 + per_tile):
                value = frontier[ix, iy]
                if value == 0 or value & VISITED:
                    continue
                size = _collect(frontier, floor, ix, iy, cells)
                if size >= smallest and groups < rows.shape[0]:
                    _describe(cells, size, floor, value, rows[groups])
                    groups += 1
    for tile in range(tiles * tiles):
        if tile_counts[tile]:
            x0, y0 = tile // tiles * per_tile, tile % tiles * per_tile
            for ix in range(x0, x0 + per_tile):
                for iy in range(y0, y0 + per_tile):
                    frontier[ix, iy] &= VISITED - 1
    return groups


@numba.njit(cache=True, nogil=True)
def _collect(frontier: Array, floor: Array, ix: int, iy: int, cells: Array) -> int:
    side = floor.shape[0]
    value, room = frontier[ix, iy], floor[ix, iy]
    cells[0, 0], cells[0, 1] = ix, iy
    frontier[ix, iy] = value | VISITED
    size, next_cell = 1, 0
    while next_cell < size and size < cells.shape[0]:
        x, y = cells[next_cell]
        next_cell += 1
        for nx in range(max(x - 1, 0), min(x + 2, side)):
            for ny in range(max(y - 1, 0), min(y + 2, side)):
                if size < cells.shape[0] and frontier[nx, ny] == value and floor[nx, ny] == room:
                    frontier[nx, ny] = value | VISITED
                    cells[size, 0], cells[size, 1] = nx, ny
                    size += 1
    return size


@numba.njit(cache=True, nogil=True)
def _describe(cells: Array, size: int, floor: Array, value: int, row: Array) -> None:
    middle_x, middle_y = 0.0, 0.0
    for index in range(size):
        middle_x += cells[index, 0]
        middle_y += cells[index, 1]
    middle_x, middle_y = middle_x / size, middle_y / size
    nearest, best = 0, np.inf
    for index in range(size):
        distance = (cells[index, 0] - middle_x) ** 2 + (cells[index, 1] - middle_y) ** 2
        if distance < best:
            nearest, best = index, distance
    room = floor[cells[nearest, 0], cells[nearest, 1]]
    row[0], row[1], row[2] = size, middle_x, middle_y
    row[3], row[4] = cells[nearest, 0], cells[nearest, 1]
    row[5], row[6] = (0 if room == STOOD else room), value
