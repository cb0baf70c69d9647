"""A robot with AI2-THOR's habits among the boxes of a `TinyScene`, and a loop that runs skills in it."""

from __future__ import annotations

import math

from tiny_scene import TinyScene

from adhoc.core.calls import Call
from adhoc.core.values import Action, ActionName, ActionResult, Capability, Failure, Observation, Pose
from adhoc.perception.perception import Perception
from adhoc.skills.approach import visible_distance
from adhoc.skills.library import standard_skills
from adhoc.skills.navigator import MOVES, Navigator
from adhoc.skills.skill import SkillView

RADIUS, STEP, REACH = 0.2, 0.25, 1.5
PORTABLE = {"Apple", "Mug"}


class TinyWorld:
    """`walls` are boxes that collide and cannot be seen; `refusals` are forced outcomes of PutDown."""

    def __init__(self, scene: TinyScene, pose: Pose, capability: Capability = Capability()) -> None:  # noqa: B008
        self.scene = scene
        self.pose = pose
        self.capability = capability
        self.held: str | None = None
        self.walls: list[tuple[float, float, float, float]] = []
        self.refusals: list[Failure] = []
        self.taken: list[Action] = []
        self.bumps = 0
        self.put_from: list[tuple[float, float]] = []
        self._stored: dict[str, tuple] = {}
        self._result: ActionResult | None = None

    def look(self) -> Observation:
        height, step = self.capability.camera_height, len(self.taken)
        return self.scene.look(self.pose, step, self.held, height, self._result)

    def step(self, action: Action) -> Observation:
        failure = self._perform(action)
        self.bumps += failure is Failure.BLOCKED
        self._result = ActionResult(action, failure, "so it is" if failure else "")
        self.taken.append(action)
        return self.look()

    def _perform(self, action: Action) -> Failure | None:
        x, y, yaw, pitch = self.pose.x, self.pose.y, self.pose.yaw, self.pose.pitch
        if action.name in MOVES:
            heading = yaw + MOVES.index(action.name) * math.pi / 2
            target = Pose(x + STEP * math.cos(heading), y + STEP * math.sin(heading), yaw, pitch)
            if self._collides(target):
                return Failure.BLOCKED
            self.pose = target
        elif action.name in (ActionName.ROTATE_LEFT, ActionName.ROTATE_RIGHT):
            sign = 1 if action.name is ActionName.ROTATE_LEFT else -1
            self.pose = Pose(x, y, yaw + sign * math.pi / 2, pitch)
        elif action.name in (ActionName.LOOK_DOWN, ActionName.LOOK_UP):
            tilted = round(math.degrees(pitch)) + (30 if action.name is ActionName.LOOK_DOWN else -30)
            if not -30 <= tilted <= 60:
                return Failure.LOOK_LIMIT
            self.pose = Pose(x, y, yaw, math.radians(tilted))
        elif action.name is ActionName.PICK_UP:
            return self._pick_up(str(action.target))
        elif action.name in (ActionName.PUT_DOWN, ActionName.DROP):
            return self._put_down(action)
        return None

    def _pick_up(self, name: str) -> Failure | None:
        distance = visible_distance(self.look(), name)
        if distance == math.inf:
            return Failure.NOT_VISIBLE
        if distance > REACH:
            return Failure.TOO_FAR
        if self.capability.payload < 0.1:
            return Failure.TOO_HEAVY
        self._stored[name] = self.scene.boxes.pop(name)
        self.held = name
        return None

    def _put_down(self, action: Action) -> Failure | None:
        self.put_from.append((self.pose.x, self.pose.y))
        if self.refusals:
            return self.refusals.pop(0)
        x, y, z = (
            self.pose.x + 0.4 * math.cos(self.pose.yaw),
            self.pose.y + 0.4 * math.sin(self.pose.yaw),
            0.0,
        )
        if action.name is ActionName.PUT_DOWN:
            if visible_distance(self.look(), str(action.target)) > REACH:
                return Failure.TOO_FAR
            _, x0, y0, _, x1, y1, z = self.scene.boxes[str(action.target)]
            x, y = (x0 + x1) / 2, (y0 + y1) / 2
        assert self.held is not None
        self.scene.boxes[self.held] = ("Apple", x - 0.05, y - 0.05, z, x + 0.05, y + 0.05, z + 0.1)
        self.held = None
        return None

    def _collides(self, pose: Pose) -> bool:
        solid = [(b[1], b[2], b[4], b[5]) for b in self.scene.boxes.values() if b[3] < 1.7]
        return any(_touches(pose, box) for box in solid + self.walls)


class Walker:
    """One robot's perception, navigator and skills in a `TinyWorld` or any world with `step(action)`."""

    def __init__(self, world: TinyWorld) -> None:
        self.world = world
        self.perception = Perception()
        self.navigator = Navigator(self.perception.map)
        self.skills = {name: build() for name, build in standard_skills().items()}
        self.observation = world.look()
        self.perception.observe(self.observation)

    def view(self, focus_room: str | None = None, others: tuple[tuple[float, float], ...] = ()) -> SkillView:
        return SkillView(
            self.observation,
            self.perception.map,
            self.navigator,
            self.world.capability,
            self.perception.objects,
            self.perception.rooms,
            focus_room,
            others,
        )

    def run(self, name: str, *args: str | float, focus_room: str | None = None) -> str | None:
        """Run a skill to its end; its failure."""
        skill = self.skills[name]
        skill.start(Call(name, args), self.view(focus_room))
        for _ in range(1000):
            action = skill.step(self.view(focus_room))
            if action is None:
                return skill.failure
            self.do(action)
        raise AssertionError(f"{name} did not end")

    def do(self, action: Action) -> None:
        self.observation = self.world.step(action)
        self.perception.observe(self.observation)

    def spin(self) -> None:
        """Look around, at the floor close by and farther away."""
        for tilt in (ActionName.LOOK_DOWN, ActionName.LOOK_DOWN, ActionName.LOOK_UP):
            self.do(Action(tilt))
            for _ in range(4):
                self.do(Action(ActionName.ROTATE_LEFT))

    @property
    def moves(self) -> list[str]:
        return [action.name.value for action in self.world.taken if action.name in MOVES]


def _touches(pose: Pose, box: tuple[float, float, float, float]) -> bool:
    x0, y0, x1, y1 = box
    dx = max(x0 - pose.x, 0, pose.x - x1)
    dy = max(y0 - pose.y, 0, pose.y - y1)
    return math.hypot(dx, dy) < RADIUS
