"""Robots that must give way to each other, and plans that the world carries out as they were made."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from oracle_houses import StillWorld, counter, idle, kitchen, on_floor, robot, scenario, two_rooms

from adhoc.dataset.oracle.execution import Run, situation_now
from adhoc.dataset.oracle.fields import FAR, cell_field
from adhoc.dataset.oracle.knowledge import PYBULLET, HouseKnowledge
from adhoc.dataset.oracle.lattice import Lattice
from adhoc.dataset.oracle.plans import Plan, Planner
from adhoc.dataset.oracle.stances import AIMS
from adhoc.evaluation.ranges import Ranges
from adhoc.evaluation.sampling import sample_scenario
from adhoc.evaluation.scenario import prepare
from adhoc.houses.samples import sample_house
from adhoc.worlds.pybullet_world import PyBulletWorld

BYSTANDER = idle("newcomer", 0.5, 0.5)


@pytest.fixture(scope="module")
def world():
    world = StillWorld()
    yield world
    world.close()


def run_of(world, task):
    prepare(world, task)
    house = HouseKnowledge(task.house)
    planner = Planner(
        situation_now(world, house, task.team, [it.object_id for it in task.misplaced], PYBULLET)
    )
    return Run(world, task, house, task.team, 500, PYBULLET, planner)


def behind_the_passage(team):
    house = two_rooms(on_floor("apple", 6.5, 1.25, room="east"), counter(1.5, 2.65, room="west"))
    return scenario(house, ["apple"], team, BYSTANDER)


WORKER = robot("worker", 1.5, 1.25)


@pytest.mark.parametrize("x", [3.5, 4.0, 4.5, 5.0])
def test_one_plan_is_enough_to_get_an_idle_robot_out_of_the_passage(world, x):
    outcome = run_of(world, behind_the_passage([WORKER, idle("idler", x, 1.25)])).execute()
    assert (outcome.steps, outcome.plans) == (25, 1)


def test_two_idle_robots_clear_the_passage(world):
    team = [WORKER, idle("first", 3.5, 1.25), idle("second", 4.5, 1.25)]
    outcome = run_of(world, behind_the_passage(team)).execute()
    assert (outcome.steps, outcome.plans) == (25, 1)


def test_an_idle_robot_without_the_battery_to_clear_the_passage_ends_it(world):
    outcome = run_of(world, behind_the_passage([WORKER, idle("idler", 4.0, 1.25, max_steps=2)])).execute()
    assert outcome.steps is None
    assert outcome.reason == "the robots are in each other's way"


def test_robots_with_errands_on_either_side_pass_through_one_after_the_other(world):
    house = two_rooms(
        on_floor("apple", 6.5, 0.5, room="east"),
        on_floor("egg", 1.0, 0.5, "Egg", room="west"),
        counter(1.5, 2.65, room="west"),
        counter(6.5, 2.65, room="east", name="eastern"),
    )
    team = [robot("big", 1.5, 1.25), robot("small", 6.0, 1.25, payload=0.1)]
    run = run_of(world, scenario(house, ["apple", "egg"], team, BYSTANDER))
    assert run.execute().plans == 1


def test_a_robot_waits_until_another_has_opened_the_way(world):
    house = two_rooms(
        on_floor("apple", 6.5, 0.5, room="east"),
        on_floor("egg", 4.0, 1.375, "Egg", room="passage"),
        counter(6.5, 2.65, room="east"),
    )
    team = [robot("opener", 7.5, 0.5, payload=0.1), robot("runner", 2.5, 1.25)]
    task = scenario(house, ["apple", "egg"], team, BYSTANDER)
    outcome = run_of(world, task).execute()
    assert (outcome.reason, outcome.plans) == ("", 1)


@pytest.mark.parametrize("name", ["one_room", "corridor", "four_rooms"])
@pytest.mark.parametrize("seed", range(3))
def test_no_two_robots_ever_meet_in_a_plan(name, seed):
    world = PyBulletWorld()
    task = sample_scenario(world, sample_house(name), seed, 3, 5, Ranges(can_manipulate=0.8))
    run = run_of(world, task)
    assert run.first is not None
    plan = run.first.plan(run._workers(run.first.situation), 500)
    if isinstance(plan, Plan):
        lattice = run.first.situation.lattice
        for first, second in combinations(plan.routes.values(), 2):
            for time in range(plan.steps + 1):
                for later in (time, min(time + 1, plan.steps)):
                    assert not touch(lattice, first.stances[time], second.stances[later])
                    assert not touch(lattice, first.stances[later], second.stances[time])
    world.close()


def touch(lattice: Lattice, first: int, second: int) -> bool:
    return bool((lattice.near[first // AIMS] == second // AIMS).any())


def test_nobody_hides_an_object_from_the_robot_that_picks_it_up(world):
    house = kitchen(on_floor("apple", 3.0, 1.0), counter(2.0, 3.7))
    between = idle("between", 2.25, 1.0)
    task = scenario(house, ["apple"], [robot("worker", 1.0, 1.0), between], idle("newcomer", 0.5, 3.5))
    assert run_of(world, task).execute().plans == 1


def test_nothing_is_dropped_where_it_shuts_robots_in(world):
    house = two_rooms(on_floor("box", 3.4, 1.375, "Box", room="passage"), kind="LivingRoom")
    team = [robot("worker", 2.5, 1.25), idle("idler", 7.0, 1.0)]
    run = run_of(world, scenario(house, ["box"], team, BYSTANDER))
    outcome = run.execute()
    assert outcome.steps is not None
    lattice = situation_now(world, run.house, run.members, [], PYBULLET).lattice
    costs = np.full(len(lattice), FAR, np.int32)
    costs[0] = 0
    reached, _ = cell_field(lattice.moves(()), costs, np.zeros(len(lattice), np.int32))
    assert (reached < FAR).sum() >= len(lattice) - 4
