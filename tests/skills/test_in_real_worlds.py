"""Skills in the PyBullet world: explore a sample house, find an object, carry it somewhere else."""

import math
from pathlib import Path

import pytest
from tiny_world import Walker

from adhoc.core.values import Action, Capability, Observation
from adhoc.houses.samples import sample_house
from adhoc.skills.explore import NOTHING_LEFT

pytest.importorskip("pybullet")

TEN_ROOMS = Path(__file__).parents[3] / "shared" / "data" / "procthor-train-1-ten-rooms.json.gz"


class OneRobotWorld:
    """A World with one robot, in the form that `Walker` drives."""

    def __init__(self, house, seed: int = 0, height: float = 1.6) -> None:
        from adhoc.worlds.pybullet_world import PyBulletWorld

        self.world = PyBulletWorld()
        self.world.reset(house, seed)
        self.capability = Capability(max_steps=5000, camera_height=height)
        self._first = self.world.add_agent("me", self.capability, self.world.free_poses(1, seed)[0])
        self.bumps = 0

    def look(self) -> Observation:
        return self._first

    def step(self, action: Action) -> Observation:
        observation = self.world.step({"me": action})["me"]
        self.bumps += observation.last_result.failure is not None
        return observation


@pytest.fixture
def walker():
    walker = Walker(OneRobotWorld(sample_house("one_room")))
    yield walker
    walker.world.world.close()


def explore(walker: Walker, most: int = 200) -> str | None:
    for _ in range(most):
        failure = walker.run("Explore")
        if failure is not None:
            return failure
    return None


def wrong_receptacles(walker: Walker) -> list[str]:
    truth = walker.world.world.truth()
    return [
        name
        for name, record in walker.perception.objects.items()
        if name in truth and record.receptacle not in (None, truth[name].receptacle)
    ]


def test_a_sample_house_is_explored_and_understood(walker):
    assert explore(walker) == NOTHING_LEFT
    assert walker.perception.map.frontiers() == ()
    assert wrong_receptacles(walker) == []
    truth = walker.world.world.truth()
    found = [name for name in truth if name in walker.perception.objects]
    assert len(found) >= 0.7 * len(truth)
    for name in found:
        assert math.dist(walker.perception.objects[name].position, truth[name].position) < 0.15
        assert walker.perception.objects[name].room == truth[name].room


def test_an_object_is_carried_to_another_receptacle(walker):
    explore(walker)
    objects = walker.perception.objects
    items = sorted(name for name, it in objects.items() if it.is_pickupable and it.receptacle)
    places = sorted(name for name, it in objects.items() if it.is_receptacle and not it.is_pickupable)
    for item in items:
        if walker.run("GoToObject", item) is not None or walker.run("PickupObject", item) is not None:
            continue
        assert walker.observation.held == item
        for place in places:
            room = walker.perception.rooms.keys()
            if walker.run("PutObject", item, place, next(iter(room))) is None:
                assert walker.world.world.truth()[item].receptacle == place
                return
    pytest.fail("nothing could be carried anywhere")


@pytest.mark.real_houses
@pytest.mark.skipif(not TEN_ROOMS.exists(), reason="the real ten-room house is not beside the checkout")
def test_ten_rooms_are_explored_and_understood():
    from adhoc.houses.procthor import read_house

    house = read_house(TEN_ROOMS)
    walker = Walker(OneRobotWorld(house))
    assert explore(walker) == NOTHING_LEFT
    walker.perception._rooms._age = 99
    rooms = walker.perception.rooms
    assert {name for name, room in rooms.items() if room.explored} == {room.id for room in house.rooms}
    types = {room.id: room.room_type for room in house.rooms}
    assert sum(room.room_type == types[name] for name, room in rooms.items()) >= 9
    assert len(wrong_receptacles(walker)) <= 2
    truth = walker.world.world.truth()
    assert sum(name in walker.perception.objects for name in truth) >= 0.85 * len(truth)
    assert walker.world.bumps <= 5
    walker.world.world.close()
