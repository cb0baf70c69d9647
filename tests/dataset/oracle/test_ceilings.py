"""The oracle in tiny houses with answers that are counted by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from oracle_houses import AWAY, StillWorld, counter, idle, kitchen, on_floor, robot, scenario, two_rooms

from adhoc.core.errors import ConfigurationError
from adhoc.core.values import Pose
from adhoc.dataset.oracle import Rules, ceiling
from adhoc.evaluation.referee import PlacementReferee

NEWCOMER = idle("newcomer", AWAY.x, AWAY.y)

EIGHT = 8
"""Steps of `simple`: one tilt down and the pick-up, since the floor within reach is below the level picture;
four moves to y = 2, from where the counter's front at y = 3.4 is within 1.5 m; one turn towards it, or one
more tilt, and the put-down."""
SIX = 6
"""The same without turning and tilting."""


@pytest.fixture(scope="module")
def world():
    world = StillWorld()
    yield world
    world.close()


def simple(newcomer=NEWCOMER, **abilities):
    house = kitchen(on_floor("apple", 2.25, 1.0), counter(2.0, 3.7))
    return scenario(house, ["apple"], [robot("worker", 1.0, 1.0, **abilities)], newcomer)


def test_one_robot_and_one_object_take_the_steps_that_are_counted_by_hand(world):
    found = ceiling(world, simple())
    assert (found.kind, found.team_steps, found.joint_steps, found.least_steps) == ("team", EIGHT, EIGHT, SIX)
    assert (found.reason, found.team_reason, found.proven) == ("", "", True)


def test_the_referee_sees_the_object_in_place_in_the_world_that_is_left_behind(world):
    task = simple()
    ceiling(world, task)
    assert PlacementReferee(world, task).replaced() == ("apple",)
    assert world.truth()["apple"].receptacle == "counter"
    assert world.agents()["worker"].steps_used == EIGHT


def test_a_battery_of_exactly_the_steps_is_enough_and_one_less_is_not(world):
    assert ceiling(world, simple(max_steps=EIGHT)).team_steps == EIGHT
    short = ceiling(world, simple(max_steps=EIGHT - 1))
    assert (short.kind, short.team_steps, short.joint_steps, short.proven) == ("none", None, None, False)
    assert short.reason == "not solved by the oracle: the batteries, or the steps, do not last"


def test_the_step_limit_binds_like_a_battery(world):
    assert ceiling(world, simple(), max_steps=EIGHT).kind == "team"
    assert ceiling(world, simple(), max_steps=EIGHT - 1).kind == "none"


def test_what_nobody_can_lift_is_proven_to_be_impossible(world):
    found = ceiling(world, simple(payload=0.01))
    assert (found.kind, found.proven, found.reason) == ("none", True, "no robot can carry apple")


def test_robots_without_a_hand_carry_nothing(world):
    assert ceiling(world, simple(can_manipulate=False)).reason == "no robot can carry apple"


def test_a_newcomer_that_can_lift_it_makes_the_difference(world):
    found = ceiling(world, simple(newcomer=robot("newcomer", 1.0, 3.0), payload=0.01))
    assert (found.kind, found.team_steps, found.proven) == ("newcomer", None, True)
    assert found.joint_steps is not None
    assert found.team_reason == "no robot of the team can carry apple"


def test_masses_are_scaled_as_in_the_world():
    world = StillWorld(mass_scale=101.0)
    assert ceiling(world, simple(), rules=Rules(mass_scale=101.0)).reason == "no robot can carry apple"
    assert ceiling(world, simple(payload=1000.0), rules=Rules(mass_scale=101.0)).team_steps == EIGHT
    world.close()


def test_two_robots_share_two_objects_and_work_at_the_same_time(world):
    house = kitchen(
        on_floor("apple", 2.25, 1.0), on_floor("egg", 6.25, 1.0, "Egg"), counter(4.0, 3.7, 7.0), size=8.0
    )
    team = [robot("left", 1.0, 1.0), robot("right", 5.0, 1.0)]
    task = scenario(house, ["apple", "egg"], team, idle("newcomer", 0.5, 7.0))
    assert ceiling(world, task).team_steps == EIGHT
    alone = replace(task, team=(team[0],), newcomer=idle("newcomer", 0.5, 7.0))
    steps = ceiling(world, alone).team_steps
    assert steps is not None
    assert steps > 2 * EIGHT


def test_an_idle_robot_in_the_passage_steps_aside(world):
    house = two_rooms(on_floor("apple", 6.5, 1.25, room="east"), counter(1.5, 2.65, room="west"))
    task = scenario(
        house,
        ["apple"],
        [robot("worker", 1.5, 1.25), idle("idler", 4.0, 1.25)],
        idle("newcomer", 7.5, 2.5),
    )
    found = ceiling(world, task)
    assert found.kind == "team"
    assert world.agents()["idler"].pose != task.team[1].pose
    free = replace(task, team=(task.team[0], replace(task.team[1], pose=Pose(7.5, 0.5))))
    assert ceiling(world, free).team_steps == found.team_steps


def test_a_robot_that_cannot_move_in_the_passage_ends_it(world):
    house = two_rooms(on_floor("apple", 6.5, 1.25, room="east"), counter(1.5, 2.65, room="west"))
    stuck = idle("stuck", 4.0, 1.25, can_navigate=False)
    task = scenario(house, ["apple"], [robot("worker", 1.5, 1.25), stuck], idle("newcomer", 7.5, 2.5))
    found = ceiling(world, task)
    assert (found.kind, found.proven) == ("none", False)
    assert "no robot gets to apple" in found.reason


def test_an_object_in_the_passage_is_cleared_first(world):
    house = two_rooms(
        on_floor("apple", 6.5, 1.25, room="east"),
        on_floor("egg", 4.0, 1.375, "Egg", room="passage"),
        counter(1.5, 2.65, room="west"),
    )
    task = scenario(house, ["apple", "egg"], [robot("worker", 1.5, 1.25)], idle("newcomer", 0.5, 0.5))
    found = ceiling(world, task)
    assert found.kind == "team"


def test_two_robots_pass_each_other_through_the_passage(world):
    house = two_rooms(
        on_floor("apple", 6.5, 1.25, room="east"),
        on_floor("egg", 0.75, 0.5, "Egg", room="west"),
        counter(1.5, 2.65, room="west"),
    )
    team = [robot("worker", 6.5, 2.25), robot("other", 2.0, 1.25, payload=0.12)]
    found = ceiling(world, scenario(house, ["apple", "egg"], team, idle("newcomer", 7.5, 0.5)))
    assert found.kind == "team"


def test_a_newcomer_that_helps_makes_it_faster(world):
    house = kitchen(
        on_floor("apple", 2.25, 1.0), on_floor("egg", 6.25, 1.0, "Egg"), counter(4.0, 3.7, 7.0), size=8.0
    )
    task = scenario(house, ["apple", "egg"], [robot("left", 1.0, 1.0)], robot("newcomer", 5.0, 1.0))
    found = ceiling(world, task)
    assert found.joint_steps == EIGHT
    assert found.team_steps is not None
    assert found.team_steps > EIGHT


def test_equal_tasks_have_equal_ceilings_in_any_world(world):
    task = simple(newcomer=robot("newcomer", 1.0, 3.0))
    other = StillWorld()
    first = ceiling(world, task)
    print_before = world.fingerprint()
    assert ceiling(other, task) == first
    assert other.fingerprint() == print_before
    assert ceiling(world, task) == first
    other.close()


def test_a_robot_off_the_lattice_is_an_error(world):
    task = simple()
    askew = replace(task, team=(replace(task.team[0], pose=Pose(1.1, 1.0)),))
    with pytest.raises(ConfigurationError, match=r"'worker'.*not on the lattice"):
        ceiling(world, askew)
    turned = replace(task, team=(replace(task.team[0], pose=Pose(1.0, 1.0, math.pi / 4)),))
    with pytest.raises(ConfigurationError, match="not on the lattice"):
        ceiling(world, turned)


def test_nothing_is_planned_to_where_nothing_belongs(world):
    task = scenario(kitchen(on_floor("apple", 2.25, 1.0)), ["apple"], [robot("worker", 1.0, 1.0)], NEWCOMER)
    found = ceiling(world, task)
    assert (found.kind, found.least_steps) == ("none", None)
    assert "no right place with room for apple" in found.reason
