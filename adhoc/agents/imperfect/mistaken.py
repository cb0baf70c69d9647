"""A robot that is wrong about some objects, and does not know."""

from __future__ import annotations

import math
from dataclasses import replace
from enum import Enum

from adhoc.agents.communication import read_objects
from adhoc.agents.imperfect.imperfect_policy import ImperfectPolicy
from adhoc.agents.imperfect.mistaken_task import MistakenTask
from adhoc.agents.imperfect.retelling import told_with_objects
from adhoc.agents.policy import Ask, Policy
from adhoc.core.messages import Message
from adhoc.core.streams import stream
from adhoc.core.values import Capability, Label, ObjectRecord, Observation, Point
from adhoc.houses.facts import pickupable_categories
from adhoc.tasks.task import Task


class Mistake(Enum):
    """What a robot has wrong about an object. It is one thing, and stays so for the episode."""

    CATEGORY = "takes it for a thing of another category"
    POSITION = "reports it at another place"
    JUDGEMENT = "finds it misplaced where it is not, and the other way round"


class MistakenPolicy(ImperfectPolicy):
    """Is wrong about each object with probability `rate`; acts by its mistakes, and tells them in good faith.

    Which object it is wrong about, and how, is drawn from the robot's own stream for that object: it looks
    wrong at every glance, so looking twice does not help. Furniture is only reported at a wrong place.

    Args:
        policy: Decides.
        rate: Probability of being wrong about an object.
        shift: Metres between the place of an object and where it is reported, in a direction drawn for it.
    """

    def __init__(self, policy: Policy, rate: float, shift: float = 2.0) -> None:
        super().__init__(policy)
        self._rate, self._shift = rate, shift

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self._mistakes: dict[str, Mistake | None] = {}
        self._categories: dict[str, str] = {}
        self._shifts: dict[str, tuple[float, float]] = {}
        super().reset(me, capability, task, seed, ask)

    def sees(self, observation: Observation) -> Observation:
        """Objects of wrong categories."""
        labels = observation.labels
        wrong = {number: self._label(label) for number, label in labels.items()}
        return observation if wrong == labels else replace(observation, labels=wrong)

    def judges_by(self, task: Task) -> Task:
        """A task that is the other way round for some objects."""
        return MistakenTask(task, self._is_misjudged)

    def tells(self, report: Message) -> Message:
        """Objects at wrong places."""
        records = read_objects(report)
        moved = [replace(record, position=self._place(record)) for record in records]
        return report if moved == records else told_with_objects(report, moved)

    def mistake(self, object_id: str, category: str) -> Mistake | None:
        """What this robot has wrong about an object; None if nothing."""
        if object_id not in self._mistakes:
            self._mistakes[object_id] = self._draw(object_id, category)
        return self._mistakes[object_id]

    def _draw(self, object_id: str, category: str) -> Mistake | None:
        generator = stream(self.seed, "mistaken", self.me, object_id)
        if generator.random() >= self._rate:
            return None
        angle = generator.uniform(0.0, 2.0 * math.pi)
        self._shifts[object_id] = (self._shift * math.cos(angle), self._shift * math.sin(angle))
        others = [name for name in pickupable_categories() if name != category]
        if len(others) == len(pickupable_categories()):
            return Mistake.POSITION
        self._categories[object_id] = others[int(generator.integers(len(others)))]
        return list(Mistake)[int(generator.integers(len(Mistake)))]

    def _label(self, label: Label) -> Label:
        if self.mistake(label.id, label.category) is not Mistake.CATEGORY:
            return label
        return Label(label.id, self._categories[label.id])

    def _is_misjudged(self, record: ObjectRecord) -> bool:
        return self.mistake(record.id, record.category) is Mistake.JUDGEMENT

    def _place(self, record: ObjectRecord) -> Point:
        x, y, z = record.position
        if self.mistake(record.id, record.category) is not Mistake.POSITION:
            return (x, y, z)
        dx, dy = self._shifts[record.id]
        return (x + dx, y + dy, z)
