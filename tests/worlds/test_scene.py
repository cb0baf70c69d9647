from __future__ import annotations

import math

import numpy as np
import pytest
from box_rooms import item, room_house, shell
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.errors import HouseError
from adhoc.core.geometry import camera_at, intrinsics
from adhoc.core.values import Capability, Pose
from adhoc.houses.house import House, HouseObject
from adhoc.houses.solids import Box, Solid, SolidKind, Surface
from adhoc.worlds.bullet import Bullet
from adhoc.worlds.pybullet_world import PyBulletWorld
from adhoc.worlds.rigid_shape import Placement, rigid_shape
from adhoc.worlds.robots import RobotBody
from adhoc.worlds.scene import Scene
from adhoc.worlds.sensor.box_sensor import BoxSensor
from adhoc.worlds.sensor.frame_cache import FrameCache
from adhoc.worlds.sensor.sensor import Frame
from adhoc.worlds.sensor.tiny import TinySensor
from adhoc.worlds.sensor.visibility import survey

number = st.floats(-5.0, 5.0)
extent = st.floats(0.01, 1.0)
boxes_ = st.builds(Box, st.tuples(number, number, number), st.tuples(extent, extent, extent), number)


@given(st.lists(boxes_, min_size=1, max_size=5))
def test_a_shape_at_its_own_placement_is_what_it_was_made_of(boxes):
    surfaces = [Surface(box.center, box.half[:2], box.yaw, 1.0) for box in boxes]
    shape, placement = rigid_shape(boxes, surfaces)
    for before, after in zip(boxes, shape.boxes_at(placement)):
        assert after.center == pytest.approx(before.center, abs=1e-9)
        assert (after.half, after.yaw) == (before.half, pytest.approx(before.yaw))
    for before, after in zip(surfaces, shape.surfaces_at(placement)):
        assert after.center == pytest.approx(before.center, abs=1e-9)
        assert (after.half, after.yaw) == (before.half, pytest.approx(before.yaw))


def test_the_extents_of_a_shape_are_along_its_first_box():
    turned = math.pi / 4
    long = Box((1.0, 1.0, 0.5), (0.4, 0.1, 0.5), turned)
    on_top = Box((1.0, 1.0, 1.1), (0.05, 0.05, 0.1), turned + math.pi / 4)
    shape, placement = rigid_shape([long, on_top])
    assert shape.half == pytest.approx((0.4, 0.1, 0.6))
    assert placement.center == pytest.approx((1.0, 1.0, 0.6))
    moved = shape.boxes_at(Placement((0.0, 0.0, 0.6), 0.0))
    assert moved[0].center == pytest.approx((0.0, 0.0, 0.5))
    assert moved[0].yaw == pytest.approx(0.0)


def test_a_surface_turns_with_its_shape():
    shape, _ = rigid_shape(
        [Box((0.0, 0.0, 0.5), (0.4, 0.1, 0.5))], [Surface((0.3, 0.0, 1.0), (0.1, 0.1), 0.0, 0.4)]
    )
    (turned,) = shape.surfaces_at(Placement((2.0, 1.0, 0.5), math.pi / 2))
    assert turned.center == pytest.approx((2.0, 1.3, 1.0))
    assert turned.yaw == pytest.approx(math.pi / 2)
    assert (turned.half, turned.clearance) == ((0.1, 0.1), 0.4)


@pytest.mark.parametrize("kind", ["numba", "tiny"])
def test_a_sensor_leaves_out_one_body_and_leaves_it_where_it_is(kind):
    bullet = Bullet()
    scene = Scene(bullet, room_house(4.0), shell(4.0))
    robot = RobotBody(0.2, 1.7).add(scene, "robot", Capability(), Pose(2.0, 2.0))
    sensor = (
        BoxSensor(scene.table, 32, math.pi / 2, 0)
        if kind == "numba"
        else TinySensor(bullet, scene.instances_by_body, scene.bodies_of, 32, math.pi / 2)
    )
    from_outside = Pose(0.5, 2.0)
    for _ in range(2):
        assert robot.instance in sensor.look(from_outside, 1.0, -1).visible
        assert robot.instance not in sensor.look(from_outside, 1.0, robot.instance).visible
    bullet.close()


def test_a_fingerprint_covers_where_things_are_and_who_holds_them():
    def fingerprint(seed):
        cup = item("cup", (1.0, 1.0, 0.06), (0.05, 0.05, 0.05))
        world = PyBulletWorld(solids_of=lambda _: [*shell(4.0), cup])
        world.reset(room_house(4.0), 0)
        if seed is not None:
            assert world.displace("cup", "room", seed)
        print_ = world.fingerprint()
        world.close()
        return print_

    assert fingerprint(None) == fingerprint(None)
    assert fingerprint(1) == fingerprint(1)
    assert len({fingerprint(seed) for seed in (None, 1, 2, 3)}) == 4


@pytest.mark.parametrize(
    ("solids", "named"),
    [
        ([item("twin", (1, 1, 1), (0.1, 0.1, 0.1))] * 2, "twin"),
        ([Solid("ghost", "Thing", SolidKind.ITEM, ())], "ghost"),
        ([Solid("hedgehog", "Thing", SolidKind.ITEM, (Box((1, 1, 1), (0.1, 0.1, 0.1)),) * 17)], "hedgehog"),
    ],
)
def test_impossible_solids_are_named(solids, named):
    world = PyBulletWorld(solids_of=lambda _: [*shell(4.0), *solids])
    with pytest.raises(HouseError, match=named):
        world.reset(room_house(4.0), 0)
    world.close()


