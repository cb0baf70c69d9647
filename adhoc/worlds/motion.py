"""Where a robot fits, and the eight actions that move or turn it or its camera."""

from __future__ import annotations

import math
from collections.abc import Collection

from adhoc.core.geometry import wrap_angle
from adhoc.core.values import ActionName, Failure, Pose
from adhoc.worlds.refusal import Refusal
from adhoc.worlds.robots import Robot, RobotBody
from adhoc.worlds.scene import Scene

_DIRECTION = {
    ActionName.MOVE_AHEAD: 0.0,
    ActionName.MOVE_LEFT: math.pi / 2,
    ActionName.MOVE_BACK: math.pi,
    ActionName.MOVE_RIGHT: -math.pi / 2,
}
_TURN = {ActionName.ROTATE_LEFT: 1, ActionName.ROTATE_RIGHT: -1}
_TILT = {ActionName.LOOK_DOWN: 1, ActionName.LOOK_UP: -1}
_SWEEP = (1 / 3, 2 / 3, 1.0)
_ALIGNED = 1e-6
_ROOMY = 1.5
"""The bounding box of a turned cylinder reaches at most sqrt 2 of its radius."""


class Motion:
    """Moves robots with AI2-THOR's habits: fixed steps, fixed turns, a camera that tilts in steps.

    A move is checked at two poses on the way and at its end, against everything but floors.

    Args:
        scene: the house.
        body: the size of robots.
        grid_size: metres of one move.
        rotation: radians of one turn.
        tilt: radians of one tilt of the camera.
        tilt_limits: the most that a camera looks up and down, as (lowest, highest) pitch in radians.
    """

    def __init__(
        self,
        scene: Scene,
        body: RobotBody,
        grid_size: float,
        rotation: float,
        tilt: float,
        tilt_limits: tuple[float, float],
    ) -> None:
        self._scene = scene
        self._body = body
        self._grid_size = grid_size
        self._rotation = rotation
        self._tilt = tilt
        self._tilt_limits = tilt_limits
        self._probe = body.add_probe(scene)

    def perform(self, robot: Robot, name: ActionName) -> Refusal | None:
        """Carry out one of the eight actions of motion, or say why not."""
        if name in _DIRECTION:
            target = moved(robot.pose, _DIRECTION[name], self._grid_size)
            refusal = self.obstacle(robot.pose, target, ignored=(robot.body,))
            if refusal is not None:
                return refusal
        elif name in _TURN:
            yaw = wrap_angle(robot.pose.yaw + _TURN[name] * self._rotation)
            yaw = wrap_angle(_snapped(yaw, self._rotation))
            target = Pose(robot.pose.x, robot.pose.y, yaw, robot.pose.pitch)
        else:
            pitch = _snapped(robot.pose.pitch + _TILT[name] * self._tilt, self._tilt)
            lowest, highest = self._tilt_limits
            if not lowest - _ALIGNED <= pitch <= highest + _ALIGNED:
                limit = lowest if pitch < lowest else highest
                return Refusal(
                    Failure.LOOK_LIMIT, f"the camera already looks {_angle(limit)}, as far as it can"
                )
            target = Pose(robot.pose.x, robot.pose.y, robot.pose.yaw, pitch)
        self._body.move(self._scene, robot, target)
        return None

    def obstacle(self, start: Pose, end: Pose, ignored: Collection[int] = ()) -> Refusal | None:
        """What keeps a robot from moving straight from `start` to `end`; None if the way is free."""
        near = self._bodies_near(start, end)
        for fraction in _SWEEP:
            x = start.x + fraction * (end.x - start.x)
            y = start.y + fraction * (end.y - start.y)
            refusal = self._misfit(Pose(x, y, end.yaw) if fraction < 1.0 else end, near, ignored)
            if refusal is not None:
                return refusal
        return None

    def misfit(self, pose: Pose, ignored: Collection[int] = ()) -> Refusal | None:
        """Why a robot cannot stand at `pose`; None if it can. `ignored` bodies are not in the way."""
        return self._misfit(pose, self._bodies_near(pose, pose), ignored)

    def _bodies_near(self, start: Pose, end: Pose) -> set[int]:
        """All bodies, but floors, that a robot could touch between two poses, and perhaps some more."""
        around = _ROOMY * self._body.radius
        low = (min(start.x, end.x) - around, min(start.y, end.y) - around, -around)
        high = (max(start.x, end.x) + around, max(start.y, end.y) + around, self._body.height + around)
        return self._scene.bullet.bodies_near(low, high) - self._scene.floor_bodies

    def _misfit(self, pose: Pose, near: set[int], ignored: Collection[int]) -> Refusal | None:
        if self._scene.room_at((pose.x, pose.y)) is None:
            return Refusal(Failure.BLOCKED, f"({pose.x:.2f}, {pose.y:.2f}) is outside the house")
        if near.issubset(ignored):
            return None
        bullet = self._scene.bullet
        bullet.place(self._probe, self._body.placement(pose))
        touched = bullet.touched_by(self._probe, self._scene.floor_bodies.union(ignored))
        bullet.put_aside(self._probe)
        if touched is None:
            return None
        return Refusal(Failure.BLOCKED, f"{self._scene.name_of_body(touched)} is in the way")


def moved(pose: Pose, direction: float, distance: float) -> Pose:
    """The pose `distance` metres away in `direction`, in radians from the heading, without drift."""
    heading = pose.yaw + direction
    x = round(pose.x + distance * math.cos(heading), 9) + 0.0
    y = round(pose.y + distance * math.sin(heading), 9) + 0.0
    return Pose(x, y, pose.yaw, pose.pitch)


def _snapped(angle: float, step: float) -> float:
    """The angle itself, or the multiple of `step` that it only misses by rounding errors."""
    multiple = round(angle / step) * step
    return multiple if abs(angle - multiple) < _ALIGNED else angle


def _angle(pitch: float) -> str:
    return f"{abs(math.degrees(pitch)):.0f} degrees {'down' if pitch > 0 else 'up'}"
