"""Which rooms have doors to each other and to the outside, after ProcTHOR's habits.

The members of every group are joined by doors between neighbouring rooms. A bathroom has one door, to a room
of its own group. Kitchen and living room often have a mere frame, or no wall, between them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from adhoc.houses.generation.floor_judging import OUTSIDE
from adhoc.houses.generation.room_outlines import Contact
from adhoc.houses.generation.room_specs import PRIVATE, RoomGroup, RoomShare

Pair = tuple[int, int]

OPEN_PLAN = frozenset({"Kitchen", "LivingRoom"})
"""The types of rooms between which the way may be open."""
OPEN_CHANCE = 0.75
FRAME_CHANCE = 0.5
"""Of the open ways, this part is a door frame without a door, the others lack the wall."""
ENTRANCES = frozenset({"Kitchen", "LivingRoom"})
"""The types of rooms that the exterior door leads into, if any of them has an exterior wall. Of the others,
bathrooms come last."""


@dataclass(frozen=True)
class Passages:
    """Pairs of rooms, as positions with the lower first: with a door, with a frame, without a wall; and the
    stretch of exterior wall that has the closed door of the house."""

    doors: tuple[Pair, ...]
    frames: tuple[Pair, ...]
    left_out: tuple[Pair, ...]
    exterior: Contact


def plan_passages(
    rooms: RoomGroup, contacts: Sequence[Contact], room_for_door: float, generator: np.random.Generator
) -> Passages | None:
    """The passages of a house; None if its rooms cannot be joined as their groups ask.

    `contacts` shorter than `room_for_door` metres have no place for a door.
    """
    wide = [contact for contact in contacts if contact.length >= room_for_door]
    joined = _Joining([leaf.room_type for leaf in rooms.leaves()], {contact.rooms for contact in wide})
    if not joined.join_group(rooms, 0, generator):
        return None
    outer = [contact for contact in wide if contact.rooms[0] == OUTSIDE]
    if not outer:
        return None
    doors: list[Pair] = []
    frames: list[Pair] = []
    left_out: list[Pair] = []
    for pair in joined.pairs:
        kind = doors
        if {joined.types[room] for room in pair} == OPEN_PLAN and generator.random() < OPEN_CHANCE:
            kind = frames if generator.random() < FRAME_CHANCE else left_out
        kind.append(pair)
    return Passages(tuple(doors), tuple(frames), tuple(left_out), _entrance(outer, joined.types, generator))


def choose_contact(contacts: Sequence[Contact], generator: np.random.Generator) -> Contact:
    """One of the stretches, with a chance in proportion to its length."""
    rest = generator.random() * sum(contact.length for contact in contacts)
    for contact in contacts:
        rest -= contact.length
        if rest < 0:
            return contact
    return contacts[-1]


def _entrance(outer: Sequence[Contact], types: Sequence[str], generator: np.random.Generator) -> Contact:
    """The stretch for the exterior door: a room first, each with the same chance, then one of its walls."""
    owners = sorted({contact.rooms[1] for contact in outer})
    public = [owner for owner in owners if types[owner] != PRIVATE]
    owners = [owner for owner in owners if types[owner] in ENTRANCES] or public or owners
    owner = owners[int(generator.integers(len(owners)))]
    return choose_contact([contact for contact in outer if contact.rooms[1] == owner], generator)


class _Joining:
    """The pairs of rooms that get a door, collected from the smallest groups upward."""

    def __init__(self, types: list[str], neighbours: set[Pair]) -> None:
        self.types = types
        self.pairs: list[Pair] = []
        self._neighbours = neighbours

    def join_group(self, group: RoomGroup, first: int, generator: np.random.Generator) -> bool:
        """Join the members of a group whose rooms begin at position `first`; False if that cannot be."""
        parts: list[list[int]] = []
        for member in group.members:
            count = 1 if isinstance(member, RoomShare) else len(list(member.leaves()))
            if isinstance(member, RoomGroup) and not self.join_group(member, first, generator):
                return False
            parts.append(list(range(first, first + count)))
            first += count
        private = [part for part in parts if len(part) == 1 and self._is_private(part[0])]
        public = [part for part in parts if part not in private]
        return self._join_public(public, generator) and self._join_private(private, public, generator)

    def _join_public(self, parts: list[list[int]], generator: np.random.Generator) -> bool:
        """As ProcTHOR does: take a part that has no door yet, and give it a door to every part beside it."""
        lonely = list(range(len(parts))) if len(parts) > 1 else []
        while lonely:
            one = lonely[int(generator.integers(len(lonely)))]
            found = [other for other in range(len(parts)) if other != one and self._ways(parts, one, other)]
            if not found:
                return False
            for other in found:
                ways = self._ways(parts, one, other)
                self._add(ways[int(generator.integers(len(ways)))])
            lonely = [part for part in lonely if part != one and part not in found]
        return self._reconcile(parts, generator)

    def _reconcile(self, parts: list[list[int]], generator: np.random.Generator) -> bool:
        """Join what is still apart, part by part: every part having a door does not make them one."""
        apart = _connected([set(part) for part in parts], self.pairs)
        while len(apart) > 1:
            ways = [
                way
                for one, other in combinations([sorted(part) for part in apart], 2)
                for way in self._ways([one, other], 0, 1)
            ]
            if not ways:
                return False
            self._add(ways[int(generator.integers(len(ways)))])
            apart = _connected(apart, self.pairs)
        return True

    def _join_private(
        self, private: list[list[int]], public: list[list[int]], generator: np.random.Generator
    ) -> bool:
        around = [room for part in public for room in part]
        for part in private:
            ways = self._ways([part, around], 0, 1, private=True)
            if not ways:
                return False
            self._add(ways[int(generator.integers(len(ways)))])
        return True

    def _ways(self, parts: list[list[int]], one: int, other: int, private: bool = False) -> list[Pair]:
        """The neighbouring rooms of two parts, sorted; bathrooms in `one` only if `private`."""
        pairs = ((min(a, b), max(a, b)) for a in parts[one] for b in parts[other] if self._may(a, b, private))
        return sorted(pair for pair in pairs if pair in self._neighbours)

    def _may(self, first: int, second: int, private: bool) -> bool:
        return self._is_private(first) == private and not self._is_private(second)

    def _is_private(self, room: int) -> bool:
        return self.types[room] == PRIVATE

    def _add(self, pair: Pair) -> None:
        if pair not in self.pairs:
            self.pairs.append(pair)


def _connected(parts: list[set[int]], pairs: Sequence[Pair]) -> list[set[int]]:
    """The parts, with those put together that a pair joins."""
    merged = [set(part) for part in parts]
    for one, other in pairs:
        touching = [part for part in merged if one in part or other in part]
        if len(touching) > 1:
            merged = [part for part in merged if part not in touching] + [set.union(*touching)]
    return merged
