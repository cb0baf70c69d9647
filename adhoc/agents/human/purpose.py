"""The sub-task of a robot whose person chooses sub-skills: told by the person, or guessed."""

from __future__ import annotations

from adhoc.agents.memory import Memory
from adhoc.core.calls import Call
from adhoc.core.values import Capability, Observation
from adhoc.tasks.task import Task


class Purpose:
    """What the robot is about, so that teammates who go by sub-tasks understand it.

    A sub-skill about an object that needs attention, or that is in the hand, is taken to serve the task's own
    sub-task for that object (`Task.attend`); one about a room, or about no thing at all, the search of that
    room or of the one around (`Task.search`). What the person tells by `task` stands until it is finished.

    Args:
        memory: What the robot knows.
        task: Names the sub-tasks.
        capability: What the robot can do: nothing is guessed that it may not do.
    """

    def __init__(self, memory: Memory, task: Task, capability: Capability) -> None:
        self._memory, self._task, self._capability = memory, task, capability
        self.sub_task: Call | None = None
        self.done: list[Call] = []
        """Sub-skills that succeeded since the sub-task began."""
        self._is_told = False

    def tell(self, sub_task: Call | None) -> None:
        """The person says what the robot is about; None: nothing."""
        self.sub_task, self.done, self._is_told = sub_task, [], sub_task is not None

    def begin(self, skill: Call, observation: Observation) -> None:
        """A sub-skill begins."""
        if self._is_told:
            return
        guess = self._guess(skill, observation)
        if guess is not None and not self._goes_on(guess):
            self.sub_task, self.done = guess, []

    def succeed(self, skill: Call) -> None:
        """A sub-skill succeeded, and the sub-task perhaps with it."""
        self.done.append(skill)
        rooms = self._memory.perception.rooms
        if self.sub_task is not None and self._task.finished(self.sub_task, self.done, rooms):
            self.tell(None)

    def focus_room(self) -> str | None:
        """The room that the sub-task told by the person names: exploring keeps to it."""
        names = self.sub_task.args if self.sub_task is not None and self._is_told else ()
        rooms = self._memory.perception.rooms
        return next((str(name) for name in names if name in rooms), None)

    def _goes_on(self, guess: Call) -> bool:
        """Whether it is about the same thing as the current one: another place is no other sub-task."""
        return self.sub_task is not None and (self.sub_task.name, self.sub_task.args[:1]) == (
            guess.name,
            guess.args[:1],
        )

    def _guess(self, skill: Call, observation: Observation) -> Call | None:
        guess = self._about_object(skill) or self._about_room(skill, observation)
        allowed = guess is not None and self._task.legal(guess, self._capability) is None
        return guess if allowed else None

    def _about_object(self, skill: Call) -> Call | None:
        held = self._memory.held
        for argument in skill.args:
            record = self._memory.record(str(argument))
            if record is not None and (record.misplaced or (held is not None and held.id == record.id)):
                return self._task.attend(record, self._memory.places_near(record.position))
        return None

    def _about_room(self, skill: Call, observation: Observation) -> Call | None:
        if self._memory.held is not None:
            return None
        pose = observation.pose
        rooms = [str(it) for it in skill.args if it in self._memory.perception.rooms]
        here = self._memory.perception.map.room_at(pose.x, pose.y) if not skill.args else None
        room = rooms[0] if rooms else here
        return None if room is None else self._task.search(room)
