"""What a robot believes of objects, as columns: one row (slot) for each thing that it has a name for."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adhoc.core.errors import AssetError
from adhoc.core.values import Label
from adhoc.houses.facts import CategoryFacts, category_facts, pickupable_categories, receptacle_probability
from adhoc.perception.voxels import FLOOR_KIND, FURNITURE, IGNORED, ITEM, ROBOT, STRUCTURE

NO_RECEPTACLE = -1
ON_FLOOR = -2
VOTES = 4
"""Contacts with at most so many different things are counted per item."""

UNSEEN, TOLD, SEEN = range(3)
"""Where a belief comes from: nowhere (forgotten or gone), a teammate, or own eyes."""

_STRUCTURE = frozenset({"Wall", "Door", "Window", "Doorway", "Doorframe", "Ceiling"})
_FIRST_CAPACITY = 128


class ObjectTable:
    """Columns over slots. A slot is given to an id for good; what is believed of it changes.

    Attributes:
        ids, categories: of each slot.
        kinds: (S,) uint8, see `voxels`.
        rooms: (S,) int16, room number of each slot (its own for a floor), 0 while unknown.
        boxes: (S, 6) float64, box around all points seen, metres (x0, y0, z0, x1, y1, z1).
        known: (S,) uint8, `UNSEEN`, `TOLD` or `SEEN`.
        last_seen: (S,) int64, step of the last detection or report.
        room_gaps: (S,) float64, how far the floor that named the room was from the object, metres.
        holders: (S,) int64, slot of the receptacle, `ON_FLOOR` or `NO_RECEPTACLE` (undecided).
        vote_slots, vote_counts: (S, `VOTES`) int64, what an item was seen to stand on, how many pixels.
        misses: (S,) int64, frames that looked through the place of an item since it was last seen.
        can_hold: (S,) uint8, whether things can lie on or in it (plates and bowls too).
        room_ids: id of each room number; number 0 stands for 'unknown'.
    """

    def __init__(self) -> None:
        self.ids: list[str] = []
        self.categories: list[str] = []
        self.slots: dict[str, int] = {}
        self.room_ids: list[str] = [""]
        self.room_numbers: dict[str, int] = {}
        self._allocate(_FIRST_CAPACITY)

    def slot(self, label: Label) -> int:
        """The slot of an instance, given at first sight. All walls share one slot, all doors one, ..."""
        name = label.category if label.category in _STRUCTURE else label.id
        known = self.slots.get(name)
        return self._add(name, label.category) if known is None else known

    def facts(self, slot: int) -> CategoryFacts:
        """What is generally known of the slot's category."""
        return facts_of(self.categories[slot])

    def room_id(self, number: int) -> str | None:
        """The id of a room number, None for 0."""
        return self.room_ids[number] if number > 0 else None

    def number_of_room(self, room_id: str) -> int:
        """The number of a room, given at first mention."""
        number = self.room_numbers.get(room_id)
        if number is None:
            number = len(self.room_ids)
            self.room_ids.append(room_id)
            self.room_numbers[room_id] = number
        return number

    def centre(self, slot: int) -> tuple[float, float, float]:
        """The middle of the box around what was seen of it, metres."""
        x0, y0, z0, x1, y1, z1 = self.boxes[slot].tolist()
        return (x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2

    def erase(self, slot: int) -> None:
        """Forget all that is believed of a slot but its name."""
        self.known[slot] = UNSEEN
        self.holders[slot] = NO_RECEPTACLE
        self.vote_counts[slot] = 0
        self.rooms[slot] = 0
        self.room_gaps[slot] = np.inf
        self.misses[slot] = 0

    def _add(self, name: str, category: str) -> int:
        slot = len(self.ids)
        if slot == len(self.kinds):
            self._grow()
        self.ids.append(name)
        self.categories.append(category)
        self.slots[name] = slot
        self.kinds[slot] = _kind(category)
        if self.kinds[slot] == FLOOR_KIND:
            self.rooms[slot] = self.number_of_room(name)
        self.can_hold[slot] = can_hold(category)
        return slot

    def _allocate(self, capacity: int) -> None:
        self.kinds: NDArray[np.uint8] = np.full(capacity, IGNORED, np.uint8)
        self.rooms: NDArray[np.int16] = np.zeros(capacity, np.int16)
        self.boxes: NDArray[np.float64] = np.zeros((capacity, 6))
        self.known: NDArray[np.uint8] = np.full(capacity, UNSEEN, np.uint8)
        self.last_seen: NDArray[np.int64] = np.full(capacity, -1, np.int64)
        self.room_gaps: NDArray[np.float64] = np.full(capacity, np.inf)
        self.holders: NDArray[np.int64] = np.full(capacity, NO_RECEPTACLE, np.int64)
        self.vote_slots: NDArray[np.int64] = np.zeros((capacity, VOTES), np.int64)
        self.vote_counts: NDArray[np.int64] = np.zeros((capacity, VOTES), np.int64)
        self.misses: NDArray[np.int64] = np.zeros(capacity, np.int64)
        self.can_hold: NDArray[np.uint8] = np.zeros(capacity, np.uint8)
        self.local: NDArray[np.int32] = np.full(capacity, -1, np.int32)

    def _grow(self) -> None:
        columns: Mapping[str, NDArray[Any]] = {
            name: value for name, value in vars(self).items() if isinstance(value, np.ndarray)
        }
        self._allocate(2 * len(self.kinds))
        for name, column in columns.items():
            getattr(self, name)[: len(column)] = column


@cache
def facts_of(category: str) -> CategoryFacts:
    """`category_facts`, and for a category outside the tables: neither portable nor a receptacle."""
    try:
        return category_facts(category)
    except AssetError:
        return CategoryFacts(category, pickupable=False, is_receptacle=False, mass=0.0)


@cache
def can_hold(category: str) -> bool:
    """Whether things may lie on or in objects of the category, which may be portable (a plate, a bowl)."""
    if facts_of(category).is_receptacle:
        return True
    try:
        return any(receptacle_probability(category, item) > 0 for item in pickupable_categories())
    except AssetError:
        return False


def _kind(category: str) -> int:
    if category == "Floor":
        return FLOOR_KIND
    if category in _STRUCTURE:
        return STRUCTURE
    if category == "Robot":
        return ROBOT
    return ITEM if facts_of(category).pickupable else FURNITURE
