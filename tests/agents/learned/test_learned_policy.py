"""The learned robot: it does what is chosen, by rule, and talks with its team."""

from __future__ import annotations

from dataclasses import replace

import pytest

from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.learned.checkpoint import digest_of
from adhoc.agents.learned.decision import SubSkillKind
from adhoc.agents.learned.policy import LearnedPolicy
from adhoc.agents.learned.shipped import SHIPPED
from adhoc.agents.plastic.plastic_policy import PlasticPolicy
from adhoc.agents.roster import MemberState, Roster
from adhoc.core.messages import MessageKind
from adhoc.core.values import ActionName, Capability
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.episode_result import Ending
from adhoc.evaluation.sampling import sample_scenario
from adhoc.evaluation.scenario import prepare
from adhoc.houses.samples import sample_house
from adhoc.tasks.placement import PlacementCommonSense
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.testing.policy_contract import PolicyContract
from adhoc.worlds.pybullet_world import PyBulletWorld

EXPLORE, PICK, PUT, STOP = SubSkillKind


class TestLearnedPolicy(PolicyContract):
    make = LearnedPolicy


@pytest.fixture
def world():
    made = PyBulletWorld(image_size=64)
    yield made
    made.close()


@pytest.fixture(scope="module")
def scenario():
    world = PyBulletWorld(image_size=64)
    made = sample_scenario(world, sample_house("one_room"), 0, misplaced=2, teammates=3)
    world.close()
    return made


class Alone:
    """A robot alone in the sample house of one room, whose choices a script makes."""

    def __init__(self, world, decide, capability=Capability()):  # noqa: B008
        world.reset(sample_house("one_room"), 0)
        self.world, self.decide, self.seen = world, decide, []
        self.robot = LearnedPolicy(self._choose)
        self.robot.reset("robot", capability, TidyingUp(), 0, lambda message: ())
        self.observation = world.add_agent("robot", capability, world.free_poses(1, 5)[0])

    def _choose(self, situation):
        self.seen.append(situation)
        return self.decide(situation)

    def act(self, inbox=()):
        turn = self.robot.act(self.observation, inbox)
        self.observation = self.world.step({"robot": turn.action})["robot"]
        return turn


def test_a_team_that_always_chooses_rightly_re_places_everything(world, scenario):
    def sensible(situation):
        own = situation.own
        if own.holding:
            return PUT
        return PICK if any(not it.handled for it in situation.detections) else EXPLORE

    team = [LearnedPolicy(sensible) for _ in scenario.team]
    assert run_episode(world, scenario, TidyingUp(), team, max_steps=200).ending is Ending.REPLACED


def test_the_shipped_team_re_places_everything(world, scenario):
    team = [LearnedPolicy() for _ in scenario.team]
    assert run_episode(world, scenario, TidyingUp(), team, max_steps=200).ending is Ending.REPLACED


def test_a_listening_newcomer_changes_nothing_of_the_past(world, scenario):
    def team():
        return [LearnedPolicy() for _ in scenario.team]

    alone = run_episode(world, scenario, TidyingUp(), team(), max_steps=30).history
    joined = run_episode(world, scenario, TidyingUp(), team(), HeuristicPolicy(False), 12, 20, alone=alone)
    assert joined.history[:12] == alone[:12]
    assert joined.joined


class Opinion(PlacementCommonSense):
    """The table with a fingerprint."""

    def __init__(self, fingerprint):
        self._fingerprint = fingerprint

    @property
    def fingerprint(self):
        return self._fingerprint


def test_the_fingerprint_is_of_the_checkpoints_and_of_a_given_judge():
    shipped = digest_of(SHIPPED)
    assert LearnedPolicy().fingerprint == shipped
    assert LearnedPolicy(decide=lambda situation: STOP).fingerprint == shipped
    assert LearnedPolicy(common_sense=PlacementCommonSense()).fingerprint == shipped
    assert LearnedPolicy(common_sense=Opinion("one")).fingerprint == f"{shipped}one"
    alone = LearnedPolicy(lambda situation: STOP, Opinion("two"))
    assert alone.fingerprint == "two"
    beside = PlasticPolicy(common_sense=Opinion("three")).fingerprint
    assert beside != PlasticPolicy(common_sense=Opinion("four")).fingerprint


def test_stop_is_chosen_and_said(world):
    alone = Alone(world, lambda situation: STOP)
    turn = alone.act()
    assert turn.action.name is ActionName.STOP
    assert {it.kind: it.payload["stopped"] for it in turn.outbox}[MessageKind.TEAM] is True
    assert alone.act().action.name is ActionName.STOP
    assert len(alone.seen) == 1


def test_pick_up_without_a_misplaced_object_explores(world):
    alone = Alone(world, lambda situation: PICK)
    alone.act()
    assert alone.robot._execution.exploring


def test_put_without_a_place_explores(world, scenario):
    alone = Alone(world, lambda situation: PUT)
    alone.act()
    assert alone.robot._execution.exploring


def test_a_robot_with_nothing_left_to_explore_looks_around_and_chooses_now_and_then(world):
    alone = Alone(world, lambda situation: EXPLORE, Capability(can_manipulate=False))
    while not alone.robot._execution.idle:
        alone.act()
    before = len(alone.seen)
    turns = [alone.act().action.name for _ in range(40)]
    assert set(turns) == {ActionName.ROTATE_RIGHT}
    assert 3 <= len(alone.seen) - before <= 8
    assert alone.seen[-1].own.idle


def test_the_team_hears_at_every_step_what_the_heuristic_team_says(world):
    alone = Alone(world, lambda situation: EXPLORE)
    roster = Roster()
    for step in range(3):
        (said,) = [it for it in alone.act().outbox if it.kind is MessageKind.TEAM]
        (state,) = roster.hear(step, [said])
        assert state.capability == Capability()


def test_an_object_that_a_nearer_member_is_after_is_left_to_it(world, scenario):
    prepare(world, scenario)
    name = scenario.team[0].name
    robot = LearnedPolicy(lambda situation: PICK if situation.detections else EXPLORE)
    capability = Capability()
    robot.reset(name, capability, TidyingUp(), 0, lambda message: ())
    observation = world.observe(name)
    for _ in range(150):
        turn = robot.act(observation, ())
        if robot._execution.object_id is not None:
            break
        observation = world.step({name: turn.action})[name]
    target = robot._execution.object_id
    assert target is not None
    record = robot._memory.record(target)
    said = MemberState("zoe", record.position[:2], capability, busy=target).message()
    observation = world.step({name: turn.action})[name]
    robot.act(observation, [replace(said, sender="zoe", step=observation.step - 1)])
    assert robot._execution.object_id != target
    assert target in robot._awareness.handled()
