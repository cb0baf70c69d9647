"""Following the usual course of a sub-task by rule, as rule-based robots do."""

from __future__ import annotations

import re

from adhoc.agents.memory import Memory
from adhoc.core.calls import Call, CallSpec
from adhoc.core.values import ObjectRecord
from adhoc.tasks.task import Task

_NAME = re.compile(r"\{(\w+)\}")


class Recipe:
    """One sub-task on its way: which of its usual `steps` come next, with every name bound.

    Names in braces are the sub-task's own parameters; `{target}` and `{target_room}` are the nearest known
    receptacle where the sub-task's object belongs, and that receptacle's room. Where a step needs a
    target and none is known, the robot searches (`search_skill`). A robot that is `holding` the object
    already begins with the first step that needs a target.
    """

    def __init__(
        self, sub_task: Call, spec: CallSpec, task: Task, search_skill: str = "Explore", holding: bool = False
    ) -> None:
        self.sub_task = sub_task
        self._task = task
        self._search = Call(search_skill)
        self._steps = spec.steps
        self._bound = {
            parameter.name: str(argument) for parameter, argument in zip(spec.parameters, sub_task.args)
        }
        self._refused: set[str] = set()
        self._next = self._first_target_step() if holding else 0

    @property
    def finished(self) -> bool:
        """Whether every step is done."""
        return self._next >= len(self._steps)

    def next_skill(self, memory: Memory, position: tuple[float, float]) -> Call:
        """The next sub-skill: the first step not done, or a search for what it needs."""
        names = _NAME.findall(self._steps[self._next])
        if "target" in names and not self._bind_target(memory, position):
            return self._search
        name, *arguments = self._steps[self._next].format(**self._bound).split()
        return Call(name, tuple(arguments))

    def succeeded(self, call: Call) -> None:
        """Note that a sub-skill succeeded; searching for a target is not a step of the recipe."""
        if call != self._search or self._steps[self._next] == self._search.name:
            self._next += 1

    def refuse_target(self) -> bool:
        """The target did not work out: take another one from now on; False if no target was bound."""
        target = self._bound.pop("target", None)
        self._bound.pop("target_room", None)
        if target is None:
            return False
        self._refused.add(target)
        self._next = self._first_target_step()
        return True

    def _first_target_step(self) -> int:
        return next((index for index, step in enumerate(self._steps) if "{target}" in step), 0)

    def _bind_target(self, memory: Memory, position: tuple[float, float]) -> bool:
        if "target" in self._bound:
            return True
        record = memory.record(self._bound.get("object", ""))
        choice = None if record is None else self._choose(record, memory, position)
        if choice is None or choice.room is None:
            return False
        self._bound.update(target=choice.id, target_room=choice.room)
        return True

    def _choose(
        self, record: ObjectRecord, memory: Memory, position: tuple[float, float]
    ) -> ObjectRecord | None:
        for receptacle, room_type in memory.places_near(position):
            if receptacle.id in self._refused or receptacle.id == record.receptacle:
                continue
            if self._task.is_place_for(record, receptacle, room_type):
                return receptacle
        return None
