"""The PyBullet adapter: a house of boxes, robots that move in steps, a depth and instance camera."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from adhoc.core.errors import ConfigurationError, WorldError
from adhoc.core.values import Action, Capability, Observation, Pose
from adhoc.houses.house import House
from adhoc.houses.solids import Solid
from adhoc.worlds.actions import Actions
from adhoc.worlds.bullet import Bullet
from adhoc.worlds.displacement import displace
from adhoc.worlds.free_space import FreeSpace
from adhoc.worlds.manipulation import Manipulation
from adhoc.worlds.motion import Motion
from adhoc.worlds.placement import PlacementRules, Placer
from adhoc.worlds.robots import Robot, RobotBody
from adhoc.worlds.scene import Scene
from adhoc.worlds.sensor.box_sensor import BoxSensor
from adhoc.worlds.sensor.sensor import Frame, Sensor
from adhoc.worlds.sensor.tiny import TinySensor
from adhoc.worlds.world import AgentTruth, ObjectTruth, World
from adhoc.worlds.world_state import Fingerprint, agent_truths, object_truths

RENDERERS = ("numba", "tiny")
"""`numba` casts rays at boxes; `tiny` is PyBullet's TinyRenderer: the same picture, many times slower."""


class PyBulletWorld(World):
    """A house in PyBullet. Worlds are independent of each other; one can be reset any number of times.

    The defaults are AI2-THOR's, the simulator of ProcTHOR houses; the paper names none. All robots collide
    alike (`robot_radius`, `robot_height`) and are seen as boxes of the category `Robot`. A held object is
    neither seen nor in anybody's way.

    Args:
        image_size: width and height of pictures in pixels.
        field_of_view: degrees.
        renderer: one of `RENDERERS`.
        grid_size: metres of one move.
        rotation: degrees of one turn.
        tilt: degrees of one tilt of the camera.
        look_up_limit: the most that a camera looks up, in degrees.
        look_down_limit: the most that a camera looks down, in degrees.
        visibility_distance: metres within which a robot can pick up, and put down onto, what it sees.
        robot_radius: of the cylinder that stands for a robot, in metres.
        robot_height: of that cylinder, in metres.
        mass_scale: factor on all masses. With real masses a payload hardly ever binds; above 1 it does.
        cache_bytes: memory for stored pictures of what does not move (`numba` only).
        placement: when a place for an object is good enough.
        solids_of: turns a house into boxes; None for `houses.build.build_solids`.

    Raises:
        ConfigurationError: an argument is out of its range.
        MissingDependency: PyBullet is not installed (raised by `reset`).
    """

    def __init__(
        self,
        image_size: int = 128,
        field_of_view: float = 90.0,
        renderer: str = "numba",
        grid_size: float = 0.25,
        rotation: float = 90.0,
        tilt: float = 30.0,
        look_up_limit: float = 30.0,
        look_down_limit: float = 60.0,
        visibility_distance: float = 1.5,
        robot_radius: float = 0.2,
        robot_height: float = 1.7,
        mass_scale: float = 1.0,
        cache_bytes: int = 128 * 2**20,
        placement: PlacementRules | None = None,
        solids_of: Callable[[House], Sequence[Solid]] | None = None,
    ) -> None:
        if renderer not in RENDERERS:
            raise ConfigurationError(f"renderer must be one of {', '.join(RENDERERS)}, not {renderer!r}")
        _check_range("image_size", image_size, 2, 4096)
        _check_range("field_of_view", field_of_view, 1.0, 170.0)
        _check_range("grid_size", grid_size, 0.01, 10.0)
        _check_range("rotation", rotation, 1.0, 180.0)
        _check_range("tilt", tilt, 1.0, 89.0)
        _check_range("look_up_limit", look_up_limit, 0.0, 89.0)
        _check_range("look_down_limit", look_down_limit, 0.0, 89.0)
        _check_range("visibility_distance", visibility_distance, 0.0, math.inf)
        _check_range("robot_radius", robot_radius, 0.01, 10.0)
        _check_range("robot_height", robot_height, 0.01, 10.0)
        _check_range("mass_scale", mass_scale, 0.0, math.inf)
        _check_range("cache_bytes", cache_bytes, 0, math.inf)
        self._image_size = int(image_size)
        self._field_of_view = math.radians(field_of_view)
        self._renderer = renderer
        self._grid_size = float(grid_size)
        self._rotation = math.radians(rotation)
        self._tilt = math.radians(tilt)
        self._tilt_limits = (-math.radians(look_up_limit), math.radians(look_down_limit))
        self._reach = float(visibility_distance)
        self._robot_body = RobotBody(float(robot_radius), float(robot_height))
        self._mass_scale = float(mass_scale)
        self._cache_bytes = int(cache_bytes)
        self._placement_rules = placement or PlacementRules()
        self._solids_of = solids_of or _default_solids
        self._bullet: Bullet | None = None
        self._live: _LiveHouse | None = None

    def reset(self, house: House, seed: int) -> None:
        """See `World.reset`. Nothing here is random: the seed has no effect."""
        self._live = None
        solids = self._solids_of(house)
        if self._bullet is None:
            self._bullet = Bullet()
        live = self._settle_in(Scene(self._bullet, house, solids))
        if not live.free_space.has_any():
            raise WorldError(
                f"house {house.id!r} has no free cell: a robot of radius {self._robot_body.radius:g} m "
                f"fits nowhere on its lattice of {self._grid_size:g} m"
            )
        self._live = live

    def add_agent(self, agent_id: str, capability: Capability, pose: Pose) -> Observation:
        live = self._house()
        if agent_id in live.robots or agent_id in live.scene.things:
            raise WorldError(f"agent id {agent_id!r} is taken; every robot needs an id of its own")
        if not 0.0 < capability.camera_height < math.inf:
            raise WorldError(
                f"robot {agent_id!r}: camera_height must be above 0 m, not {capability.camera_height!r}"
            )
        if not all(map(math.isfinite, (pose.x, pose.y, pose.yaw, pose.pitch))):
            raise WorldError(f"robot {agent_id!r}: {pose} must be finite")
        refusal = live.motion.misfit(pose)
        if refusal is not None:
            where = f"x {pose.x:g}, y {pose.y:g}"
            raise WorldError(f"robot {agent_id!r} cannot stand at {where}: {refusal.detail}")
        robot = self._robot_body.add(live.scene, agent_id, capability, pose)
        live.robots[agent_id] = robot
        return live.observation(robot)

    def remove_agent(self, agent_id: str) -> None:
        live = self._house()
        robot = live.robot(agent_id)
        self._robot_body.put_aside(live.scene, robot)
        if not live.manipulation.leave_behind(robot):
            self._robot_body.move(live.scene, robot, robot.pose)
            raise WorldError(f"robot {agent_id!r} cannot leave: no floor has a place for {robot.held!r}")
        del live.robots[agent_id]

    def step(self, actions: Mapping[str, Action]) -> Mapping[str, Observation]:
        """See `World.step`. A robot without an action gets None as its `last_result`."""
        live = self._house()
        acting = [(live.robot(agent_id), action) for agent_id, action in actions.items()]
        for robot in live.robots.values():
            robot.last_result = None
        for robot, action in acting:
            live.actions.perform(robot, action)
        live.steps += 1
        return {agent_id: live.observation(robot) for agent_id, robot in live.robots.items()}

    def observe(self, agent_id: str, rgb: bool = False) -> Observation:
        live = self._house()
        return live.observation(live.robot(agent_id), rgb)

    def free_poses(self, count: int, seed: int) -> list[Pose]:
        """See `World.free_poses`.

        Poses are cells of a lattice through the origin, of `grid_size`, in the largest part of the house
        that is connected by real moves along the lattice, with a yaw that is a multiple of `rotation`; two
        robots have room at any two of them at once.
        """
        live = self._house()
        bodies = [robot.body for robot in live.robots.values()]
        return live.free_space.draw(count, seed, bodies, spacing=2 * self._robot_body.radius)

    def is_free(self, pose: Pose) -> bool:
        return self._house().motion.misfit(pose) is None

    def displace(self, object_id: str, receptacle_id: str, seed: int) -> bool:
        """See `World.displace`. The id of a room stands for the floor of that room.

        An object that is held, or that holds others, is not displaced (False). Raises WorldError for an id
        that the house does not have, or an object that cannot be picked up.
        """
        live = self._house()
        return displace(live.scene, live.placer, object_id, receptacle_id, seed)

    def truth(self) -> Mapping[str, ObjectTruth]:
        live = self._house()
        return object_truths(live.scene, live.robots)

    def agents(self) -> Mapping[str, AgentTruth]:
        return agent_truths(self._house().robots)

    def fingerprint(self) -> str:
        live = self._house()
        return live.fingerprint.of(live.steps, live.robots)

    def close(self) -> None:
        self._live = None
        if self._bullet is not None:
            self._bullet.close()
        self._bullet = None

    def _house(self) -> _LiveHouse:
        if self._live is None:
            raise WorldError("the world has no house: call reset(house, seed) first, also after close()")
        return self._live

    def _settle_in(self, scene: Scene) -> _LiveHouse:
        photographer = TinySensor(
            scene.bullet,
            scene.instances_by_body,
            scene.bodies_of,
            self._image_size,
            self._field_of_view,
        )
        sensor: Sensor = photographer
        if self._renderer == "numba":
            sensor = BoxSensor(scene.table, self._image_size, self._field_of_view, self._cache_bytes)
        scene.watch(sensor.forget)
        motion = Motion(
            scene, self._robot_body, self._grid_size, self._rotation, self._tilt, self._tilt_limits
        )
        placer = Placer(scene, self._placement_rules)

        def look(robot: Robot) -> Frame:
            return sensor.look(robot.pose, robot.capability.camera_height, robot.instance)

        manipulation = Manipulation(
            scene, placer, look, self._reach, self._mass_scale, self._robot_body.radius
        )
        return _LiveHouse(
            scene=scene,
            look=look,
            photographer=photographer,
            motion=motion,
            manipulation=manipulation,
            actions=Actions(motion, manipulation),
            placer=placer,
            free_space=FreeSpace(scene, motion, self._grid_size, self._rotation),
            fingerprint=Fingerprint(scene),
        )


