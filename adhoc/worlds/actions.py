"""One action of one robot: may it be done at all, who does it, and what it costs."""

from __future__ import annotations

from adhoc.core.values import MANIPULATION, Action, ActionName, ActionResult, Failure
from adhoc.worlds.manipulation import Manipulation
from adhoc.worlds.motion import Motion
from adhoc.worlds.refusal import Refusal
from adhoc.worlds.robots import Robot


class Actions:
    """Carries out actions. Every action but Stop costs one step of the battery, refused or not.

    A robot that has stopped, or whose battery is empty, pays nothing more; with an empty battery it can
    still stop.
    """

    def __init__(self, motion: Motion, manipulation: Manipulation) -> None:
        self._motion = motion
        self._manipulation = manipulation

    def perform(self, robot: Robot, action: Action) -> ActionResult:
        """Carry out the action, or say why not; the result is also the robot's `last_result`."""
        refusal = self._perform(robot, action)
        robot.last_result = (
            ActionResult(action) if refusal is None else ActionResult(action, refusal.failure, refusal.detail)
        )
        return robot.last_result

    def _perform(self, robot: Robot, action: Action) -> Refusal | None:
        if robot.stopped:
            return Refusal(Failure.STOPPED, f"{robot.id} stopped for good")
        if action.name is ActionName.STOP:
            robot.stopped = True
            return None
        if robot.steps_left == 0:
            return Refusal(Failure.OUT_OF_BATTERY, f"all {robot.capability.max_steps} steps are used")
        robot.steps_used += 1
        if action.name in MANIPULATION:
            if not robot.capability.can_manipulate:
                return Refusal(Failure.NO_MANIPULATION, f"{action.name.value} needs a manipulator")
            return self._manipulate(robot, action)
        if not robot.capability.can_navigate:
            return Refusal(Failure.NO_NAVIGATION, f"{action.name.value} needs wheels")
        return self._motion.perform(robot, action.name)

    def _manipulate(self, robot: Robot, action: Action) -> Refusal | None:
        if action.name is ActionName.PICK_UP:
            return self._manipulation.pick_up(robot, action.target)
        if action.name is ActionName.PUT_DOWN:
            return self._manipulation.put_down(robot, action.target)
        return self._manipulation.drop(robot)
