"""A robot that a script plays, in an empty place where every action works unless a test says otherwise."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from adhoc.agents.human.policy import HumanPolicy
from adhoc.agents.policy import Turn
from adhoc.core.geometry import camera_at, intrinsics
from adhoc.core.messages import Message
from adhoc.core.values import (
    Action,
    ActionName,
    ActionResult,
    Capability,
    Failure,
    ObjectRecord,
    Observation,
    Pose,
)
from adhoc.tasks.tidying_up import TidyingUp

MATRIX = intrinsics(2, 2, 1.5)
MUG = ObjectRecord(
    "Mug_1",
    "Mug",
    (2.0, 0.0, 0.8),
    room="room_1",
    receptacle="Bed_1",
    receptacle_category="Bed",
    misplaced=True,
    is_pickupable=True,
)
SINK = ObjectRecord("Sink_1", "Sink", (4.0, 1.0, 0.8), room="room_2", is_receptacle=True)


def observation(step: int = 0, **changes: object) -> Observation:
    pose = Pose(0.0, 0.0)
    seen = Observation(
        step,
        np.full((2, 2), np.inf, np.float32),
        np.full((2, 2), -1, np.int32),
        {},
        camera_at(pose, 1.6, MATRIX),
        pose,
        None,
        500 - step,
        None,
    )
    return replace(seen, **changes)  # type: ignore[arg-type]


class Robot:
    """Plays a policy step by step."""

    def __init__(self, policy: HumanPolicy, capability: Capability | None = None) -> None:
        self.policy, self.step = policy, 0
        self.turns: list[Turn] = []
        self.result: ActionResult | None = None
        policy.reset("robot", capability or Capability(), TidyingUp(), 0, lambda message: ())

    def act(self, inbox: Sequence[Message] = (), **changes: object) -> Turn:
        turn = self.policy.act(observation(self.step, last_result=self.result, **changes), inbox)
        self.turns.append(turn)
        self.step += 1
        self.result = ActionResult(turn.action)
        return turn

    def bump(self) -> None:
        """The last action failed."""
        assert self.result is not None
        self.result = replace(self.result, failure=Failure.BLOCKED)

    def actions(self, steps: int) -> list[str]:
        return [str(self.act().action) for _ in range(steps)]

    def know(self, *records: ObjectRecord) -> None:
        """The robot was told of things."""
        for record in records:
            self.policy._memory._tell(record)


def scripted(path, *lines: str, **settings: object) -> HumanPolicy:
    script = path / "script.txt"
    script.write_text("\n".join(lines), encoding="utf-8")
    return HumanPolicy(script=str(script), **settings)  # type: ignore[arg-type]


WAIT = str(Action(ActionName.ROTATE_RIGHT))
QUARTER = math.pi / 2
