"""A member's situation, from its memory and from what its team told it."""

from __future__ import annotations

from adhoc.agents.learned.situation import Detection, Other, OwnState, Situation
from adhoc.agents.memory import Memory
from adhoc.agents.roster import MemberState, Roster
from adhoc.core.values import Capability, ObjectRecord, Observation


class Awareness:
    """Sums up what one member of a learned team knows.

    Args:
        memory: What it knows.
        roster: What the other members said of themselves.
        capability: What it can do.
    """

    def __init__(self, memory: Memory, roster: Roster, capability: Capability) -> None:
        self._memory, self._roster, self._capability = memory, roster, capability

    def situation(
        self, now: Observation, place_known: bool, idle: bool, given_up: frozenset[str]
    ) -> Situation:
        """The situation at an observation that the memory has taken in; see `OwnState` for the flags."""
        perception = self._memory.perception
        room = perception.map.room_at(now.pose.x, now.pose.y)
        rooms = perception.rooms.values()
        own = OwnState(
            name=self._memory.me,
            capability=self._capability,
            pose=now.pose,
            step=now.step,
            steps_left=now.steps_left,
            holding=now.held is not None,
            place_known=place_known,
            idle=idle,
            frontiers=len(perception.map.frontiers()),
            rooms_known=len(rooms),
            rooms_explored=sum(it.explored for it in rooms),
            room_types={} if room is None else perception.room_probabilities(room),
        )
        handled = self.handled()
        detections = tuple(
            self._detection(record, record.id in handled, record.id in given_up)
            for record in self._memory.attention()
        )
        return Situation(own, detections, tuple(map(_other, self._roster.members.values())))

    def handled(self) -> frozenset[str]:
        """Ids of the objects in need that other robots are after: members, or able strangers."""
        strangers = (it.id for it in self._memory.attention() if self._claimed_by_stranger(it.id))
        return frozenset((*self._roster.handled(), *strangers))

    def open_objects(self) -> list[ObjectRecord]:
        """The objects in need that nobody is after."""
        handled = self.handled()
        return [record for record in self._memory.attention() if record.id not in handled]

    def _detection(self, record: ObjectRecord, handled: bool, given_up: bool) -> Detection:
        room_types = {} if record.room is None else self._memory.perception.room_probabilities(record.room)
        return Detection(
            id=record.id,
            position=record.position[:2],
            mass=record.mass,
            last_seen=record.last_seen,
            handled=handled,
            given_up=given_up,
            certainty=max(room_types.values(), default=0.0),
        )

    def _claimed_by_stranger(self, object_id: str) -> bool:
        claimant = self._memory.claimed(object_id)
        if claimant is None or claimant in self._roster.members:
            return False
        capability = self._memory.teammates[claimant].capability
        return capability is None or capability.can_manipulate


def _other(state: MemberState) -> Other:
    return Other(
        name=state.name,
        position=state.position,
        capability=state.capability,
        busy=state.busy is not None,
        idle=state.idle,
        stopped=state.stopped,
        unable=frozenset(state.unable),
    )
