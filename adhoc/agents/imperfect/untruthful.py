"""A robot that works like any other, and tells strangers what is not so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from adhoc.agents.communication import read_call, read_objects
from adhoc.agents.imperfect.imperfect_policy import ImperfectPolicy
from adhoc.agents.imperfect.retelling import told_with_objects, told_with_sub_task
from adhoc.agents.policy import Ask, Policy
from adhoc.core.calls import Call
from adhoc.core.messages import Message
from adhoc.core.streams import stream
from adhoc.core.values import Capability, ObjectRecord, Observation
from adhoc.houses.facts import pickupable_categories
from adhoc.houses.house import FLOOR
from adhoc.tasks.task import Task

FIRST_INVENTED = 900
"""Invented objects are numbered from here, in the form of true ids: `Mug_900`."""


class UntruthfulPolicy(ImperfectPolicy):
    """Lies in each of its public reports with probability `rate`; what its team says to itself stays true.

    A lie about detections denies that any object is misplaced, and reports one that does not exist. A lie
    about its state claims a sub-task that it does not do: to deal with an object that it has told of before,
    or to search a room. What it has told of is all that it can claim, so a robot that has told nothing yet
    may not find a lie. Reports in a format of the policy's own are left alone.

    Args:
        policy: Decides, by the truth.
        rate: Probability of a lie in a report.
        around: Metres from the robot within which invented objects are said to lie.
    """

    def __init__(self, policy: Policy, rate: float, around: float = 3.0) -> None:
        super().__init__(policy)
        self._rate, self._around = rate, around

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self._task = task
        self._step = self._reports = self._invented = 0
        self._here = (0.0, 0.0)
        self._in_need: dict[str, ObjectRecord] = {}
        self._rooms: dict[str, None] = {}
        super().reset(me, capability, task, seed, ask)

    def sees(self, observation: Observation) -> Observation:
        """The truth; it notes where it is."""
        self._step, self._reports = observation.step, 0
        self._here = (observation.pose.x, observation.pose.y)
        return observation

    def tells(self, report: Message) -> Message:
        """A lie, now and then."""
        self._reports += 1
        generator = stream(self.seed, "untruthful", self.me, self._step, self._reports)
        records = read_objects(report)
        self._note(report, records)
        if generator.random() >= self._rate:
            return report
        claim = self._claim(read_call(report.payload.get("sub_task")), generator)
        told = report if claim is None else told_with_sub_task(report, claim)
        if "objects" not in report.payload:
            return told
        denied = [replace(it, misplaced=False) if it.misplaced else it for it in records]
        return told_with_objects(told, [*denied, self._invention(generator)])

    def _note(self, report: Message, records: list[ObjectRecord]) -> None:
        """Remember what can be claimed later."""
        room = report.payload.get("room")
        for name in (room, *(record.room for record in records)):
            if isinstance(name, str):
                self._rooms[name] = None
        self._in_need.update((record.id, record) for record in records if record.misplaced)

    def _claim(self, truth: Call | None, generator: np.random.Generator) -> Call | None:
        """A sub-task that it does not do; None if it knows of none."""
        claims = [self._task.attend(record, ()) for record in self._in_need.values()]
        claims += [self._task.search(room) for room in self._rooms]
        false = [it for it in claims if it is not None and it != truth]
        return false[int(generator.integers(len(false)))] if false else None

    def _invention(self, generator: np.random.Generator) -> ObjectRecord:
        """An object that does not exist, somewhere near."""
        categories = pickupable_categories()
        category = categories[int(generator.integers(len(categories)))]
        x, y = (place + generator.uniform(-self._around, self._around) for place in self._here)
        number = FIRST_INVENTED + self._invented
        self._invented += 1
        return ObjectRecord(
            id=f"{category}_{number}",
            category=category,
            position=(x, y, 0.0),
            room=next(reversed(self._rooms), None),
            receptacle=FLOOR,
            receptacle_category=FLOOR,
            misplaced=True,
            is_pickupable=True,
        )
