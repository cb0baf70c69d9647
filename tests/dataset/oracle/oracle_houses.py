"""Tiny houses for the oracle, in which everything lies where a test says, and answers are counted by hand."""

from __future__ import annotations

from itertools import pairwise

from adhoc.core.values import Capability, Pose
from adhoc.evaluation.scenario import Difficulty, Displacement, Member, Scenario
from adhoc.houses.facts import asset
from adhoc.houses.house import FLOOR, House, HouseObject, Room, Wall
from adhoc.worlds.pybullet_world import PyBulletWorld

HEIGHT = 2.5
AWAY = Pose(0.5, 3.5)


class StillWorld(PyBulletWorld):
    """A world in which misplaced objects lie where the house says."""

    def displace(self, object_id, receptacle_id, seed):
        return True


def kitchen(*things: HouseObject, size: float = 4.0) -> House:
    """A square kitchen with a corner at the origin."""
    corners = ((0.0, 0.0), (size, 0.0), (size, size), (0.0, size))
    return House("kitchen", (Room("room", "Kitchen", corners),), walls(*corners, corners[0]), (), things)


def two_rooms(*things: HouseObject, kind: str = "Kitchen") -> House:
    """Two rooms, x 0..3 and x 5..8, joined by a passage at y 1..1.75 that is too narrow for two robots."""
    rooms = (
        Room("west", kind, ((0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0))),
        Room("passage", "Kitchen", ((3.0, 1.0), (5.0, 1.0), (5.0, 1.75), (3.0, 1.75))),
        Room("east", kind, ((5.0, 0.0), (8.0, 0.0), (8.0, 3.0), (5.0, 3.0))),
    )
    south = ((3.0, 0.0), (3.0, 1.0), (5.0, 1.0), (5.0, 0.0))
    north = ((5.0, 3.0), (5.0, 1.75), (3.0, 1.75), (3.0, 3.0))
    outline = ((0.0, 0.0), *south, (8.0, 0.0), (8.0, 3.0), *north, (0.0, 3.0), (0.0, 0.0))
    return House("two rooms", rooms, walls(*outline), (), things)


def walls(*corners: tuple[float, float]) -> tuple[Wall, ...]:
    return tuple(
        Wall(f"wall|{index}", start, end, HEIGHT, ("room",))
        for index, (start, end) in enumerate(pairwise(corners))
    )


def on_floor(name: str, x: float, y: float, category: str = "Apple", room: str = "room") -> HouseObject:
    facts = asset({"Apple": "Apple_1", "Egg": "Egg_1", "Box": "Box_1"}[category])
    position = (x, y, facts.size[2] / 2 + 0.001)
    return HouseObject(
        name, facts.asset, category, position, 0.0, facts.size, room, FLOOR, True, facts.mass, False
    )


def counter(
    x: float, y: float, length: float = 2.0, room: str = "room", name: str = "counter"
) -> HouseObject:
    size = (length, 0.6, 0.9)
    return HouseObject(
        name, "CounterTop_1", "CounterTop", (x, y, 0.45), 0.0, size, room, FLOOR, False, 0.0, True
    )


def robot(name: str, x: float, y: float, yaw: float = 0.0, **abilities) -> Member:
    return Member(name, Capability(**abilities), Pose(x, y, yaw))


def idle(name: str, x: float, y: float, **abilities) -> Member:
    return robot(name, x, y, can_manipulate=False, **abilities)


def scenario(house: House, misplaced: list[str], team: list[Member], newcomer: Member) -> Scenario:
    displaced = tuple(Displacement(name, FLOOR) for name in misplaced)
    return Scenario("task", house, displaced, tuple(team), newcomer, 0, Difficulty.EASY)
