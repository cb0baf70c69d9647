"""A skill that notices what it should never have been asked."""

from __future__ import annotations

from adhoc.core.calls import Call
from adhoc.core.values import Action, Capability
from adhoc.houses.house import FLOOR
from adhoc.skills.skill import Skill, SkillView
from adhoc.tasks.task import Task


class WatchedSkill(Skill):
    """Another skill that refuses to begin, by an AssertionError, with what the task forbids this robot or
    with what is not in its view.

    Args:
        inner: The skill.
        task: Says what is legal.
        capability: Of the robot.
        begun: Every call that is begun is added here.
    """

    def __init__(self, inner: Skill, task: Task, capability: Capability, begun: list[Call]) -> None:
        self._inner, self._task, self._capability, self._begun = inner, task, capability, begun

    def start(self, call: Call, view: SkillView) -> None:
        """See `Skill`."""
        refusal = self._task.legal_skill(call, self._capability)
        assert refusal is None, f"{call}: {refusal}"
        names = {*view.objects, *view.rooms, FLOOR, view.observation.held}
        unknown = [it for it in call.args if not isinstance(it, float) and it not in names]
        assert not unknown, f"{call}: {unknown} is not in view"
        self._begun.append(call)
        self._inner.start(call, view)
        self.failure = self._inner.failure

    def step(self, view: SkillView) -> Action | None:
        """See `Skill`."""
        action = self._inner.step(view)
        self.failure = self._inner.failure
        return action
