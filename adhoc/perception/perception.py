"""Visual semantic perception: what one robot makes of its observations (paper section of that name)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Label, ObjectRecord, Observation, RoomRecord
from adhoc.perception.frame_reader import FrameReader
from adhoc.perception.holders import decide_holders
from adhoc.perception.object_records import ObjectRecords
from adhoc.perception.object_table import NO_RECEPTACLE, SEEN, TOLD, UNSEEN, ObjectTable
from adhoc.perception.room_knowledge import RoomKnowledge
from adhoc.perception.scene_graph import SceneGraph
from adhoc.perception.semantic_map import SemanticMap
from adhoc.perception.settings import PerceptionSettings
from adhoc.perception.sighting import Sighting
from adhoc.perception.tracking import MOVED, NEW
from adhoc.perception.voxels import FURNITURE, ITEM, ROBOT

__all__ = ["Perception", "PerceptionSettings", "Sighting"]

_ROBOT_DEPTH = 0.1
_TOLD_HALF = 0.03


class Perception:
    """The semantic map, the scene graph and the objects of one robot, updated by each observation.

    The paper's pipeline: depth and instances give semantic points in the world frame; the points are
    voxelized and flattened to a top-down map; objects get a place, a room and a receptacle from
    geometry; rooms get a type from the categories of what is in them; all of it is arranged in a scene
    graph. Nothing enters but what pixels show (`observe`) and what teammates say (`tell_*`).

    Attributes:
        map: The top-down map.
    """

    def __init__(self, settings: PerceptionSettings = PerceptionSettings()) -> None:  # noqa: B008
        self.settings = settings
        self.table = ObjectTable()
        self.map = SemanticMap(settings, self.table)
        self._records = ObjectRecords(self.table)
        self._live = self._records.live
        self._rooms = RoomKnowledge(self.map, self.table, self._live)
        self._reader = FrameReader(self.map, self.table)
        self._graph = SceneGraph()
        self._graph_rooms: Mapping[str, RoomRecord] = {}
        self._graph_stale: dict[str, None] = {}
        self._step = -1
        self._held: str | None = None
        self._robots: dict[str, tuple[tuple[float, float], int]] = {}

    @property
    def objects(self) -> Mapping[str, ObjectRecord]:
        """What is believed of each detected object, a live view; `misplaced` is left to the agent."""
        return self._records

    @property
    def rooms(self) -> Mapping[str, RoomRecord]:
        """The known rooms. Whether they are explored may lag behind by `ROOMS_REFRESHED` observations.

        A room of which only told objects are known has their middle as its position; a room that is no
        more than a name is left out. A room is explored when no frontier of its own is left beyond which
        teammates have not inspected everything, and `explored_area` of its floor was seen; once explored,
        it stays so. The paper does not define it.
        """
        return MappingProxyType(self._rooms.records)

    @property
    def graph(self) -> SceneGraph:
        """The scene graph, brought up to date with the objects that changed since it was last asked for."""
        self._update_graph_rooms()
        if self._graph_stale:
            self._update_graph_objects()
        return self._graph

    def observe(self, observation: Observation) -> Sighting:
        """Take in one observation; returns what it showed and changed.

        The cost does not depend on the number of observations before.
        """
        self._step = observation.step
        self._rooms.count_observation()
        if not self.map.anchored:
            self.map.anchor(observation.pose.x, observation.pose.y)
        if observation.held is not None:
            self.forget(observation.held)
        self._held = observation.held
        found = self._reader.read(observation)
        slots = self._reader.frame.slots[:found]
        kinds = self.table.kinds[slots].tolist()
        visible, new, moved = self._apply(slots.tolist(), kinds)
        gone = self._drop_gone(observation)
        robots = self._robots_in(kinds, observation.camera.world_from_camera[:3, 3])
        self._remember_robots(robots)
        self._reader.finish(found)
        return Sighting(visible, new, moved, gone, robots)

    def room_probabilities(self, room_id: str) -> Mapping[str, float]:
        """Probability of each type in `houses.facts.ROOM_TYPES` for a room; uniform when nothing is known."""
        return self._rooms.probabilities(room_id)

    def tell_object(self, record: ObjectRecord) -> None:
        """Believe a teammate's record of an object, unless own knowledge is as new or newer."""
        slot = self.table.slot(Label(record.id, record.category))
        table = self.table
        if record.id == self._held or (
            table.known[slot] != UNSEEN and table.last_seen[slot] >= record.last_seen
        ):
            return
        if table.kinds[slot] not in (ITEM, FURNITURE):
            return
        if table.kinds[slot] == FURNITURE and table.known[slot] == SEEN:
            return
        self._free_cells(slot)
        table.erase(slot)
        table.known[slot] = TOLD
        table.last_seen[slot] = record.last_seen
        x, y, z = record.position
        near = _TOLD_HALF
        table.boxes[slot] = (x - near, y - near, z - near, x + near, y + near, z + near)
        if record.room is not None:
            table.rooms[slot] = table.number_of_room(record.room)
        self._records.tell(record, slot)
        self._touch(slot)

    def tell_explored(self, room_id: str, by: str) -> None:
        """Note that a teammate has explored a room; own exploration is not overwritten."""
        self._rooms.tell_explored(room_id, by)

    def tell_covered(self, cells: Iterable[tuple[int, int]]) -> None:
        """Note the square metres (floor(x), floor(y)) that a teammate has inspected: no frontiers there."""
        self.map.tell_covered(cells)

    def take_covered(self) -> tuple[tuple[int, int], ...]:
        """The square metres that this robot has inspected since the last call."""
        return self.map.take_covered()

    def forget(self, object_id: str) -> None:
        """Drop what is believed of an object: it was taken, or is not there. Unknown ids are ignored."""
        slot = self._live.get(object_id)
        if slot is None:
            return
        self._records.drop(object_id)
        self._free_cells(slot)
        self._touch(slot)
        self.table.erase(slot)

    def _apply(
        self, slots: list[int], kinds: list[int]
    ) -> tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
        """Enter what was merged from a frame, given the slot and the kind of each of its instances."""
        frame, table = self._reader.frame, self.table
        codes, room_changed = frame.codes[: len(slots)].tolist(), frame.room_changed[: len(slots)].tolist()
        things = [local for local, kind in enumerate(kinds) if kind in (ITEM, FURNITURE)]
        for local in things:
            if codes[local] == MOVED:
                self._reader.free_box(slots[local], frame.old_boxes[local])
        self._decide([slots[local] for local in things if kinds[local] == ITEM])
        if any(codes[local] and kinds[local] == FURNITURE for local in things):
            self._decide(self._undecided())
        visible, new, moved = [], [], []
        for local in things:
            slot, code = slots[local], codes[local]
            name = table.ids[slot]
            visible.append(name)
            self._records.change(slot)
            if code == NEW:
                new.append(name)
                self._records.see(name, slot)
                self._touch(slot)
            elif code == MOVED and self._has_moved(local, slot):
                moved.append(name)
            if room_changed[local] or code == MOVED:
                self._touch(slot)
                self._rooms.take_evidence(int(frame.old_rooms[local]), self._step)
        return tuple(visible), tuple(new), tuple(moved)

    def _undecided(self) -> list[int]:
        """The items of which it is not known what they lie on."""
        count = len(self.table.ids)
        open_items = (self.table.holders[:count] == NO_RECEPTACLE) & (self.table.kinds[:count] == ITEM)
        is_open = open_items.tolist()
        return [slot for slot in self._live.values() if is_open[slot]]

    def _has_moved(self, local: int, slot: int) -> bool:
        frame, table = self._reader.frame, self.table
        old = frame.old_boxes[local]
        middle = (old[:3] + old[3:]) / 2
        far = math.dist(middle.tolist(), table.centre(slot)) >= self.settings.moved_distance
        old_holder, old_room = int(frame.old_holders[local]), int(frame.old_rooms[local])
        other_holder = (
            NO_RECEPTACLE not in (old_holder, table.holders[slot]) and old_holder != table.holders[slot]
        )
        other_room = 0 not in (old_room, table.rooms[slot]) and old_room != table.rooms[slot]
        return bool(far or other_holder or other_room)

    def _decide(self, items: list[int]) -> None:
        if not items:
            return
        table = self.table
        slots = np.array(items, np.int64)
        changed = np.zeros(len(items), np.uint8)
        decide_holders(
            slots,
            len(items),
            len(table.ids),
            table.kinds,
            table.known,
            table.boxes,
            table.can_hold,
            table.vote_slots,
            table.vote_counts,
            table.holders,
            self.map.floor,
            self.map.origin,
            self.settings.cell,
            self.settings.floor_tolerance,
            changed,
        )
        for index in np.flatnonzero(changed).tolist():
            self._touch(items[index])

    def _drop_gone(self, observation: Observation) -> tuple[str, ...]:
        names = tuple(self.table.ids[slot] for slot in self._reader.find_gone(observation))
        for name in names:
            self.forget(name)
        return names

    def _robots_in(self, kinds: list[int], camera: NDArray[np.float64]) -> Mapping[str, tuple[float, float]]:
        frame, robots = self._reader.frame, {}
        for local, kind in enumerate(kinds):
            if kind == ROBOT:
                x0, y0, _, x1, y1, _ = frame.boxes[local].tolist()
                x, y = (x0 + x1) / 2, (y0 + y1) / 2
                away = math.hypot(x - camera[0], y - camera[1]) or 1.0
                robots[self.table.ids[int(frame.slots[local])]] = (
                    x + _ROBOT_DEPTH * (x - float(camera[0])) / away,
                    y + _ROBOT_DEPTH * (y - float(camera[1])) / away,
                )
        return MappingProxyType(robots)

    def _remember_robots(self, seen: Mapping[str, tuple[float, float]]) -> None:
        """Robots in view, and those that were a moment ago, stand in the way."""
        self._robots.update((name, (place, self._step)) for name, place in seen.items())
        oldest = self._step - self.settings.robot_memory
        self._robots = {name: it for name, it in self._robots.items() if it[1] >= oldest}
        self.map.robots = {name: place for name, (place, _) in self._robots.items()}

    def _free_cells(self, slot: int) -> None:
        if self.table.known[slot] == SEEN and self.table.kinds[slot] == ITEM:
            self._reader.free_box(slot, self.table.boxes[slot])

    def _touch(self, slot: int) -> None:
        self._records.change(slot)
        self._graph_stale[self.table.ids[slot]] = None
        self._rooms.add_evidence(int(self.table.rooms[slot]))

    def _update_graph_rooms(self) -> None:
        rooms = self._rooms.records
        if rooms is self._graph_rooms:
            return
        for name, record in rooms.items():
            before = self._graph_rooms.get(name)
            if before is None or before.room_type != record.room_type:
                self._graph.set_room(name, record.room_type)
        self._graph_rooms = rooms

    def _update_graph_objects(self) -> None:
        for name in sorted(self._graph_stale, key=lambda name: name not in self._live or self._is_item(name)):
            if name in self._live:
                self._graph.place(self._records[name])
            else:
                self._graph.remove(name)
        self._graph_stale.clear()

    def _is_item(self, name: str) -> bool:
        return bool(self.table.kinds[self._live[name]] == ITEM)
