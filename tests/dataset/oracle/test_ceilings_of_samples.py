"""The oracle in the shipped houses, with scenarios drawn as the benchmark draws them."""

from __future__ import annotations

import pytest

from adhoc.core.errors import ConfigurationError
from adhoc.dataset.oracle import ceiling
from adhoc.evaluation.ranges import Ranges
from adhoc.evaluation.referee import PlacementReferee
from adhoc.evaluation.sampling import sample_scenario
from adhoc.houses.samples import sample_house, sample_names
from adhoc.worlds.pybullet_world import PyBulletWorld

ABLE = Ranges(can_manipulate=1.0, payload=(20.0, 20.0), max_steps=(500, 500), heights=(1.6,))
"""Robots that can do everything: what they leave undone needs another reason."""


@pytest.fixture(scope="module")
def world():
    world = PyBulletWorld()
    yield world
    world.close()


@pytest.mark.parametrize("name", sample_names())
@pytest.mark.parametrize("seed", range(4))
def test_an_able_team_does_everything_that_can_be_seen(world, name, seed):
    task = draw(world, name, seed, ABLE)
    found = ceiling(world, task)
    if found.kind == "none":
        assert found.proven
        assert "can see it within reach" in found.reason
        return
    assert found.kind == "team"
    assert found.team_steps is not None
    assert found.joint_steps is not None
    assert found.least_steps is not None
    assert found.least_steps <= found.joint_steps <= found.team_steps <= 500
    assert len(PlacementReferee(world, task).replaced()) == len(task.misplaced)


@pytest.mark.parametrize("name", sample_names())
def test_batteries_hold_and_failures_are_explained(world, name):
    for seed in range(4, 8):
        task = draw(world, name, seed, Ranges())
        found = ceiling(world, task)
        robots = {member.name: member for member in (*task.team, task.newcomer)}
        for agent in world.agents().values():
            assert agent.steps_used <= robots[agent.id].capability.max_steps
        if found.kind == "none":
            assert found.proven or "batteries" in found.reason


def draw(world, name, seed, ranges):
    """A scenario with as many misplaced objects as the house has, at most five."""
    for count in (5, 4, 3, 2, 1):
        try:
            return sample_scenario(world, sample_house(name), seed, count, 3, ranges)
        except ConfigurationError:
            continue
    raise AssertionError(f"nothing can be misplaced in {name}")
