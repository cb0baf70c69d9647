"""A task of one's own, declared through the public API alone, is run in an episode."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from adhoc import (
    Capability,
    HeuristicPolicy,
    LLMAgent,
    LLMGenerator,
    LLMSubSkillPlanner,
    Member,
    OfflineReasoner,
    PyBulletWorld,
    Referee,
    Scenario,
    StagedPlanner,
    placement_table,
    run_episode,
    sample_house,
)
from adhoc.planning.evaluate import LLMEvaluator
from adhoc.planning.reflect import LLMReflector

sys.path.insert(0, str(Path(__file__).parents[1] / "examples"))

from inventory_task import CAMERA_ROBOT, Inventory, inventory_skills


@pytest.fixture(scope="module")
def world():
    world = PyBulletWorld()
    yield world
    world.close()


def scenario(world) -> Scenario:
    house = sample_house("one_room")
    world.reset(house, 0)
    first, second = world.free_poses(2, seed=3)
    member = Member("photographer", Capability(can_manipulate=False, max_steps=120), first)
    newcomer = Member("newcomer", CAMERA_ROBOT, second)
    return Scenario("inventory", house, (), (member,), newcomer, seed=0, difficulty="Easy")


class PhotographsTaken(Referee):
    """Watches the televisions of a house."""

    def __init__(self, task: Inventory, scenario: Scenario) -> None:
        self._task = task
        self.televisions = tuple(it.id for it in scenario.house.objects if it.category == task.category)

    @property
    def watched(self) -> tuple[str, ...]:
        return self.televisions

    def replaced(self) -> tuple[str, ...]:
        return tuple(name for name in self.televisions if name in self._task.photographed)


def referee_of(task: Inventory):
    return lambda world, scenario: PhotographsTaken(task, scenario)


def llm_agent(task: Inventory) -> LLMAgent:
    model = OfflineReasoner(placement_table())
    planner = StagedPlanner(LLMGenerator(model), LLMEvaluator(model), LLMReflector(model), task.legal)
    return LLMAgent(planner, LLMSubSkillPlanner(model), skills=inventory_skills(task))


def test_rule_based_robots_do_the_new_task(world):
    task = Inventory()
    robot = HeuristicPolicy(skills=inventory_skills(task))
    result = run_episode(world, scenario(world), task, [robot], max_steps=120, referee=referee_of(task))
    assert result.success
    assert task.photographed == {"Television|2|0"}


def test_a_planning_robot_does_the_new_task_and_the_new_sub_skill(world):
    task = Inventory()
    result = run_episode(
        world,
        scenario(world),
        task,
        [HeuristicPolicy(skills=inventory_skills(Inventory(category="Nothing")))],
        llm_agent(task),
        join_step=2,
        max_steps=120,
        referee=referee_of(task),
    )
    assert result.joined
    assert result.success
    assert task.photographed == {"Television|2|0"}
