"""A house on a grid with teleporting hands: the smallest world in which episodes can be run."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from adhoc.agents.policy import Ask, Policy, Turn
from adhoc.core.calls import Call, CallSpec
from adhoc.core.errors import WorldError
from adhoc.core.geometry import camera_at, intrinsics, planar_distance
from adhoc.core.messages import Message, MessageKind
from adhoc.core.streams import stream
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
from adhoc.evaluation.scenario import Displacement, Member, Scenario, difficulty_of
from adhoc.houses.house import FLOOR, House, HouseObject, Opening, Room, Wall
from adhoc.tasks.task import Task
from adhoc.worlds.world import AgentTruth, ObjectTruth, World

STEPS = {
    ActionName.MOVE_AHEAD: (0.25, 0.0),
    ActionName.MOVE_BACK: (-0.25, 0.0),
    ActionName.MOVE_LEFT: (0.0, 0.25),
    ActionName.MOVE_RIGHT: (0.0, -0.25),
}
MATRIX = intrinsics(2, 2, 1.5)


def thing(name, category, position, room, parent, pickupable=False, receptacle=False):
    size = (0.1, 0.1, 0.1) if pickupable else (1.0, 0.5, 0.8)
    return HouseObject(
        name, category, category, position, 0.0, size, room, parent, pickupable, 0.2, receptacle
    )


def two_rooms() -> House:
    """A kitchen (x 0..4) and a bedroom (x 4..8), both 4 m deep, with a door between them."""
    door = Opening("door", "door", ("kitchen", "bedroom"), (4.0, 1.5), (4.0, 2.5), 0.0, 2.0, True)
    corners = ((0.0, 0.0), (8.0, 0.0), (8.0, 4.0), (0.0, 4.0))
    walls = [
        Wall(f"wall{number}", start, end, 2.5, ("kitchen",))
        for number, (start, end) in enumerate(zip(corners, (*corners[1:], corners[0])))
    ]
    inner = Wall("inner", (4.0, 0.0), (4.0, 4.0), 2.5, ("kitchen", "bedroom"), (door,))
    return House(
        "two_rooms",
        (
            Room("kitchen", "Kitchen", ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0))),
            Room("bedroom", "Bedroom", ((4.0, 0.0), (8.0, 0.0), (8.0, 4.0), (4.0, 4.0))),
        ),
        (*walls, inner),
        (door,),
        (
            thing("counter", "CounterTop", (1.0, 0.4, 0.4), "kitchen", None, receptacle=True),
            thing("bed", "Bed", (7.0, 3.4, 0.4), "bedroom", None, receptacle=True),
            thing("apple", "Apple", (1.0, 0.4, 0.9), "kitchen", "counter", pickupable=True),
            thing("knife", "Knife", (1.2, 0.4, 0.9), "kitchen", "counter", pickupable=True),
            thing("pillow", "Pillow", (7.0, 3.4, 0.9), "bedroom", "bed", pickupable=True),
        ),
        source="/somewhere/else.json",
    )


class GridWorld(World):
    """Robots move on a grid of 0.25 m, all facing +x; hands reach 1.5 m and everything fits anywhere."""

    def __init__(self, disturb_step: int | None = None) -> None:
        self.disturb_step = disturb_step
        """At this step the world does something that no policy asked for, but in the first episode."""
        self.resets = 0

    def reset(self, house: House, seed: int) -> None:
        self.house, self.steps = house, 0
        self.resets += 1
        self.places = {it.id: (it.parent, it.position, it.room) for it in house.objects if it.pickupable}
        self.holders: dict[str, str] = {}
        self.robots: dict[str, AgentTruth] = {}
        self.capabilities: dict[str, Capability] = {}
        self.results: dict[str, ActionResult | None] = {}

    def add_agent(self, agent_id: str, capability: Capability, pose: Pose) -> Observation:
        if agent_id in self.robots:
            raise WorldError(f"{agent_id} is taken")
        if not self.is_free(pose):
            raise WorldError(f"{pose} is not free")
        self.robots[agent_id] = AgentTruth(agent_id, pose, None, 0, False)
        self.capabilities[agent_id] = capability
        self.results[agent_id] = None
        return self.observe(agent_id)

    def remove_agent(self, agent_id: str) -> None:
        if agent_id not in self.robots:
            raise WorldError(f"there is no robot {agent_id!r}")
        robot = self.robots.pop(agent_id)
        if robot.held is not None:
            del self.holders[robot.held]
            self._put(robot.held, FLOOR, (robot.pose.x, robot.pose.y))

    def step(self, actions: Mapping[str, Action]) -> Mapping[str, Observation]:
        for name, action in actions.items():
            failure = self._do(name, action)
            self.results[name] = ActionResult(action, failure)
            robot = self.robots[name]
            self.robots[name] = replace(robot, steps_used=robot.steps_used + 1)
        self.steps += 1
        if self.steps == self.disturb_step and self.resets > 1:
            parent, (x, y, z), room = self.places["pillow"]
            self.places["pillow"] = (parent, (x + 1e-9, y, z), room)
        return {name: self.observe(name) for name in self.robots}

    def observe(self, agent_id: str, rgb: bool = False) -> Observation:
        robot, capability = self.robots[agent_id], self.capabilities[agent_id]
        return Observation(
            self.steps,
            np.full((2, 2), np.inf, np.float32),
            np.full((2, 2), -1, np.int32),
            {},
            camera_at(robot.pose, capability.camera_height, MATRIX),
            robot.pose,
            robot.held,
            capability.max_steps - robot.steps_used,
            self.results[agent_id],
        )

    def free_poses(self, count: int, seed: int) -> list[Pose]:
        generator = stream(seed, "poses")
        return [
            Pose(0.25 * int(generator.integers(1, 31)), 0.25 * int(generator.integers(5, 12)))
            for _ in range(count)
        ]

    def is_free(self, pose: Pose) -> bool:
        inside = 0.2 <= pose.x <= 7.8 and 0.2 <= pose.y <= 3.8
        return inside and all(planar_distance(pose, it.pose) >= 0.4 for it in self.robots.values())

    def displace(self, object_id: str, receptacle_id: str, seed: int) -> bool:
        x, y = stream(seed, "place").uniform(0.5, 3.5, size=2)
        self._put(object_id, receptacle_id, (float(x), float(y)))
        return True

    def truth(self) -> Mapping[str, ObjectTruth]:
        return {name: self._object_truth(name) for name in self.places}

    def agents(self) -> Mapping[str, AgentTruth]:
        return dict(self.robots)

    def fingerprint(self) -> str:
        state = (self.steps, self.places, self.holders, self.robots)
        return hashlib.sha256(repr(state).encode()).hexdigest()

    def close(self) -> None:
        pass

    def _do(self, name: str, action: Action) -> Failure | None:
        robot = self.robots[name]
        if action.name in STEPS:
            return self._move(robot, *STEPS[action.name])
        if action.name is ActionName.STOP:
            self.robots[name] = replace(robot, stopped=True)
        if action.name is ActionName.PICK_UP:
            return self._take(robot, str(action.target))
        if action.name is ActionName.PUT_DOWN:
            return self._give(robot, str(action.target))
        return None

    def _move(self, robot: AgentTruth, dx: float, dy: float) -> Failure | None:
        there = replace(robot.pose, x=robot.pose.x + dx, y=robot.pose.y + dy)
        others = [it for it in self.robots.values() if it.id != robot.id]
        if not (0.2 <= there.x <= 7.8 and 0.2 <= there.y <= 3.8):
            return Failure.BLOCKED
        if any(planar_distance(there, it.pose) < 0.4 for it in others):
            return Failure.BLOCKED
        self.robots[robot.id] = replace(robot, pose=there)
        return None

    def _take(self, robot: AgentTruth, target: str) -> Failure | None:
        if target not in self.places or target in self.holders:
            return Failure.NOT_VISIBLE
        self.holders[target] = robot.id
        self.robots[robot.id] = replace(robot, held=target)
        return None

    def _give(self, robot: AgentTruth, target: str) -> Failure | None:
        if robot.held is None:
            return Failure.HAND_EMPTY
        del self.holders[robot.held]
        self._put(robot.held, target, (robot.pose.x, robot.pose.y))
        self.robots[robot.id] = replace(robot, held=None)
        return None

    def _put(self, object_id: str, receptacle_id: str, place: tuple[float, float]) -> None:
        if receptacle_id == FLOOR:
            room = "kitchen" if place[0] < 4 else "bedroom"
            self.places[object_id] = (FLOOR, (*place, 0.05), room)
        else:
            receptacle = self.house.object(receptacle_id)
            self.places[object_id] = (receptacle_id, receptacle.position, receptacle.room)

    def _object_truth(self, name: str) -> ObjectTruth:
        parent, position, room = self.places[name]
        category = self.house.object(name).category
        if name in self.holders:
            return ObjectTruth(name, category, position, None, None, None, self.holders[name])
        kind = parent if parent in (None, FLOOR) else self.house.object(parent).category
        return ObjectTruth(name, category, position, room, parent, kind)


class Errand(Task):
    """A task without content, for policies that follow a script."""

    name = "errand"
    description = "Do as the script says."
    sub_tasks: Sequence[CallSpec] = (CallSpec("Wait", (), "wait"),)
    sub_skills: Sequence[CallSpec] = (CallSpec("Wait", (), "wait"),)
    fallback = Call("Wait")

    def judge(self, record: ObjectRecord, room_type: Mapping[str, float]) -> bool | None:
        return None

    def is_place_for(self, record, receptacle, room_type):  # type: ignore[no-untyped-def]
        return False

    def finished(self, *arguments):  # type: ignore[no-untyped-def]
        return False

    def attend(self, *arguments):  # type: ignore[no-untyped-def]
        return None

    def safe_choice(self, *arguments):  # type: ignore[no-untyped-def]
        return Call("Wait")

    def search(self, *arguments):  # type: ignore[no-untyped-def]
        return None


class Script(Policy):
    """Does one action after the other, then walks at random; says what it heard, and asks when told to."""

    def __init__(self, *actions: Action, ask_at: int | None = None, say: str | None = None) -> None:
        self.actions, self.ask_at, self.say = list(actions), ask_at, say

    def reset(self, me: str, capability: Capability, task: Task, seed: int, ask: Ask) -> None:
        self.me, self.ask, self.generator = me, ask, stream(seed, "agent", me)
        self.left = list(self.actions)
        self.heard: list[Message] = []
        self.questions: list[Message] = []
        self.answers: list[Message] = []
        self.acted: list[int] = []

    def act(self, observation: Observation, inbox: Sequence[Message]) -> Turn:
        self.heard += inbox
        self.acted.append(observation.step)
        if observation.step == self.ask_at:
            self.answers += self.ask(Message(MessageKind.INTENTION, "I want the apple"))
        outbox = (Message(MessageKind.TEAM, self.say, {"step": observation.step}),) if self.say else ()
        return Turn(self._action(), outbox)

    def respond(self, message: Message) -> Message | None:
        self.questions.append(message)
        return Message(MessageKind.REPLY, f"{self.me} agrees")

    def _action(self) -> Action:
        if self.left:
            return self.left.pop(0)
        return Action(list(STEPS)[int(self.generator.integers(4))])


def fetch(object_id: str, receptacle_id: str) -> list[Action]:
    return [Action(ActionName.PICK_UP, object_id), Action(ActionName.PUT_DOWN, receptacle_id)]


def scenario(**changes: object) -> Scenario:
    """The apple and the knife on the bed, two teammates in the kitchen, a newcomer in the bedroom."""
    house = two_rooms()
    default = Scenario(
        "two_rooms-s0",
        house,
        (Displacement("apple", "bed"), Displacement("knife", "bed")),
        (
            Member("teammate_1", Capability(max_steps=100), Pose(1.0, 2.0)),
            Member("teammate_2", Capability(max_steps=100), Pose(2.0, 2.0)),
        ),
        Member("newcomer", Capability(max_steps=100), Pose(6.0, 2.0)),
        0,
        difficulty_of(len(house.rooms)),
    )
    return replace(default, **changes)  # type: ignore[arg-type]
