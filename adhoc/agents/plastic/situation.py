"""The situation in which a teammate does something, as far as the newcomer knows it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.memory import Memory
from adhoc.agents.plastic.deeds import Doing, attended, doing, searched
from adhoc.core.geometry import planar_distance
from adhoc.core.messages import TeammateView
from adhoc.core.values import ObjectRecord
from adhoc.tasks.task import Task

FEATURES = (
    "able",
    "unable",
    "knew_nothing",
    "was_searching",
    "was_attending",
    "was_idling",
    "was_stopped",
    "held_something",
    "open_objects",
    "any_open",
    "any_carryable",
    "nearest_open",
    "known_for",
    "closest_to_it",
    "open_in_its_room",
    "open_in_explored_room",
    "its_room_explored",
    "searched_room_explored",
    "share_explored",
    "others_attending",
    "company_in_search",
    "crowd",
    "at_it_for",
    "silence",
    "time",
)
"""Names of the numbers that describe a situation, all about 0 to 1; see `Situation.features`."""

_FAR = 4.0
_NEAR = 3.0
_MOST_STEPS = 500.0


@dataclass(frozen=True)
class Situation:
    """What the newcomer knew of one teammate and its surroundings when the teammate did something.

    Args:
        name: The teammate.
        before: Its view before.
        now: Its view now; from it come place and capability alone.
        others: The views of the other teammates.
        place: Where it is, None if that is unknown.
        memory: What the newcomer knows.
        task: Says what search is and what is work on objects.
        step: The step.
        began: The step in which it began what it was at.
        known_since: When the newcomer first knew each object in need, by id.
    """

    name: str
    before: TeammateView | None
    now: TeammateView
    others: Sequence[TeammateView]
    place: tuple[float, float] | None
    memory: Memory
    task: Task
    step: int
    began: int
    known_since: Mapping[str, int]

    @property
    def open_objects(self) -> list[ObjectRecord]:
        """The objects in need that no other teammate deals with."""
        handled = {attended(view, self.task) for view in self.others if not view.stopped}
        return [record for record in self.memory.attention() if record.id not in handled]

    def carries(self, record: ObjectRecord) -> bool:
        """Whether the teammate could carry the object, as far as is known."""
        return can_carry(self.now, record)

    def distance(self, record: ObjectRecord) -> float:
        """Metres from the teammate to an object; inf where its place is unknown."""
        return math.inf if self.place is None else planar_distance(self.place, record.position)

    def nearest(self) -> ObjectRecord | None:
        """The open object nearest to the teammate among those that it could carry."""
        possible = [record for record in self.open_objects if self.carries(record)]
        return min(possible, key=lambda it: (self.distance(it), it.id), default=None)

    def closer_teammate(self, record: ObjectRecord) -> bool:
        """Whether another able teammate that deals with nothing is known to be closer to the object."""
        mine = self.distance(record)
        return any(
            view.position is not None
            and not view.stopped
            and attended(view, self.task) is None
            and can_carry(view, record)
            and planar_distance(view.position, record.position) < mine
            for view in self.others
        )

    def company_in(self, room: str) -> bool:
        """Whether another teammate says that it searches the room."""
        return any(searched(it.sub_task, self.task) == room for it in self.others if not it.stopped)

    def features(self) -> NDArray[np.float64]:
        """The numbers of `FEATURES`, shape (len(FEATURES),)."""
        rooms = self.memory.perception.rooms
        explored = {room.id for room in rooms.values() if room.explored}
        capability = self.now.capability
        was = doing(self.before, self.task)
        open_objects = self.open_objects
        nearest = self.nearest()
        its_room = self._room()
        search = None if self.before is None else searched(self.before.sub_task, self.task)
        heard = -1 if self.before is None else self.before.last_heard
        known = self.step if nearest is None else self.known_since.get(nearest.id, self.step)
        numbers: Mapping[str, float] = {
            "able": capability is not None and capability.can_manipulate,
            "unable": capability is not None and not capability.can_manipulate,
            "knew_nothing": was is Doing.UNKNOWN,
            "was_searching": was is Doing.SEARCHING,
            "was_attending": was is Doing.ATTENDING,
            "was_idling": was is Doing.IDLING,
            "was_stopped": was is Doing.STOPPED,
            "held_something": self.before is not None and self.before.holding is not None,
            "open_objects": min(len(open_objects), 3) / 3,
            "any_open": bool(open_objects),
            "any_carryable": nearest is not None,
            "nearest_open": 0.0 if nearest is None else math.exp(-self.distance(nearest) / _FAR),
            "known_for": 0.0 if nearest is None else self._age(known),
            "closest_to_it": nearest is not None and not self.closer_teammate(nearest),
            "open_in_its_room": its_room is not None and any(it.room == its_room for it in open_objects),
            "open_in_explored_room": nearest is not None and nearest.room in explored,
            "its_room_explored": its_room in explored,
            "searched_room_explored": search in explored,
            "share_explored": len(explored) / max(1, len(rooms)),
            "others_attending": min(2, sum(self._is(view, Doing.ATTENDING) for view in self.others)) / 2,
            "company_in_search": search is not None and self.company_in(search),
            "crowd": min(2, sum(map(self._is_near, self.others))) / 2,
            "at_it_for": self._age(self.began),
            "silence": self._age(max(heard, 0)),
            "time": min(self.step, _MOST_STEPS) / _MOST_STEPS,
        }
        return np.array([float(numbers[name]) for name in FEATURES])

    def _age(self, since: int) -> float:
        """Steps since then, 0 to 1 on a logarithmic scale."""
        return math.log1p(min(max(0, self.step - since), _MOST_STEPS)) / math.log1p(_MOST_STEPS)

    def _room(self) -> str | None:
        if self.now.room is not None or self.place is None:
            return self.now.room
        return self.memory.perception.map.room_at(*self.place)

    def _is_near(self, view: TeammateView) -> bool:
        if view.position is None or self.place is None:
            return False
        return planar_distance(view.position, self.place) < _NEAR

    def _is(self, view: TeammateView, what: Doing) -> bool:
        return doing(view, self.task) is what


def can_carry(view: TeammateView, record: ObjectRecord) -> bool:
    """Whether a teammate could carry an object; one that has not said what it can is thought able."""
    capability = view.capability
    return capability is None or (capability.can_manipulate and record.mass <= capability.payload)
