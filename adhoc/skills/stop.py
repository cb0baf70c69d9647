"""The sub-skill that ends a robot's part."""

from __future__ import annotations

from adhoc.core.calls import Call
from adhoc.core.values import Action, ActionName
from adhoc.skills.bounded import BoundedSkill
from adhoc.skills.skill import SkillView


class Stop(BoundedSkill):
    """`Stop`: stop at the current location for good. One action."""

    def __init__(self) -> None:
        super().__init__(most_actions=2)

    def begin(self, call: Call, view: SkillView) -> None:
        """See `BoundedSkill`."""

    def next_action(self, view: SkillView) -> Action | None:
        """See `BoundedSkill`."""
        return Action(ActionName.STOP) if self._taken == 0 else None
