"""Robots in a scene: their state and their bodies."""

from __future__ import annotations

from dataclasses import dataclass

from adhoc.core.values import ActionResult, Capability, Pose
from adhoc.houses.solids import Box
from adhoc.worlds.colours import colour_of
from adhoc.worlds.rigid_shape import Placement
from adhoc.worlds.scene import ROBOT, Scene

_INSCRIBED = 0.7
"""A square of this half side, times the radius, lies inside the circle (a bit less than 1 / sqrt 2)."""

_HEAD = 0.1


@dataclass
class Robot:
    """One robot and its present state."""

    id: str
    capability: Capability
    pose: Pose
    instance: int
    body: int
    held: str | None = None
    steps_used: int = 0
    stopped: bool = False
    last_result: ActionResult | None = None

    @property
    def steps_left(self) -> int:
        return max(0, self.capability.max_steps - self.steps_used)


@dataclass(frozen=True)
class RobotBody:
    """The size of robots. All collide alike, so that a pose that is free for one is free for all.

    The body collides as an upright cylinder of `radius` and `height`, and is seen as a box inside the
    cylinder that ends 0.1 m above the robot's camera.
    """

    radius: float
    height: float

    def add_probe(self, scene: Scene) -> int:
        """An invisible cylinder of a robot's size, out of the scene, to test poses with."""
        body = scene.bullet.add_cylinder(self.radius, self.height, (0.0, 0.0, 0.0), None, (0.0, 0.0, 0.0))
        scene.bullet.put_aside(body)
        return body

    def add(self, scene: Scene, robot_id: str, capability: Capability, pose: Pose) -> Robot:
        """Put a robot into the scene, without asking whether there is room."""
        box = self._seen(capability, Pose(0.0, 0.0))
        local = Box((0.0, 0.0, box.center[2] - self.height / 2), box.half)
        placement = self.placement(pose)
        body = scene.bullet.add_cylinder(self.radius, self.height, placement.center, local, colour_of(ROBOT))
        scene.bullet.place(body, placement)
        instance = scene.add_robot(robot_id, (body,), [self._seen(capability, pose)])
        return Robot(robot_id, capability, pose, instance, body)

    def move(self, scene: Scene, robot: Robot, pose: Pose) -> None:
        """Set a robot to another pose, without asking whether there is room."""
        robot.pose = pose
        scene.bullet.place(robot.body, self.placement(pose))
        scene.move_robot(robot.instance, [self._seen(robot.capability, pose)])

    def put_aside(self, scene: Scene, robot: Robot) -> None:
        """Take a robot's body out of the scene; `move` brings it back."""
        scene.bullet.put_aside(robot.body)
        scene.hide_robot(robot.instance)

    def placement(self, pose: Pose) -> Placement:
        """Where the cylinder of a robot at `pose` is."""
        return Placement((pose.x, pose.y, self.height / 2), pose.yaw)

    def _seen(self, capability: Capability, pose: Pose) -> Box:
        half_height = (capability.camera_height + _HEAD) / 2
        side = _INSCRIBED * self.radius
        return Box((pose.x, pose.y, half_height), (side, side, half_height), pose.yaw)