def test_a_house_without_rooms_is_refused():
    world = PyBulletWorld(solids_of=lambda _: shell(4.0))
    with pytest.raises(HouseError, match="rooms"):
        world.reset(House("bare", (), (), (), ()), 0)
    world.close()


def test_an_unknown_parent_is_named():
    orphan = HouseObject(
        "orphan", "a", "Cup", (1, 1, 1), 0.0, (0.1, 0.1, 0.1), "room", "gone", True, 0.1, False
    )
    house = room_house(4.0)
    house = House(house.id, house.rooms, (), (), (orphan,))
    world = PyBulletWorld(solids_of=lambda _: [*shell(4.0), item("orphan", (1, 1, 1), (0.1, 0.1, 0.1))])
    with pytest.raises(HouseError, match="gone"):
        world.reset(house, 0)
    world.close()


@pytest.mark.parametrize("renderer", ["numba", "tiny"])
def test_furniture_of_many_boxes_is_one_instance_that_collides_and_is_seen(renderer):
    bars = tuple(Box((2.0, 0.1 * index, 0.5), (0.02, 0.02, 0.5)) for index in range(1, 40))
    grating = Solid("grating", "Grating", SolidKind.FURNITURE, bars)
    world = PyBulletWorld(solids_of=lambda _: [*shell(4.0), grating], renderer=renderer)
    world.reset(room_house(4.0), 0)
    seen = world.add_agent("robot", Capability(camera_height=0.9), Pose(1.0, 2.0))
    assert [label.id for label in seen.labels.values()].count("grating") == 1
    number = next(key for key, label in seen.labels.items() if label.id == "grating")
    columns = np.unique(np.nonzero(seen.instances == number)[1])
    assert columns.min() < 10
    assert columns.max() > 110
    assert not any(world.is_free(Pose(2.0, 0.1 * index)) for index in range(3, 38))
    world.close()


def test_resets_leave_no_bodies_behind():
    import pybullet

    world = PyBulletWorld(solids_of=lambda _: [*shell(4.0), item("cup", (1, 1, 0.06), (0.05, 0.05, 0.05))])
    counts = []
    for _ in range(3):
        world.reset(room_house(4.0), 0)
        world.displace("cup", "room", 0)
        world.add_agent("robot", Capability(), world.free_poses(1, 0)[0])
        counts.append(pybullet.getNumBodies(physicsClientId=world._bullet._client))
    assert counts[0] == counts[1] == counts[2] == 5 + 1 + 1 + 1  # shell, cup, probe, robot
    client = world._bullet._client
    world.close()
    assert not pybullet.isConnected(client)


def test_a_fall_leaves_no_body_and_reports_tilt():
    bullet = Bullet()
    shape, placement = rigid_shape([Box((0.0, 0.0, 1.0), (0.02, 0.02, 0.2))])
    floor, at = rigid_shape([Box((0.0, 0.0, 0.7), (0.001, 0.5, 0.1))])
    bullet.reset()
    body = bullet.add_shape(floor, at, (1.0, 1.0, 1.0))
    straight, tilt = bullet.fall(shape, placement, 0.1, 0.1)
    assert straight.center == pytest.approx((0.0, 0.0, 1.0), abs=0.01)
    assert tilt < 0.2
    beside, tilt = bullet.fall(shape, Placement((0.015, 0.0, 1.01), 0.0), 0.1, 0.8)
    assert beside.center[2] < 0.9 or tilt > 0.5
    assert bullet.touched_by(body[0]) is None
    bullet.close()
    bullet.close()


def frame(visible, size=4):
    camera = camera_at(Pose(0.0, 0.0), 1.0, intrinsics(size, size, math.pi / 2))
    return Frame(
        np.ones((size, size), np.float32), np.zeros((size, size), np.int32), frozenset(visible), camera
    )


def test_the_cache_drops_the_least_recently_used_first():
    cache = FrameCache(3 * 128)
    for key in "abc":
        cache.put(key, frame({1}))
    assert cache.used_bytes == 3 * 128
    assert cache.get("a") is not None
    cache.put("d", frame({1}))
    assert cache.get("b") is None
    assert cache.get("a") is not None
    assert cache.used_bytes == 3 * 128
    assert len(cache) == 3


def test_the_cache_forgets_frames_that_show_an_instance():
    cache = FrameCache(1000)
    cache.put("with", frame({1, 2}))
    cache.put("without", frame({1}))
    cache.drop_showing(2)
    assert cache.get("with") is None
    assert cache.get("without") is not None
    assert cache.used_bytes == 128


def test_a_survey_counts_pixels_and_measures_horizontally():
    size = 8
    camera = camera_at(Pose(3.0, 1.0, 0.7, math.pi / 3), 1.5, intrinsics(size, size, math.pi / 2))
    depth = np.full((size, size), 2.0, np.float32)
    instances = np.full((size, size), -1, np.int32)
    instances[3, 4], instances[3, 5], instances[0, 0] = 1, 1, 2
    counts, nearest = survey(Frame(depth, instances, frozenset({1, 2}), camera), 4)
    assert counts.tolist() == [0, 2, 1, 0]
    # Pixel (3, 4) is the optical axis, 60 degrees down: 2 m along it are 1 m over the floor.
    assert nearest[1] == pytest.approx(1.0)
    ray = camera.world_from_camera[:3, :3] @ (2.0 * np.array([-1.0, -0.75, 1.0]))
    assert nearest[2] == pytest.approx(math.hypot(ray[0], ray[1]))
    assert math.isinf(nearest[0])
