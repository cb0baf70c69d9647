"""The expert of the learned team: what is right, by metadata and by what the robot knows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from learned_situations import FRIEND, MUG, situation

from adhoc.agents.learned.decision import KINDS, SubSkillKind
from adhoc.agents.learned.features import encode
from adhoc.core.values import Capability
from adhoc.evaluation.sampling import sample_scenario
from adhoc.evaluation.scenario import prepare
from adhoc.houses.samples import sample_house
from adhoc.training.expert import Demonstrator, Expert
from adhoc.worlds.pybullet_world import PyBulletWorld

EXPLORE, PICK, PUT, STOP = SubSkillKind
NO_HAND = Capability(can_manipulate=False)


@pytest.fixture(scope="module")
def world():
    made = PyBulletWorld(image_size=64)
    yield made
    made.close()


@pytest.fixture(scope="module")
def scenario(world):
    made = sample_scenario(world, sample_house("one_room"), 0, misplaced=2, teammates=3)
    prepare(world, made)
    return made


@pytest.fixture
def wrong(scenario):
    """A detection of an object that is truly misplaced."""
    return replace(MUG, id=scenario.misplaced[0].object_id)


@pytest.fixture
def expert(world, scenario):
    return Expert(world, scenario)


def test_what_is_held_is_put_where_a_place_is_known(expert):
    assert expert(situation(holding=True, place_known=True)) is PUT
    assert expert(situation(holding=True)) is EXPLORE
    assert expert(situation(holding=True, idle=True)) is EXPLORE


def test_the_closest_able_and_free_robot_takes_a_misplaced_object(expert, wrong):
    near, far = FRIEND, replace(FRIEND, position=(1.0, 9.0))
    assert expert(situation([wrong])) is PICK
    assert expert(situation([wrong], [near])) is EXPLORE
    assert expert(situation([wrong], [far])) is PICK
    assert expert(situation([wrong], [replace(near, busy=True)])) is PICK
    assert expert(situation([wrong], [replace(near, capability=NO_HAND)])) is PICK
    assert expert(situation([wrong], capability=NO_HAND)) is EXPLORE


@pytest.mark.parametrize("change", [{"handled": True}, {"given_up": True}, {"mass": 11.0}])
def test_what_is_not_for_this_robot_is_passed_by(expert, wrong, change):
    assert expert(situation([replace(wrong, **change)])) is EXPLORE


def test_a_false_alarm_is_passed_by(expert):
    assert expert(situation([MUG])) is EXPLORE


def test_a_robot_stops_when_it_can_be_of_no_use_any_more(expert, wrong):
    at_work, done = FRIEND, replace(FRIEND, idle=True)
    assert expert(situation(others=[done], idle=True)) is STOP
    assert expert(situation(others=[at_work], idle=True)) is EXPLORE
    assert expert(situation(others=[at_work], idle=True, capability=NO_HAND)) is STOP
    assert expert(situation([replace(wrong, given_up=True)], [done], idle=True)) is EXPLORE


def test_strays_are_done_and_the_right_thing_is_taken_down(expert, wrong):
    picking = situation([wrong])
    steady = Demonstrator(expert, 0.0, np.random.default_rng(0))
    assert [steady.decide(picking) for _ in range(20)] == [PICK] * 20
    straying = Demonstrator(expert, 0.9, np.random.default_rng(0))
    done = {straying.decide(picking) for _ in range(40)}
    assert done == {EXPLORE, PICK}
    assert straying.labels == [KINDS.index(PICK)] * 40
    assert straying.rows[0].tolist() == encode(picking).tolist()
