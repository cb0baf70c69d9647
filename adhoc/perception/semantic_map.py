"""The top-down, object- and room-aware semantic map of one robot."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Point
from adhoc.perception.frontiers import BRIDGE, LONGEST, Frontier, cluster, refresh_tiles
from adhoc.perception.object_table import SEEN, ObjectTable
from adhoc.perception.settings import PerceptionSettings
from adhoc.perception.sight_lines import first_obstruction, nearest_free_cell
from adhoc.perception.top_down import TopDown, draw_top_down
from adhoc.perception.voxels import STOOD, TOP_BIT

NEAR_TARGET = 0.1
"""What stands nearer to the target of a line of sight is no obstruction: voxels are coarse. Metres."""

_MOST_FRONTIERS = 256


class SemanticMap:
    """What a robot knows of space (paper, section Visual Semantic Perception), from its own pixels alone.

    A voxel grid flattened per column: free where floor was seen and nothing stands between the floor and
    `obstacle_top`, occupied where something does, unknown elsewhere. Robots are never in it. The arrays are
    indexed [x, y] by `cell`-sized cells from `origin`; they exist once the map is anchored.

    Attributes:
        robots: Other robots that were seen a moment ago, and where, in metres.
        revision: Grows whenever cells change.
    """

    def __init__(self, settings: PerceptionSettings | None = None, table: ObjectTable | None = None) -> None:
        self.settings = settings or PerceptionSettings()
        self.table = table or ObjectTable()
        self.robots: Mapping[str, tuple[float, float]] = {}
        self.revision = 0
        self.offsets = _disc(self.settings.robot_radius, self.settings.cell)
        self.band = np.uint64((1 << min(round(self.settings.obstacle_top / self.settings.cell), TOP_BIT)) - 1)
        self._corner = (0.0, 0.0)
        self.origin: NDArray[np.float64] = np.zeros(2)
        self._frontiers: tuple[Frontier, ...] = ()
        self._frontier_revision = -1
        self._waiting: list[tuple[int, int]] = []
        self._allocate(0)

    @property
    def anchored(self) -> bool:
        """Whether the map has a place in the world yet."""
        return len(self.floor) > 0

    def anchor(self, x: float, y: float) -> None:
        """Give the map its place, around the first pose. Its tiles lie on whole metres of the world."""
        side = math.ceil(self.settings.extent)
        self._corner = (float(math.floor(x) - side // 2), float(math.floor(y) - side // 2))
        self.origin = np.array(self._corner)
        self._allocate(side)
        self.tell_covered(self._waiting)

    def is_known(self, x: float, y: float) -> bool:
        """Whether the cell at a point, in metres, is known to be free or occupied."""
        ix, iy = self.cell_at(x, y)
        return self._inside(ix, iy) and bool(self.floor[ix, iy] or self.voxels[ix, iy] & self.band)

    def is_traversable(self, x: float, y: float) -> bool:
        """Whether a robot fits at a point as far as is known: no obstacle within its radius.

        Unknown cells are no obstacles; see `is_known`. False outside the map.
        """
        ix, iy = self.cell_at(x, y)
        return self._inside(ix, iy) and self.blocked[ix, iy] == 0

    def room_at(self, x: float, y: float) -> str | None:
        """Id of the room at a point, in metres; where a robot stood unseeing, of the nearest floor seen."""
        ix, iy = self.cell_at(x, y)
        if not self._inside(ix, iy) or self.floor[ix, iy] == 0:
            return None
        if self.floor[ix, iy] != STOOD:
            return self.table.room_id(int(self.floor[ix, iy]))
        reach = self.settings.cells_per_metre // 2
        near = self.floor[max(ix - reach, 0) : ix + reach + 1, max(iy - reach, 0) : iy + reach + 1]
        named = near[(near > 0) & (near < STOOD)]
        return self.table.room_id(int(np.bincount(named).argmax())) if named.size else None

    def line_of_sight(self, eye: Point, target: Point, object_id: str | None = None) -> bool:
        """Whether nothing seen so far stands between two points, in metres.

        What stands within 0.1 m of the target does not count, unless it is a wall, nor does the object
        `object_id` itself.
        """
        slot = self.table.slots.get(object_id, -2) if object_id is not None else -2
        obstruction = first_obstruction(
            np.array(eye, np.float64),
            np.array(target, np.float64),
            slot,
            self.table.kinds,
            self.origin,
            self.settings.cell,
            self.voxels,
            self.topmost,
        )
        return bool(obstruction <= NEAR_TARGET)

    def extent_of(self, object_id: str) -> tuple[Point, Point] | None:
        """Lowest and highest corner of the box around what was seen of an object; None if never seen."""
        slot = self.table.slots.get(object_id)
        if slot is None or self.table.known[slot] != SEEN:
            return None
        x0, y0, z0, x1, y1, z1 = self.table.boxes[slot].tolist()
        return (x0, y0, z0), (x1, y1, z1)

    def frontiers(self, room: str | None = None, told: bool = False) -> tuple[Frontier, ...]:
        """Frontiers of the explored space, of one room or of all, largest first.

        With `told`, also those beyond which teammates have inspected everything. Cached until the map
        changes; a change costs only the square metres that changed.
        """
        if self._frontier_revision != self.revision:
            self._frontier_revision = self.revision
            self._frontiers = self._find_frontiers()
        return tuple(
            it for it in self._frontiers if (room is None or it.room == room) and (told or not it.told)
        )

    def is_frontier(self, x: float, y: float, radius: float = 0.4) -> bool:
        """Whether any cell within `radius` metres (a square) of a point borders on the unknown."""
        if not self.anchored:
            return False
        self._refresh()
        return bool((self.frontier[self._window(x, y, radius)] > 0).any())

    def unknown_direction(self, x: float, y: float, radius: float = 1.0) -> tuple[float, float] | None:
        """From a point to the middle of the unknown cells in a square around it; None if there are none."""
        window = self._window(x, y, radius)
        unknown = (self.floor[window] == 0) & ((self.voxels[window] & self.band) == 0)
        xs, ys = np.nonzero(unknown)
        if not xs.size:
            return None
        middle = self.point_of(window[0].start + float(xs.mean()), window[1].start + float(ys.mean()))
        return middle[0] - x, middle[1] - y

    def dismiss(self, x: float, y: float, radius: float = 0.6) -> None:
        """Never again call cells in a square around a point a frontier: seen in vain, or out of reach."""
        window = self._window(x, y, radius)
        self.dismissed[window] = 1
        per_tile = self.settings.cells_per_metre
        tiles = len(self.floor) // per_tile
        for tx in range(window[0].start // per_tile, (window[0].stop - 1) // per_tile + 1):
            for ty in range(window[1].start // per_tile, (window[1].stop - 1) // per_tile + 1):
                self.dirty[tx * tiles + ty] = 1
        self.revision += 1

    def free_point(self, room: str) -> tuple[float, float] | None:
        """A point of the room where a robot fits, near the middle of its known floor, or None."""
        number = self.table.room_numbers.get(room, 0)
        if not self.anchored or not 0 < number < STOOD or self.room_sums[number, 2] == 0:
            return None
        x, y = (self.room_sums[number, :2] / self.room_sums[number, 2]).tolist()
        ix, iy = self.cell_at(x, y)
        reach = 8 * self.settings.cells_per_metre
        found = nearest_free_cell(ix, iy, number, reach, self.floor, self.blocked)
        return None if found[0] < 0 else self.point_of(*found)

    def known_area(self, room: str) -> float:
        """Square metres of the room's floor that were seen."""
        number = self.table.room_numbers.get(room, 0)
        if not self.anchored or not 0 < number < STOOD:
            return 0.0
        return float(self.room_sums[number, 2]) * self.settings.cell**2

    def tell_covered(self, cells: Iterable[tuple[int, int]]) -> None:
        """Note square metres (floor(x), floor(y)) that teammates have inspected."""
        if not self.anchored:
            self._waiting.extend(cells)
            return
        tiles = len(self.floor) // self.settings.cells_per_metre
        for x, y in cells:
            tx, ty = x - int(self.origin[0]), y - int(self.origin[1])
            if 0 <= tx < tiles and 0 <= ty < tiles and not self.told[tx * tiles + ty]:
                self.told[tx * tiles + ty] = 1
                for nx in range(max(tx - 1, 0), min(tx + 2, tiles)):
                    self.dirty[nx * tiles + max(ty - 1, 0) : nx * tiles + min(ty + 2, tiles)] = 1
                self.revision += 1

    def take_covered(self) -> tuple[tuple[int, int], ...]:
        """Square metres (floor(x), floor(y)) that this robot has inspected since the last call."""
        if not self.anchored:
            return ()
        self._refresh()
        tiles = len(self.floor) // self.settings.cells_per_metre
        fresh = np.flatnonzero(self.inspected == 1)
        self.inspected[fresh] = 2
        x0, y0 = int(self.origin[0]), int(self.origin[1])
        return tuple((x0 + tile // tiles, y0 + tile % tiles) for tile in fresh.tolist())

    def top_down(self) -> TopDown:
        """A copy of the known part of the map, for pictures."""
        return draw_top_down(
            self._corner, self.settings.cell, self.voxels, self.band, self.floor, self.topmost, self.table
        )

    def point_of(self, ix: float, iy: float) -> tuple[float, float]:
        """The middle of a cell, metres."""
        x0, y0 = self._corner
        return x0 + (ix + 0.5) * self.settings.cell, y0 + (iy + 0.5) * self.settings.cell

    def cell_at(self, x: float, y: float) -> tuple[int, int]:
        """The cell (ix, iy) of a point, in metres."""
        x0, y0 = self._corner
        return math.floor((x - x0) / self.settings.cell), math.floor((y - y0) / self.settings.cell)

    def _find_frontiers(self) -> tuple[Frontier, ...]:
        if not self.anchored:
            return ()
        self._refresh()
        rows = np.empty((_MOST_FRONTIERS, 7))
        settings = self.settings
        found = cluster(
            self.frontier,
            self.tile_counts,
            settings.cells_per_metre,
            self.floor,
            settings.frontier_cells,
            LONGEST,
            rows,
        )
        frontiers = []
        for size, middle_x, middle_y, ix, iy, room, value in rows[:found].tolist():
            frontiers.append(
                Frontier(
                    int(size),
                    self.point_of(middle_x, middle_y),
                    self.point_of(int(ix), int(iy)),
                    self.table.room_id(int(room)),
                    int(value) == BRIDGE,
                )
            )
        return tuple(sorted(frontiers, key=lambda it: (-it.size, it.point)))

    def _refresh(self) -> None:
        refresh_tiles(
            self.dirty,
            self.settings.cells_per_metre,
            self.floor,
            self.voxels,
            self.band,
            self.blocked,
            self.told,
            self.dismissed,
            self.known,
            self.settings.inspected_share,
            self.frontier,
            self.tile_counts,
            self.inspected,
        )

    def _window(self, x: float, y: float, radius: float) -> tuple[slice, slice]:
        ix, iy = self.cell_at(x, y)
        reach = round(radius / self.settings.cell)
        side = len(self.floor)
        return (
            slice(min(max(ix - reach, 0), side), min(max(ix + reach + 1, 0), side)),
            slice(min(max(iy - reach, 0), side), min(max(iy + reach + 1, 0), side)),
        )

    def _inside(self, ix: int, iy: int) -> bool:
        return 0 <= ix < len(self.floor) and 0 <= iy < len(self.floor)

    def _allocate(self, metres: int) -> None:
        side, tiles = metres * self.settings.cells_per_metre, metres * metres
        self.voxels: NDArray[np.uint64] = np.zeros((side, side), np.uint64)
        self.topmost: NDArray[np.int32] = np.zeros((side, side), np.int32)
        self.floor: NDArray[np.uint8] = np.zeros((side, side), np.uint8)
        self.blocked: NDArray[np.uint16] = np.zeros((side, side), np.uint16)
        self.frontier: NDArray[np.uint8] = np.zeros((side, side), np.uint8)
        self.dismissed: NDArray[np.uint8] = np.zeros((side, side), np.uint8)
        self.known: NDArray[np.int32] = np.zeros(tiles, np.int32)
        self.dirty: NDArray[np.uint8] = np.zeros(tiles, np.uint8)
        self.told: NDArray[np.uint8] = np.zeros(tiles, np.uint8)
        self.tile_counts: NDArray[np.int32] = np.zeros(tiles, np.int32)
        self.inspected: NDArray[np.uint8] = np.zeros(tiles, np.uint8)
        self.room_sums: NDArray[np.float64] = np.zeros((STOOD + 1, 3))


def _disc(radius: float, cell: float) -> NDArray[np.int64]:
    """Offsets (N, 2) of the cells whose middle is within `radius` and half a cell of a cell's middle."""
    reach = math.ceil((radius + cell / 2) / cell)
    steps = np.arange(-reach, reach + 1)
    grid = np.stack(np.meshgrid(steps, steps, indexing="ij"), -1).reshape(-1, 2)
    inside = (grid**2).sum(1) <= ((radius + cell / 2) / cell) ** 2
    return np.asarray(grid[inside], np.int64)
