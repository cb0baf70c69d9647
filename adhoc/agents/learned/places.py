"""Where a held object is put: the predicted kinds of places among the receptacles that are known."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from adhoc.agents.learned.situation import Spot
from adhoc.agents.memory import Memory
from adhoc.core.values import ObjectRecord, Place
from adhoc.houses.house import FLOOR
from adhoc.tasks.common_sense import CommonSense

Target = tuple[str, str]
"""A receptacle or `Floor`, and a room, by id."""


class KnownPlaces:
    """Finds targets for the held object.

    The predictor says which types of receptacle in which types of room are reasonable; the nearest known one
    is taken, since a place is as good as another to the referee and the way is not. The floor comes last.

    Args:
        memory: What the robot knows.
        common_sense: Predicts the places.
    """

    def __init__(self, memory: Memory, common_sense: CommonSense) -> None:
        self._memory, self._common_sense = memory, common_sense

    def nearest(self, record: ObjectRecord, position: Spot, refused: Iterable[str]) -> Target | None:
        """The nearest target for the object, but for `refused` ones (ids; for floors, of the rooms)."""
        avoided = {*refused, record.receptacle}
        return next(
            (target for target in self._targets(record, position) if refusal_of(target) not in avoided), None
        )

    def _targets(self, record: ObjectRecord, position: Spot) -> Iterator[Target]:
        reasonable = set(self._common_sense.places_for(record.category))
        for receptacle, room_type in self._memory.places_near(position):
            if receptacle.room is None or room_type is None:
                continue
            if Place(receptacle.category, room_type) in reasonable:
                yield receptacle.id, receptacle.room
        for room in self._memory.rooms_near(position):
            if room.room_type is not None and Place(FLOOR, room.room_type) in reasonable:
                yield FLOOR, room.id


def refusal_of(target: Target) -> str:
    """What is refused when a target did not work out: the receptacle, or the room of a floor."""
    receptacle, room = target
    return room if receptacle == FLOOR else receptacle
