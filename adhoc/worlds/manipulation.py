"""Picking up, putting down and dropping."""

from __future__ import annotations

import math
from collections.abc import Callable

from adhoc.core.values import Failure, Pose
from adhoc.houses.house import FLOOR
from adhoc.houses.solids import SolidKind
from adhoc.worlds.placement import Placer, distances_to, nearest_first
from adhoc.worlds.refusal import Refusal
from adhoc.worlds.robots import Robot
from adhoc.worlds.scene import Scene, Thing
from adhoc.worlds.sensor.sensor import Frame
from adhoc.worlds.sensor.visibility import survey


class Manipulation:
    """What a robot's hand does, with AI2-THOR's habits.

    A robot reaches what it sees: the thing has at least one pixel in what the camera shows at that moment,
    and the nearest visible point of it is within `reach` of the robot's vertical axis, horizontally.

    Args:
        scene: the house.
        placer: finds places.
        look: what a robot sees now.
        reach: metres.
        mass_scale: factor on all masses before they are compared with a payload.
        robot_radius: metres; a dropped object falls in front of the body.
    """

    def __init__(
        self,
        scene: Scene,
        placer: Placer,
        look: Callable[[Robot], Frame],
        reach: float,
        mass_scale: float,
        robot_radius: float,
    ) -> None:
        self._scene = scene
        self._placer = placer
        self._look = look
        self._reach = reach
        self._mass_scale = mass_scale
        self._robot_radius = robot_radius

    def pick_up(self, robot: Robot, target: str | None) -> Refusal | None:
        """Take an object into the hand. An object that holds others must be emptied first."""
        if target is None:
            return Refusal(Failure.NO_TARGET, "PickUp needs the id of an object")
        if robot.held is not None:
            return Refusal(Failure.HAND_FULL, f"it holds {robot.held}")
        thing = self._scene.things.get(target)
        distance = math.inf if thing is None else self._visible_distance(robot, thing)
        if thing is None or math.isinf(distance):
            return Refusal(Failure.NOT_VISIBLE, f"{target} is not in the camera's picture")
        if not thing.pickupable:
            return Refusal(Failure.NOT_PICKUPABLE, f"{target} is a {thing.category}")
        if distance > self._reach:
            return Refusal(Failure.TOO_FAR, self._distance_text(target, distance))
        mass = thing.mass * self._mass_scale
        if mass > robot.capability.payload:
            return Refusal(
                Failure.TOO_HEAVY,
                f"{target} weighs {mass:g} kg, the payload is {robot.capability.payload:g} kg",
            )
        contents = self._scene.contents(thing)
        if contents:
            return Refusal(Failure.NOT_PICKUPABLE, f"{contents[0].id} is in or on {target}")
        self._scene.take(thing, robot.id)
        robot.held = target
        return None

    def put_down(self, robot: Robot, target: str | None) -> Refusal | None:
        """Put the held object onto or into a receptacle, at the free place nearest to the robot.

        Only the receptacle must be within reach, not the place: a bed is deeper than an arm is long.
        """
        if target is None:
            return Refusal(Failure.NO_TARGET, "PutDown needs the id of a receptacle")
        if robot.held is None:
            return Refusal(Failure.HAND_EMPTY)
        receptacle = self._scene.things.get(target)
        distance = math.inf if receptacle is None else self._visible_distance(robot, receptacle)
        if receptacle is None or math.isinf(distance):
            return Refusal(Failure.NOT_VISIBLE, f"{target} is not in the camera's picture")
        if not receptacle.is_receptacle or receptacle.kind is SolidKind.FLOOR:
            hint = "; use Drop" if receptacle.kind is SolidKind.FLOOR else ""
            return Refusal(Failure.NOT_A_RECEPTACLE, f"{target} is a {receptacle.category}{hint}")
        if distance > self._reach:
            return Refusal(Failure.TOO_FAR, self._distance_text(target, distance))
        thing = self._scene.things[robot.held]
        surfaces = receptacle.surfaces
        places = nearest_first(self._placer.on_surfaces(thing, surfaces), (robot.pose.x, robot.pose.y))
        if not self._placer.put(thing, places, target):
            return Refusal(Failure.NO_FREE_PLACE, f"{thing.id} fits nowhere on or in {target}")
        robot.held = None
        return None

    def drop(self, robot: Robot) -> Refusal | None:
        """Lay the held object on the floor, at the free place nearest to the point before the robot.

        The place is within reach, and in the room that the robot stands in.
        """
        if robot.held is None:
            return Refusal(Failure.HAND_EMPTY)
        thing = self._scene.things[robot.held]
        here = (robot.pose.x, robot.pose.y)
        floor = self._scene.things.get(self._scene.room_at(here) or "")
        places = self._placer.on_surfaces(thing, () if floor is None else floor.surfaces)
        places = places[distances_to(places, here) <= self._reach]
        front = self._before(robot.pose, thing)
        if not self._placer.put(thing, nearest_first(places, front), FLOOR):
            return Refusal(Failure.NO_FREE_PLACE, f"{thing.id} fits nowhere on the floor within reach")
        robot.held = None
        return None

    def leave_behind(self, robot: Robot) -> bool:
        """Lay what a robot held that is gone on the floor, nearest to where it stood, in its room if there
        is a place; False, with everything as it was, if no floor has one. True if it held nothing."""
        if robot.held is None:
            return True
        thing, here = self._scene.things[robot.held], (robot.pose.x, robot.pose.y)
        floors = [it for it in self._scene.things.values() if it.kind is SolidKind.FLOOR]
        inside = [it for it in floors if it.id == self._scene.room_at(here)]
        for choice in (inside, floors):
            places = self._placer.on_surfaces(thing, [it for floor in choice for it in floor.surfaces])
            if self._placer.put(thing, nearest_first(places, here), FLOOR):
                robot.held = None
                return True
        return False

    def _visible_distance(self, robot: Robot, thing: Thing) -> float:
        """Horizontal metres from the robot's axis to the nearest visible point; inf if it is not visible."""
        frame = self._look(robot)
        if thing.instance not in frame.visible:
            return math.inf
        _, nearest = survey(frame, len(self._scene.labels))
        return float(nearest[thing.instance])

    def _before(self, pose: Pose, thing: Thing) -> tuple[float, float]:
        ahead = self._robot_radius + math.hypot(*thing.shape.half[:2])
        return pose.x + ahead * math.cos(pose.yaw), pose.y + ahead * math.sin(pose.yaw)

    def _distance_text(self, target: str, distance: float) -> str:
        return f"{target} is {distance:.2f} m away, the reach is {self._reach:g} m"
