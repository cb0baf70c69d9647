"""The three sub-skills of navigation: to an object, to a point, to a room."""

from __future__ import annotations

import math

from adhoc.core.calls import Call
from adhoc.core.values import Action
from adhoc.skills.approach import Approach, Approached
from adhoc.skills.bounded import BoundedSkill, level_camera
from adhoc.skills.navigator import Travel
from adhoc.skills.skill import SkillView


class GoToObject(BoundedSkill):
    """`GoToObject <object>`: navigate to the vicinity of a known object (paper, Description of Sub-Skills).

    Succeeds when the object is in view and within reach. Fails when it is not known, cannot be got to, or
    is not where it was believed to be.

    Args:
        reach: Horizontal metres to the nearest visible point. 1.45 leaves a margin to the 1.5 of AI2-THOR.
        attempts: Standing places that are tried.
        most_actions: Bound on the number of actions.
    """

    def __init__(self, reach: float = 1.45, attempts: int = 5, most_actions: int = 250) -> None:
        super().__init__(most_actions)
        self._reach = reach
        self._attempts = attempts
        self._approach = Approach("", reach, attempts)

    def begin(self, call: Call, view: SkillView) -> None:
        """See `BoundedSkill`."""
        object_id = str(call.args[0])
        self._approach = Approach(object_id, self._reach, self._attempts)
        self._approach.begin(view)
        if object_id not in view.objects:
            self.fail(f"{object_id} is not known")

    def next_action(self, view: SkillView) -> Action | None:
        """See `BoundedSkill`."""
        step = self._approach.next_action(view)
        if isinstance(step, Action):
            return step
        if step is Approached.GONE:
            return self.fail(f"the object {self._approach.object_id} is not there")
        if step is Approached.UNREACHABLE:
            return self.fail(f"there is no way to {self._approach.object_id}")
        return None


class GoToPoint(BoundedSkill):
    """`GoToPoint <dx> <dy>`: navigate to a point relative to the position at the call, in metres.

    dx and dy are measured along the x and y axes of the world frame, in which all positions that planners
    read are given; with `robot_frame`, dx is ahead of the robot and dy to its left, at the call.

    Args:
        most_distance: The farthest point allowed, metres ('within a certain distance constraint'; the
            paper gives no number).
        tolerance: Metres from the point at which the robot may stop: two steps, for points inside furniture.
        robot_frame: Whether dx and dy are relative to the robot's heading.
        most_actions: Bound on the number of actions.
    """

    def __init__(
        self,
        most_distance: float = 6.0,
        tolerance: float = 0.5,
        robot_frame: bool = False,
        most_actions: int = 150,
    ) -> None:
        super().__init__(most_actions)
        self._most_distance = most_distance
        self._tolerance = tolerance
        self._robot_frame = robot_frame

    def begin(self, call: Call, view: SkillView) -> None:
        """See `BoundedSkill`."""
        dx, dy = float(call.args[0]), float(call.args[1])
        distance = math.hypot(dx, dy)
        if not distance <= self._most_distance:
            self.fail(f"the point is {distance:.1f} m away, more than {self._most_distance:g} m")
            return
        pose = view.observation.pose
        if self._robot_frame:
            cos_yaw, sin_yaw = math.cos(pose.yaw), math.sin(pose.yaw)
            dx, dy = dx * cos_yaw - dy * sin_yaw, dx * sin_yaw + dy * cos_yaw
        if not view.navigator.aim_at_point(pose.x + dx, pose.y + dy, self._tolerance):
            self.fail(f"no robot can stand at ({pose.x + dx:.2f}, {pose.y + dy:.2f})")

    def next_action(self, view: SkillView) -> Action | None:
        """See `BoundedSkill`."""
        return travel_on(self, view, "the point")


class GoToRoom(BoundedSkill):
    """`GoToRoom <room>`: navigate into a known room. Succeeds when the robot stands in it.

    Args:
        most_actions: Bound on the number of actions.
    """

    def __init__(self, most_actions: int = 250) -> None:
        super().__init__(most_actions)
        self._room = ""

    def begin(self, call: Call, view: SkillView) -> None:
        """See `BoundedSkill`."""
        self._room = str(call.args[0])
        if self._room not in view.rooms:
            self.fail(f"{self._room} is not known")
        elif not self._is_inside(view) and not view.navigator.aim_at_room(self._room):
            x, y = view.rooms[self._room].position
            if not view.navigator.aim_at_point(x, y, 1.0):
                self.fail(f"there is no known way to {self._room}")

    def next_action(self, view: SkillView) -> Action | None:
        """See `BoundedSkill`."""
        if self._taken == 0 and self._is_inside(view):
            return None
        return travel_on(self, view, self._room)

    def _is_inside(self, view: SkillView) -> bool:
        pose = view.observation.pose
        return view.map.room_at(pose.x, pose.y) == self._room


def travel_on(skill: BoundedSkill, view: SkillView, where: str) -> Action | None:
    """The next action toward the navigator's goal; None on arrival, or with a failure."""
    step = view.navigator.travel(view.observation)
    if isinstance(step, Action):
        return level_camera(view) or step
    if step is Travel.UNREACHABLE:
        return skill.fail(f"there is no way to {where}")
    return None
