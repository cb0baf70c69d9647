from __future__ import annotations

import math

import pytest
from box_rooms import room_house, shell, table

from adhoc.core.errors import WorldError
from adhoc.core.values import Action, ActionName, Capability, Failure, Pose
from adhoc.houses.house import House, Room
from adhoc.houses.solids import Box, Solid, SolidKind
from adhoc.worlds.pybullet_world import PyBulletWorld


def world_of(*solids, size=4.0, house=None, **options):
    world = PyBulletWorld(solids_of=lambda _: [*shell(size), *solids], **options)
    world.reset(house or room_house(size), 0)
    return world


def wall(name, x, y0, y1):
    half = (y1 - y0) / 2
    return Solid(name, "Wall", SolidKind.WALL, (Box((x, y0 + half, 1.25), (0.02, half, 1.25)),))


def test_a_thin_post_between_start_and_end_blocks():
    # With a stride of 1 m neither end of the move touches the post in the middle.
    world = world_of(table("post", (2.0, 2.0), (0.02, 0.02), 1.0), grid_size=1.0)
    world.add_agent("robot", Capability(), Pose(1.5, 2.0))
    assert world.is_free(Pose(2.5, 2.0))
    result = world.step({"robot": Action(ActionName.MOVE_AHEAD)})["robot"].last_result
    assert result.failure is Failure.BLOCKED
    assert result.detail == "post is in the way"
    world.close()


def test_a_robot_may_touch_but_not_penetrate():
    world = world_of(table("block", (2.0, 2.0), (0.1, 0.1), 1.0))
    assert world.is_free(Pose(1.7, 2.0))
    assert not world.is_free(Pose(1.702, 2.0))
    # At the corner the round body comes closer than a square one would.
    diagonal = 0.1 + 0.2 / math.sqrt(2)
    assert world.is_free(Pose(2.0 + diagonal + 0.002, 2.0 + diagonal + 0.002))
    assert not world.is_free(Pose(2.0 + diagonal - 0.002, 2.0 + diagonal - 0.002))
    world.close()


def test_a_robot_passes_below_what_is_higher_than_it():
    lintel = Solid("lintel", "Wall", SolidKind.WALL, (Box((2.0, 2.0, 2.2), (0.1, 2.0, 0.3)),))
    world = world_of(lintel)
    assert world.is_free(Pose(2.0, 2.0))
    world.close()
    taller = world_of(lintel, robot_height=2.0)
    assert not taller.is_free(Pose(2.0, 2.0))
    taller.close()


def test_a_move_out_of_the_house_is_blocked_without_any_wall():
    world = PyBulletWorld(solids_of=lambda _: shell(4.0)[:1])
    world.reset(room_house(4.0), 0)
    world.add_agent("robot", Capability(), Pose(3.9, 2.0))
    result = world.step({"robot": Action(ActionName.MOVE_AHEAD)})["robot"].last_result
    assert result.failure is Failure.BLOCKED
    assert "outside" in result.detail
    world.close()


def test_long_walks_do_not_drift():
    world = world_of()
    start = Pose(1.0, 1.0)
    world.add_agent("robot", Capability(), start)
    for _ in range(25):
        for name in [ActionName.MOVE_AHEAD] * 3 + [ActionName.ROTATE_LEFT]:
            seen = world.step({"robot": Action(name)})["robot"]
            assert seen.last_result.ok
            assert seen.pose.x * 4 == round(seen.pose.x * 4)
    assert seen.pose == Pose(1.75, 1.0, math.pi / 2)
    yaws = {
        round(world.step({"robot": Action(ActionName.ROTATE_LEFT)})["robot"].pose.yaw, 12) for _ in "1234"
    }
    assert len(yaws) == 4
    world.close()


def test_other_strides_turns_and_tilts():
    world = world_of(grid_size=0.5, rotation=45.0, tilt=10.0)
    world.add_agent("robot", Capability(), Pose(2.0, 2.0))
    turned = world.step({"robot": Action(ActionName.ROTATE_LEFT)})["robot"]
    assert turned.pose.yaw == pytest.approx(math.pi / 4)
    moved = world.step({"robot": Action(ActionName.MOVE_AHEAD)})["robot"]
    assert moved.pose.x == moved.pose.y == pytest.approx(2.0 + 0.5 / math.sqrt(2))
    tilted = world.step({"robot": Action(ActionName.LOOK_DOWN)})["robot"]
    assert tilted.pose.pitch == pytest.approx(math.radians(10.0))
    world.close()


def test_free_poses_are_in_the_largest_part_of_the_house():
    # A wall at x = 3 leaves 2.95 m on one side and 0.95 m on the other.
    world = world_of(wall("partition", 3.0, 0.0, 4.0))
    poses = [pose for seed in range(8) for pose in world.free_poses(3, seed)]
    assert max(pose.x for pose in poses) <= 2.75
    assert {pose.x % 0.25 for pose in poses} == {pose.y % 0.25 for pose in poses} == {0.0}
    assert len({pose.yaw for pose in poses}) == 4
    world.close()


def test_a_door_connects_two_rooms():
    house = House(
        "two",
        (
            Room("west", "Kitchen", ((0.0, 0.0), (2.0, 0.0), (2.0, 4.0), (0.0, 4.0))),
            Room("east", "Bedroom", ((2.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 4.0))),
        ),
        (),
        (),
        (),
    )
    walls = (wall("lower", 2.0, 0.0, 1.5), wall("upper", 2.0, 2.5, 4.0))
    world = world_of(*walls, house=house)
    poses = [pose for seed in range(8) for pose in world.free_poses(3, seed)]
    assert min(pose.x for pose in poses) < 1.8 < 2.2 < max(pose.x for pose in poses)
    world.add_agent("robot", Capability(), Pose(1.5, 2.0))
    xs = [world.step({"robot": Action(ActionName.MOVE_AHEAD)})["robot"].pose.x for _ in range(4)]
    assert xs == [1.75, 2.0, 2.25, 2.5]
    world.close()


def test_robots_take_their_place_but_do_not_cut_the_house():
    # A corridor one robot wide: the one in its middle must not hide the far end.
    walls = (wall("left", 1.7, 0.0, 4.0), wall("right", 2.3, 0.0, 4.0))
    house = House(
        "corridor", (Room("room", "Kitchen", ((1.7, 0.0), (2.3, 0.0), (2.3, 4.0), (1.7, 4.0))),), (), (), ()
    )
    world = world_of(*walls, house=house)
    world.add_agent("robot", Capability(), Pose(2.0, 2.0))
    ys = {pose.y for seed in range(20) for pose in world.free_poses(1, seed)}
    assert min(ys) < 1.5
    assert max(ys) > 2.5
    assert not any(1.6 < y < 2.4 for y in ys)
    world.close()


def test_more_poses_than_cells_is_an_error():
    world = world_of(size=1.0)
    with pytest.raises(WorldError, match="50 free poses"):
        world.free_poses(50, 0)
    world.close()


def test_a_house_without_a_free_cell_is_an_error():
    world = PyBulletWorld(solids_of=lambda _: [*shell(2.0), table("all", (1.0, 1.0), (0.9, 0.9), 1.0)])
    with pytest.raises(WorldError, match="no free cell"):
        world.reset(room_house(2.0), 0)
    with pytest.raises(WorldError, match="no house"):
        world.truth()
    world.close()
