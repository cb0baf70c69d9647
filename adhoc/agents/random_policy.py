"""The random policy of the paper: one action of the action space, drawn at each step."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from adhoc.agents.policy import Ask, Policy, Turn
from adhoc.core.messages import Message
from adhoc.core.streams import stream
from adhoc.core.values import MANIPULATION, Action, ActionName, Capability, Observation
from adhoc.tasks.task import Task

_NEEDS_TARGET = frozenset({ActionName.PICK_UP, ActionName.PUT_DOWN})


class RandomPolicy(Policy):
    """Draws every action uniformly from the robot's action space; targets from what it sees, if anything.

    Args:
        may_stop: Whether `Stop` is among the actions. Stopping is for good, so a robot that may draw it
            stops after about twelve steps; the paper's random robot acts to the end, hence False.
    """

    def __init__(self, may_stop: bool = False) -> None:
        self._may_stop = may_stop

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        """See `Policy`."""
        self._random: np.random.Generator = stream(seed, "agent", me)
        self._actions = [
            name
            for name in ActionName
            if (capability.can_manipulate or name not in MANIPULATION)
            and (self._may_stop or name is not ActionName.STOP)
        ]

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        """See `Policy`."""
        name = self._actions[int(self._random.integers(len(self._actions)))]
        if name not in _NEEDS_TARGET:
            return Turn(Action(name))
        visible = sorted(label.id for label in observation.labels.values())
        if not visible:
            return Turn(Action(ActionName.ROTATE_RIGHT))
        return Turn(Action(name, visible[int(self._random.integers(len(visible)))]))
