"""One frame taken into the map and the object table: the calls of the compiled passes, in their order."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Observation
from adhoc.perception.floor_view import see_floor, stand_on
from adhoc.perception.frame_buffers import FrameBuffers
from adhoc.perception.object_table import ObjectTable
from adhoc.perception.semantic_map import SemanticMap
from adhoc.perception.semantic_points import voxelize
from adhoc.perception.tracking import find_gone, merge_instances
from adhoc.perception.voxels import erase


class FrameReader:
    """Takes frames into a map and an object table, and decides nothing but what geometry decides.

    Attributes:
        frame: What was measured of each instance of the last frame.
    """

    def __init__(self, grid: SemanticMap, table: ObjectTable) -> None:
        self.frame = FrameBuffers()
        self._map = grid
        self._table = table
        self._settings = grid.settings
        self._robot_cells = math.ceil(self._settings.robot_radius / self._settings.cell)

    def read(self, observation: Observation) -> int:
        """Map a frame and merge what it shows of each instance into the table; returns how many it shows."""
        self.frame.read_labels(observation, self._table)
        found, points = self._scatter_points(observation)
        if points + self._see_floor(observation) + self._stand_on(observation):
            self._map.revision += 1
        self._merge(found, observation)
        return found

    def find_gone(self, observation: Observation) -> list[int]:
        """The slots of items that are not where they are believed to be, after `read`."""
        table, frame, settings = self._table, self.frame, self._settings
        total = find_gone(
            observation.depth,
            observation.instances,
            frame.slot_of,
            observation.camera.intrinsics,
            observation.camera.world_from_camera,
            settings.gone_range,
            len(table.ids),
            observation.step,
            table.kinds,
            table.known,
            table.boxes,
            table.last_seen,
            table.misses,
            settings.gone_looks,
            frame.gone,
        )
        slots: list[int] = frame.gone[:total].tolist()
        return slots

    def free_box(self, slot: int, box: NDArray[np.float64]) -> None:
        """Free the cells that an item filled at a place where it no longer is."""
        grid = self._map
        freed = erase(
            box,
            slot,
            grid.origin,
            self._settings.cell,
            grid.band,
            grid.offsets,
            grid.voxels,
            grid.topmost,
            grid.floor,
            grid.blocked,
            grid.known,
            grid.dirty,
            self._settings.cells_per_metre,
        )
        if freed:
            grid.revision += 1

    def finish(self, found: int) -> None:
        """Make ready for the next frame."""
        self._table.local[self.frame.slots[:found]] = -1

    def _scatter_points(self, observation: Observation) -> tuple[int, int]:
        frame, grid, table, settings = self.frame, self._map, self._table, self._settings
        found, changed = voxelize(
            observation.depth,
            observation.instances,
            frame.slot_of,
            table.kinds,
            observation.camera.intrinsics,
            observation.camera.world_from_camera,
            settings.max_depth,
            grid.origin,
            settings.cell,
            grid.band,
            grid.offsets,
            grid.voxels,
            grid.topmost,
            grid.floor,
            grid.blocked,
            grid.known,
            grid.dirty,
            settings.cells_per_metre,
            table.local,
            frame.slots,
            frame.boxes,
            frame.votes,
        )
        return int(found), int(changed)

    def _see_floor(self, observation: Observation) -> int:
        grid, table, settings = self._map, self._table, self._settings
        changed: int = see_floor(
            observation.depth,
            observation.instances,
            self.frame.slot_of,
            table.kinds,
            table.rooms,
            observation.camera.intrinsics,
            observation.camera.world_from_camera,
            min(settings.floor_depth, settings.max_depth),
            grid.origin,
            settings.cell,
            grid.band,
            grid.voxels,
            grid.floor,
            grid.known,
            grid.dirty,
            settings.cells_per_metre,
            grid.room_sums,
        )
        return changed

    def _stand_on(self, observation: Observation) -> int:
        grid = self._map
        ix, iy = grid.cell_at(observation.pose.x, observation.pose.y)
        changed: int = stand_on(
            grid.floor,
            grid.voxels,
            grid.band,
            grid.known,
            grid.dirty,
            self._settings.cells_per_metre,
            ix,
            iy,
            self._robot_cells,
        )
        return changed

    def _merge(self, found: int, observation: Observation) -> None:
        frame, table, camera = self.frame, self._table, observation.camera
        merge_instances(
            found,
            frame.slots,
            frame.boxes,
            frame.votes,
            camera.world_from_camera[:3, 3],
            float(camera.intrinsics[0, 0]),
            observation.step,
            table.kinds,
            table.known,
            table.boxes,
            table.last_seen,
            table.rooms,
            table.room_gaps,
            table.holders,
            table.vote_slots,
            table.vote_counts,
            table.can_hold,
            table.misses,
            self._map.floor,
            self._map.origin,
            self._settings.cell,
            frame.codes,
            frame.room_changed,
            frame.old_boxes,
            frame.old_rooms,
            frame.old_holders,
        )
        frame.votes[:found, :found] = 0
