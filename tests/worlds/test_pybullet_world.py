from __future__ import annotations

import multiprocessing
import sys
from pathlib import Path

import pytest
from box_rooms import random_solids, room_house

from adhoc.core.errors import ConfigurationError, MissingDependency, WorldError
from adhoc.core.streams import stream
from adhoc.core.values import Action, ActionName, Capability, Pose
from adhoc.houses.procthor import read_house
from adhoc.testing.world_contract import WorldContract, contract_house
from adhoc.worlds.pybullet_world import PyBulletWorld

TEN_ROOMS = Path(__file__).resolve().parents[3] / "shared" / "data" / "procthor-train-1-ten-rooms.json.gz"


class TestBoxRayCaster(WorldContract):
    @pytest.fixture
    def make_world(self):
        return PyBulletWorld


class TestTinyRenderer(WorldContract):
    @pytest.fixture
    def make_world(self):
        return lambda: PyBulletWorld(renderer="tiny")


def _random_solids(house):
    return random_solids(5, 5.0, 30)


def trace(renderer: str = "numba", steps: int = 60) -> list[str]:
    """Fingerprints of a random history of three robots."""
    world = PyBulletWorld(renderer=renderer, image_size=32, solids_of=_random_solids)
    world.reset(room_house(5.0), 0)
    items = sorted(world.truth())
    prints = [str(world.displace(name, "Floor", index)) for index, name in enumerate(items[:3])]
    for index, pose in enumerate(world.free_poses(3, 1)):
        world.add_agent(f"robot {index}", Capability(), pose)
    generator = stream(7, "test")
    names = list(ActionName)
    names.remove(ActionName.STOP)
    for _ in range(steps):
        actions = {}
        for index in range(3):
            visible = sorted(label.id for label in world.observe(f"robot {index}").labels.values())
            target = visible[int(generator.integers(len(visible)))]
            actions[f"robot {index}"] = Action(names[int(generator.integers(len(names)))], target)
        world.step(actions)
        prints.append(world.fingerprint())
    world.close()
    return prints


def test_a_random_history_repeats_itself_here_and_in_a_new_process():
    first = trace()
    assert trace() == first
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(trace) == first
    assert len(set(first[3:])) == len(first[3:])


def test_both_renderers_tell_the_same_history():
    assert trace("tiny") == trace("numba")


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("renderer", "opengl"),
        ("image_size", 1),
        ("field_of_view", 180.0),
        ("grid_size", 0.0),
        ("rotation", 0.0),
        ("tilt", 90.0),
        ("look_up_limit", -1.0),
        ("look_down_limit", 90.0),
        ("visibility_distance", -0.1),
        ("robot_radius", 0.0),
        ("robot_height", float("nan")),
        ("mass_scale", -1.0),
        ("cache_bytes", -1),
    ],
)
def test_an_impossible_setting_is_named(name, value):
    with pytest.raises(ConfigurationError, match=name):
        PyBulletWorld(**{name: value})


def test_without_pybullet_the_error_says_what_to_do(monkeypatch):
    monkeypatch.setitem(sys.modules, "pybullet", None)
    with pytest.raises(MissingDependency, match="pip install"):
        PyBulletWorld().reset(contract_house(), 0)


@pytest.mark.parametrize("height", [0.0, -1.0, float("nan"), float("inf")])
def test_an_impossible_camera_height_is_refused(height):
    world = PyBulletWorld()
    world.reset(contract_house(), 0)
    with pytest.raises(WorldError, match="camera_height"):
        world.add_agent("robot", Capability(camera_height=height), Pose(1.0, 1.0))
    with pytest.raises(WorldError, match="finite"):
        world.add_agent("robot", Capability(), Pose(1.0, float("nan")))
    world.close()


def test_a_robot_cannot_take_the_id_of_a_thing():
    world = PyBulletWorld()
    world.reset(contract_house(), 0)
    with pytest.raises(WorldError, match="table"):
        world.add_agent("table", Capability(), Pose(1.0, 1.0))
    world.close()


def test_displacing_names_what_is_wrong():
    world = PyBulletWorld()
    world.reset(contract_house(), 0)
    with pytest.raises(WorldError, match="table"):
        world.displace("table", "Floor", 0)
    with pytest.raises(WorldError, match="nowhere"):
        world.displace("apple", "nowhere", 0)
    world.close()


@pytest.mark.real_houses
def test_a_real_house_of_ten_rooms_is_lived_in():
    if not TEN_ROOMS.exists():
        pytest.skip(f"the real house is not at {TEN_ROOMS}")
    world = PyBulletWorld(image_size=64)
    house = read_house(TEN_ROOMS)
    world.reset(house, 0)
    assert set(world.truth()) == {thing.id for thing in house.objects if thing.pickupable}
    for index, pose in enumerate(world.free_poses(5, 0)):
        assert world.add_agent(f"robot {index}", Capability(), pose).labels
    names = [ActionName.MOVE_AHEAD, ActionName.ROTATE_LEFT, ActionName.MOVE_AHEAD, ActionName.LOOK_DOWN]
    results = [
        seen.last_result.ok
        for step in range(40)
        for seen in world.step({name: Action(names[step % 4]) for name in world.agents()}).values()
    ]
    assert sum(results) > len(results) / 2
    world.close()
