"""The complete state of a scene as plain values: the referee's truth, and a hash of everything."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable

from adhoc.core.values import Point
from adhoc.worlds.robots import Robot
from adhoc.worlds.scene import Scene, Thing
from adhoc.worlds.world import AgentTruth, ObjectTruth

_DECIMALS = 9


def object_truths(scene: Scene, robots: dict[str, Robot]) -> dict[str, ObjectTruth]:
    """Where every pickupable object is; one in a hand is where the robot is, and in no room."""
    return {
        thing.id: _object_truth(scene, thing, robots) for thing in scene.things.values() if thing.pickupable
    }


def agent_truths(robots: dict[str, Robot]) -> dict[str, AgentTruth]:
    """Where every robot is."""
    return {
        robot.id: AgentTruth(robot.id, robot.pose, robot.held, robot.steps_used, robot.stopped)
        for robot in robots.values()
    }


class Fingerprint:
    """SHA-256 of the step, of all robots and of all things that can move, in metres to nine decimals.

    What has not moved since the last time is not written out again.
    """

    def __init__(self, scene: Scene) -> None:
        self._things = sorted(
            (thing for thing in scene.things.values() if thing.pickupable), key=lambda thing: thing.id
        )
        self._seen: dict[str, tuple[object, str | None, str | None]] = {}
        self._lines: dict[str, bytes] = {}

    def of(self, step: int, robots: dict[str, Robot]) -> str:
        """The hash of the whole state now."""
        digest = hashlib.sha256(repr(step).encode())
        for robot in sorted(robots.values(), key=lambda robot: robot.id):
            pose = robot.pose
            state = _rounded((pose.x, pose.y, pose.yaw, pose.pitch))
            digest.update(repr((robot.id, state, robot.held, robot.steps_used, robot.stopped)).encode())
        for thing in self._things:
            now = (thing.placement, thing.receptacle, thing.holder)
            if self._seen.get(thing.id) != now:
                self._seen[thing.id] = now
                where = None if thing.holder else _rounded((*thing.placement.center, thing.placement.yaw))
                self._lines[thing.id] = repr((thing.id, where, thing.receptacle, thing.holder)).encode()
            digest.update(self._lines[thing.id])
        return digest.hexdigest()


def _object_truth(scene: Scene, thing: Thing, robots: dict[str, Robot]) -> ObjectTruth:
    position: Point = thing.placement.center
    if thing.holder is not None:
        holder = robots[thing.holder]
        position = (holder.pose.x, holder.pose.y, holder.capability.camera_height)
    return ObjectTruth(
        thing.id,
        thing.category,
        position,
        thing.room,
        thing.receptacle,
        scene.receptacle_category(thing.receptacle),
        thing.holder,
        thing.placement.yaw,
    )


def _rounded(numbers: Iterable[float]) -> tuple[float, ...]:
    return tuple(round(number, _DECIMALS) + 0.0 for number in numbers)
