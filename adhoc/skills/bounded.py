"""What all skills share: a bound on their actions, and failures as sentences."""

from __future__ import annotations

import math
from abc import abstractmethod

from adhoc.core.calls import Call
from adhoc.core.values import Action, ActionResult, Failure
from adhoc.skills.skill import Skill, SkillView

TRAVEL_PITCH = math.radians(30)
"""Cameras look 30 degrees down on the way: with a view of 90 degrees that shows everything from 15 degrees
above the horizon, shelves and tables, down to the floor half a metre ahead."""

_HOPELESS = frozenset(
    {Failure.NO_NAVIGATION, Failure.NO_MANIPULATION, Failure.STOPPED, Failure.OUT_OF_BATTERY}
)


class BoundedSkill(Skill):
    """A skill that gives up after `most_actions`, and at once when the world says that it is hopeless.

    Subclasses implement `begin` and `next_action`, and end by `self.fail(...)` or `None`.
    """

    def __init__(self, most_actions: int) -> None:
        self.most_actions = most_actions
        self.failure = None
        self._call = Call("")
        self._taken = 0

    def start(self, call: Call, view: SkillView) -> None:
        """See `Skill`."""
        self.failure = None
        self._call = call
        self._taken = 0
        view.navigator.update(view.observation)
        self.begin(call, view)

    def step(self, view: SkillView) -> Action | None:
        """See `Skill`."""
        if self.failure is not None:
            return None
        view.navigator.update(view.observation)
        result = view.observation.last_result
        if self._taken and result is not None and result.failure in _HOPELESS:
            return self.fail(sentence_of(result))
        if self._taken >= self.most_actions:
            return self.fail(f"{self._call} was not finished within {self.most_actions} actions")
        action = self.next_action(view)
        if action is not None:
            self._taken += 1
        return action

    def fail(self, reason: str) -> Action | None:
        """Note why the skill failed; returns None, so that `return self.fail(...)` ends it."""
        self.failure = reason
        return None

    @abstractmethod
    def begin(self, call: Call, view: SkillView) -> None:
        """Read the arguments of `call`; may fail."""

    @abstractmethod
    def next_action(self, view: SkillView) -> Action | None:
        """The next action, None when finished."""


def sentence_of(result: ActionResult) -> str:
    """Why the world refused an action, as a sentence."""
    reason = result.failure.value if result.failure is not None else "the action succeeded"
    return f"{reason} ({result.detail})" if result.detail else reason


def level_camera(view: SkillView) -> Action | None:
    """A tilt toward `TRAVEL_PITCH` if the camera is not there."""
    return view.navigator.tilt_toward(view.observation, TRAVEL_PITCH, 0.0)
