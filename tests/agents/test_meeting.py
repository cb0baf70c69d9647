"""Two robots that meet in a doorway get past each other."""

from __future__ import annotations

import math

import pytest

from adhoc.agents.body import Body, SkillOutcome
from adhoc.agents.memory import Memory
from adhoc.core.calls import Call
from adhoc.core.values import Action, Capability, Pose
from adhoc.houses.samples import sample_house
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.worlds.pybullet_world import PyBulletWorld


@pytest.fixture(scope="module")
def world():
    world = PyBulletWorld()
    yield world
    world.close()


class Walker:
    """Looks around, then walks to a point and stays there."""

    def __init__(self, name: str, dx: float) -> None:
        self.memory = Memory(name, TidyingUp())
        self.body = Body(self.memory, Capability())
        self.call = Call("GoToPoint", (dx, 0.0))
        self.outcome: SkillOutcome | None = None

    def act(self, observation) -> Action | None:
        self.memory.observe(observation)
        if self.outcome is not None:
            return None
        if self.body.call is None:
            self.body.begin(self.call, observation)
        step = self.body.act(observation)
        if isinstance(step, Action):
            return step
        self.outcome = step
        return None


@pytest.mark.parametrize("names", [("teammate_1", "teammate_2"), ("teammate_3", "newcomer"), ("a", "b")])
def test_they_pass_each_other_in_the_door(world, names):
    """The corridor joins the rooms of the sample by doors of a metre; they start on both sides of one."""
    world.reset(sample_house("corridor"), 0)
    walkers = {names[0]: Walker(names[0], 3.0), names[1]: Walker(names[1], -3.0)}
    starts = (Pose(4.0, 2.5, 0.0, math.pi / 6), Pose(6.0, 2.5, math.pi, math.pi / 6))
    seen = {
        name: world.add_agent(name, Capability(), pose) for name, pose in zip(walkers, starts, strict=True)
    }
    for _ in range(120):
        acts = {name: walker.act(seen[name]) for name, walker in walkers.items()}
        seen |= world.step({name: action for name, action in acts.items() if action is not None})
        if all(walker.outcome is not None for walker in walkers.values()):
            break
    assert [walker.outcome and walker.outcome.failure for walker in walkers.values()] == [None, None]
    assert seen[names[0]].pose.x > 6 > 4 > seen[names[1]].pose.x