@dataclass
class _LiveHouse:
    """Everything that one reset builds and the next one throws away."""

    scene: Scene
    look: Callable[[Robot], Frame]
    photographer: TinySensor
    motion: Motion
    manipulation: Manipulation
    actions: Actions
    placer: Placer
    free_space: FreeSpace
    fingerprint: Fingerprint
    robots: dict[str, Robot] = field(default_factory=dict)
    steps: int = 0

    def robot(self, agent_id: str) -> Robot:
        """The robot of that id. Raises WorldError."""
        if agent_id not in self.robots:
            known = ", ".join(self.robots) or "none"
            raise WorldError(f"there is no robot {agent_id!r} in this house; there are: {known}")
        return self.robots[agent_id]

    def observation(self, robot: Robot, rgb: bool = False) -> Observation:
        """What the robot perceives now."""
        frame = self.look(robot)
        labels = self.scene.labels
        picture = None
        if rgb:
            height = robot.capability.camera_height
            picture = self.photographer.photograph(robot.pose, height, robot.instance)
        return Observation(
            step=self.steps,
            depth=frame.depth,
            instances=frame.instances,
            labels={instance: labels[instance] for instance in sorted(frame.visible)},
            camera=frame.camera,
            pose=robot.pose,
            held=robot.held,
            steps_left=robot.steps_left,
            last_result=robot.last_result,
            rgb=picture,
        )


def _check_range(name: str, value: float, least: float, most: float) -> None:
    if not least <= value <= most:
        raise ConfigurationError(f"{name} must be between {least:g} and {most:g}, not {value!r}")


def _default_solids(house: House) -> Sequence[Solid]:
    from adhoc.houses.build import build_solids

    return build_solids(house)
