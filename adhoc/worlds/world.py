"""The contract of a world: where robots stand, see and act."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass

from adhoc.core.values import Action, Capability, Observation, Point, Pose
from adhoc.houses.house import House


@dataclass(frozen=True)
class ObjectTruth:
    """Where an object really is. `receptacle` is an id, `Floor`, or None while a robot holds it."""

    id: str
    category: str
    position: Point
    room: str | None
    receptacle: str | None
    receptacle_category: str | None
    holder: str | None = None
    """Id of the robot that holds it."""
    yaw: float = 0.0
    """Radians; worlds that turn nothing may leave it at 0."""


@dataclass(frozen=True)
class AgentTruth:
    """Where a robot really is, and what its battery has paid for."""

    id: str
    pose: Pose
    held: str | None
    steps_used: int
    stopped: bool


class World(ABC):
    """One house with robots in it. All methods are deterministic in (house, seed, calls so far).

    A world never judges a task and never talks: it moves, collides, and shows each robot what its camera
    sees. What a robot may not know (`truth`, `agents`) is for the referee alone; policies are never given
    the world.
    """

    @abstractmethod
    def reset(self, house: House, seed: int) -> None:
        """Build `house` with no robot in it; forgets everything before.

        Raises HouseError if the house cannot be built, WorldError if it has no free cell for a robot.
        """

    @abstractmethod
    def add_agent(self, agent_id: str, capability: Capability, pose: Pose) -> Observation:
        """Put a robot into the house, at any step, and return its first observation.

        Raises WorldError if the id is taken, or if the pose is inside something or outside the house.
        """

    @abstractmethod
    def remove_agent(self, agent_id: str) -> None:
        """Take a robot out of the house, at any step: nobody sees it or is blocked by it any more, `agents`
        names it no longer, and its id is free again.

        What it held stays: on the floor, at the free place nearest to where the robot stood, in the same room
        if that has one. Raises WorldError for an unknown robot id, or if no floor has a place for what it
        holds; then nothing is changed.
        """

    @abstractmethod
    def step(self, actions: Mapping[str, Action]) -> Mapping[str, Observation]:
        """Carry out one action per robot, in the order of the mapping, then let every robot look.

        An impossible action changes nothing and is reported in the robot's next
        `Observation.last_result`; it costs a battery step like any other. A robot without an action
        rests, without cost. Only an unknown robot id raises (WorldError).
        """

    @abstractmethod
    def observe(self, agent_id: str, rgb: bool = False) -> Observation:
        """What the robot sees now; with colour if asked. Costs no step."""

    @abstractmethod
    def free_poses(self, count: int, seed: int) -> list[Pose]:
        """`count` poses where a robot fits, mutually reachable, drawn from the stream of `seed`.

        Raises WorldError if the house has no free cell.
        """

    @abstractmethod
    def is_free(self, pose: Pose) -> bool:
        """Whether a robot fits at the pose, inside the house, without touching anything."""

    @abstractmethod
    def displace(self, object_id: str, receptacle_id: str, seed: int) -> bool:
        """For setting up scenarios: move an object onto or into a receptacle (or `Floor`), physically
        checked, at a place drawn from the stream of `seed`; False if no place was free."""

    @abstractmethod
    def truth(self) -> Mapping[str, ObjectTruth]:
        """Where every pickupable object really is (referee only)."""

    @abstractmethod
    def agents(self) -> Mapping[str, AgentTruth]:
        """Where every robot really is (referee only)."""

    @abstractmethod
    def fingerprint(self) -> str:
        """A hash of the complete state, equal for equal histories on every machine."""

    @abstractmethod
    def close(self) -> None:
        """Free the simulator. Idempotent."""
