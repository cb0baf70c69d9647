"""A robot that finishes one room before it begins the next."""

from __future__ import annotations

from adhoc.agents.body import SkillOutcome
from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.policy import Ask
from adhoc.core.calls import Call
from adhoc.core.values import Capability, ObjectRecord, RoomRecord
from adhoc.tasks.task import Task


class RoomByRoomPolicy(HeuristicPolicy):
    """Explores one room to its end, then re-places what is misplaced in explored rooms, then takes the next
    room: the nearest known one that nobody explores already.

    While no unexplored room is known, it explores wherever a frontier is left; when none is, objects in
    rooms that were never finished are dealt with too. Who takes an object is decided as in a heuristic team.

    Args:
        member: Whether the robot belongs to the original team (see `HeuristicPolicy`).
        search_skill: The sub-skill that explores.
        room_skill: The sub-skill that goes to a room.
        attempts: How often an object is tried; then it is left to others.
        retry_after: Steps before an object is tried again.
    """

    def __init__(
        self,
        member: bool = True,
        search_skill: str = "Explore",
        room_skill: str = "GoToRoom",
        attempts: int = 3,
        retry_after: int = 30,
    ) -> None:
        super().__init__(member=member, search_skill=search_skill, attempts=attempts, retry_after=retry_after)
        self._room_skill = room_skill

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        super().reset(me, capability, task, seed, ask)
        self._sweeping: str | None = None
        self._arrived: str | None = None
        self._swept: set[str] = set()

    def _next_skill(self) -> Call:
        if self._recipe is not None:
            return super()._next_skill()
        self._choose_room()
        if self._sweeping not in (None, self._arrived, self._room()):
            return Call(self._room_skill, (str(self._sweeping),))
        return self._search

    def _choose_room(self) -> None:
        """Keep to the room that is being explored; when it is done, take the next."""
        rooms = self._memory.perception.rooms
        current = rooms.get(self._sweeping or "")
        if current is None or self._is_done(current):
            near = self._memory.rooms_near(self._position)
            elsewhere = self._rooms_of_others()
            left = (it.id for it in near if not self._is_done(it) and it.id not in elsewhere)
            self._sweeping = next(left, None)

    def _is_done(self, room: RoomRecord) -> bool:
        return room.explored or room.id in self._swept

    def _rooms_of_others(self) -> set[str]:
        """Rooms that teammates say they are exploring."""
        views = [view for view in self._memory.teammates.values() if not view.stopped]
        sub_tasks = [view.sub_task for view in views if view.sub_task is not None and view.sub_task.args]
        return {str(it.args[0]) for it in sub_tasks if it == self._task.search(str(it.args[0]))}

    def _finish(self, outcome: SkillOutcome) -> None:
        sweeping = self._sweeping
        if self._recipe is not None or sweeping is None:
            super()._finish(outcome)
        elif outcome.failure is not None:
            self._swept.add(sweeping)
        elif outcome.call.name == self._room_skill:
            self._arrived = sweeping

    def _open_objects(self) -> list[ObjectRecord]:
        if self._idle:
            return super()._open_objects()
        rooms = self._memory.perception.rooms
        return [
            record
            for record in super()._open_objects()
            if (room := rooms.get(record.room or "")) is not None and self._is_done(room)
        ]

    def _focus_room(self) -> str | None:
        return None if self._recipe is not None else self._sweeping

    def _current_sub_task(self) -> Call | None:
        if self._recipe is None and self._sweeping is not None and not self._stopped:
            return self._task.search(self._sweeping)
        return super()._current_sub_task()
