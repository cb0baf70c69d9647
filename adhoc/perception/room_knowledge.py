"""What a robot believes of rooms: their type, a point in each, and whether they are explored."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from adhoc.core.values import RoomRecord
from adhoc.perception.object_table import ObjectTable
from adhoc.perception.room_types import infer_room_type
from adhoc.perception.semantic_map import SemanticMap

ROOMS_REFRESHED = 4
"""Whether rooms are explored is looked at anew at most every so many observations."""


class RoomKnowledge:
    """The rooms of a map, described by what is on it and by what is in them.

    Args:
        grid: the map.
        table: the objects.
        live: the slot of each object that is believed to be somewhere; changed by its owner.
    """

    def __init__(self, grid: SemanticMap, table: ObjectTable, live: Mapping[str, int]) -> None:
        self._map = grid
        self._table = table
        self._live = live
        self._settings = grid.settings
        self._records: dict[str, RoomRecord] = {}
        self._age = ROOMS_REFRESHED
        self._explored: dict[str, str] = {}
        self._evidence: dict[str, tuple[int, Mapping[str, float]]] = {}
        self._evidence_age: dict[int, int] = {}

    @property
    def records(self) -> dict[str, RoomRecord]:
        """The known rooms (see `Perception.rooms`): the same dict until they are described anew."""
        if self._age >= ROOMS_REFRESHED:
            self._age = 0
            self._records = self._describe()
        return self._records

    def probabilities(self, room_id: str) -> Mapping[str, float]:
        """Probability of each type in `houses.facts.ROOM_TYPES` for a room; uniform when nothing is known."""
        number = self._table.room_numbers.get(room_id, 0)
        age = self._evidence_age.get(number, 0)
        cached = self._evidence.get(room_id)
        if cached is None or cached[0] != age:
            members = [self._table.categories[slot] for slot in self._slots_in(number)] if number else []
            probabilities = infer_room_type(members, self._settings.item_evidence)
            cached = self._evidence[room_id] = (age, MappingProxyType(dict(probabilities)))
        return cached[1]

    def count_observation(self) -> None:
        """Note that one more observation was taken in."""
        self._age += 1

    def tell_explored(self, room_id: str, by: str) -> None:
        """Note that a teammate has explored a room; own exploration is not overwritten."""
        self._table.number_of_room(room_id)
        self._explored.setdefault(room_id, by)
        self._age = ROOMS_REFRESHED

    def add_evidence(self, number: int) -> None:
        """Note that what is believed to be in a room, by its number, may have changed."""
        self._evidence_age[number] = self._evidence_age.get(number, 0) + 1

    def take_evidence(self, number: int, step: int) -> None:
        """Note that something was seen at `step` to have left a room, by its number."""
        self._evidence_age[number] = step

    def _slots_in(self, number: int) -> list[int]:
        rooms = self._table.rooms[: len(self._table.ids)].tolist()
        return [slot for slot in self._live.values() if rooms[slot] == number]

    def _describe(self) -> dict[str, RoomRecord]:
        open_rooms = {frontier.room for frontier in self._map.frontiers()}
        records = {}
        for name in self._table.room_ids[1:]:
            area = self._map.known_area(name)
            seen_all = area >= self._settings.explored_area and name not in open_rooms
            if seen_all and self._explored.get(name) is None:
                self._explored[name] = "me"
            record = self._describe_room(name)
            if record is not None:
                records[name] = record
        return records

    def _describe_room(self, name: str) -> RoomRecord | None:
        probabilities = self.probabilities(name)
        likeliest = max(probabilities, key=probabilities.__getitem__)
        certain = probabilities[likeliest] > self._settings.room_certainty
        by = self._explored.get(name)
        before = self._records.get(name)
        settled = (
            before is not None and by == before.explored_by and self._map.is_traversable(*before.position)
        )
        position = before.position if before is not None and settled and by else self._point_in(name)
        if position is None:
            return None
        return RoomRecord(name, likeliest if certain else None, position, by is not None, by)

    def _point_in(self, room: str) -> tuple[float, float] | None:
        """A free point of the room; where its floor was not seen, the middle of what was told to be in it."""
        point = self._map.free_point(room)
        if point is not None:
            return point
        places = [self._table.centre(slot) for slot in self._slots_in(self._table.room_numbers[room])]
        if not places:
            return None
        return sum(it[0] for it in places) / len(places), sum(it[1] for it in places) / len(places)
