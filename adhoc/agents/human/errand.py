"""What a robot is at for its person: a sub-skill, or low-level actions one after the other."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from adhoc.agents.body import Body, SkillOutcome
from adhoc.agents.human.commands import WAIT
from adhoc.agents.memory import Memory
from adhoc.core.calls import Call
from adhoc.core.values import Action, Observation


class Errand:
    """One thing at a time; a new one takes the place of the one before.

    Args:
        memory: What the robot knows.
        body: Executes sub-skills.
    """

    def __init__(self, memory: Memory, body: Body) -> None:
        self._memory, self._body = memory, body
        self._actions: deque[Action] = deque()

    @property
    def is_busy(self) -> bool:
        """Whether there is something left to do."""
        return bool(self._actions) or self._body.call is not None

    @property
    def skill(self) -> Call | None:
        """The sub-skill in progress."""
        return self._body.call

    def __str__(self) -> str:
        if self._actions:
            return f"single actions, {len(self._actions)} more"
        return "" if self._body.call is None else str(self._body.call)

    def begin_skill(self, call: Call, now: Observation, focus_room: str | None) -> None:
        """Begin a sub-skill."""
        self._actions.clear()
        self._body.begin(call, now, focus_room, self._memory.teammates_at())

    def begin_actions(self, actions: Sequence[Action]) -> None:
        """Begin a row of actions."""
        self._body.interrupt()
        self._actions = deque(actions)

    def go_on(self) -> None:
        """With what there is, or wait a step."""
        if not self.is_busy:
            self._actions.append(WAIT)

    def drop_actions(self) -> bool:
        """The last action failed: whatever was to follow it is off. Whether anything was."""
        was_acting = bool(self._actions)
        self._actions.clear()
        return was_acting

    def next(self, now: Observation) -> Action | SkillOutcome:
        """The next action, or the end of the sub-skill. Needs `is_busy`."""
        return self._actions.popleft() if self._actions else self._body.act(now)

    def end(self) -> None:
        """Whatever it is, it is over."""
        self.begin_actions(())
