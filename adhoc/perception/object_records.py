"""The objects that a robot believes in, as records that are built when they are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from adhoc.core.values import ObjectRecord
from adhoc.houses.house import FLOOR
from adhoc.perception.object_table import ON_FLOOR, TOLD, ObjectTable


class ObjectRecords(Mapping[str, ObjectRecord]):
    """A live view of an object table: ids of objects to what is believed of them.

    Attributes:
        live: The slot of each object that is believed to be somewhere, in the order of detection.
    """

    def __init__(self, table: ObjectTable) -> None:
        self.live: dict[str, int] = {}
        self._table = table
        self._built: dict[int, ObjectRecord] = {}
        self._told: dict[int, ObjectRecord] = {}

    def __getitem__(self, object_id: str) -> ObjectRecord:
        slot = self.live[object_id]
        record = self._built.get(slot)
        if record is None:
            record = self._built[slot] = self._build(slot)
        return record

    def __iter__(self) -> Iterator[str]:
        return iter(self.live)

    def __len__(self) -> int:
        return len(self.live)

    def see(self, object_id: str, slot: int) -> None:
        """Enter an object that own eyes see; a teammate's word of it counts no more."""
        self.live[object_id] = slot
        self._told.pop(slot, None)

    def tell(self, record: ObjectRecord, slot: int) -> None:
        """Enter an object by a teammate's word, which stays its record."""
        self.live[record.id] = slot
        self._told[slot] = record

    def drop(self, object_id: str) -> None:
        """Believe in an object no longer."""
        self._told.pop(self.live.pop(object_id), None)

    def change(self, slot: int) -> None:
        """Note that what is believed of a slot may have changed."""
        self._built.pop(slot, None)

    def _build(self, slot: int) -> ObjectRecord:
        table = self._table
        if table.known[slot] == TOLD:
            return self._told[slot]
        facts = table.facts(slot)
        holder = int(table.holders[slot])
        receptacle, receptacle_category = None, None
        if holder == ON_FLOOR:
            receptacle = receptacle_category = FLOOR
        elif holder >= 0:
            receptacle, receptacle_category = table.ids[holder], table.categories[holder]
        return ObjectRecord(
            table.ids[slot],
            table.categories[slot],
            table.centre(slot),
            table.room_id(int(table.rooms[slot])),
            receptacle,
            receptacle_category,
            None,
            facts.mass,
            facts.is_receptacle,
            facts.pickupable,
            int(table.last_seen[slot]),
        )
