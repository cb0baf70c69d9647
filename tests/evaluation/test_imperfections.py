"""Broken, gone, tired and faulty robots in whole episodes, and how runs tell of them."""

from __future__ import annotations

from dataclasses import replace

import pytest
from grid_world import Errand, GridWorld, Script, fetch, scenario

from adhoc.agents.dialects.codes import Codes
from adhoc.agents.dialects.speaking import Speaking
from adhoc.agents.heuristic import HeuristicPolicy
from adhoc.agents.imperfect.mistaken import MistakenPolicy
from adhoc.agents.imperfect.untruthful import UntruthfulPolicy
from adhoc.core.errors import ConfigurationError, EpisodeError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName, Capability, Pose
from adhoc.evaluation.contender import Conditions, Contender
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.episode_key import EpisodeKey, EpisodeKind
from adhoc.evaluation.episode_result import Ending
from adhoc.evaluation.imperfections import PERFECT, Imperfections
from adhoc.evaluation.records import RecordFile
from adhoc.evaluation.sampling import sample_scenario
from adhoc.evaluation.scenario import Displacement, Member
from adhoc.experiments.comparison import Comparison, Entrant
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.run import run_comparison
from adhoc.houses.samples import sample_house
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.testing.world_contract import contract_house
from adhoc.worlds.pybullet_world import PyBulletWorld

TURN = Action(ActionName.ROTATE_LEFT)
STOP = Action(ActionName.STOP)


def run(team, newcomer=None, join_step=0, max_steps=20, world=None, **faults):
    return run_episode(
        world or GridWorld(),
        scenario(),
        Errand(),
        team,
        newcomer,
        join_step,
        max_steps,
        imperfections=Imperfections(**faults),
    )


def events(result):
    return [
        (it.step, it.agent, it.kind) for it in result.trace.events if it.kind not in ("joined", "replaced")
    ]


class TestBreakdown:
    def test_a_broken_robot_does_and_says_nothing_more_and_stays(self):
        team, newcomer = [Script(say="hi"), Script(say="ho")], Script(ask_at=6)
        result = run(team, newcomer, max_steps=9, breaks_down={0: 4})
        assert team[0].acted == [0, 1, 2, 3]
        assert result.agent_steps == {"teammate_1": 4, "teammate_2": 9, "newcomer": 9}
        assert [it.text for it in newcomer.answers] == ["teammate_2 agrees"]
        assert max(it.step for it in team[1].heard if it.sender == "teammate_1") == 3
        assert "teammate_1" in result.trace.steps[-1].poses
        assert result.trace.steps[-1].poses["teammate_1"] == result.trace.steps[4].poses["teammate_1"]
        assert (4, "teammate_1", "broke down") in events(result)
        assert (dict(result.broke_down), dict(result.left)) == ({"teammate_1": 4}, {})

    def test_it_keeps_what_it_holds(self):
        result = run([Script(fetch("apple", "counter")[0], TURN, TURN), Script()], breaks_down={0: 1})
        assert result.trace.objects_after["apple"].holder == "teammate_1"

    def test_it_is_in_the_way(self):
        ahead = [Action(ActionName.MOVE_AHEAD)] * 12
        result = run([Script(*ahead), Script()], max_steps=12, breaks_down={1: 0})
        assert result.trace.steps[-1].poses["teammate_1"].x == 1.5

    def test_when_all_are_broken_the_episode_is_over(self):
        result = run([Script(), Script()], breaks_down={0: 3, 1: 5})
        assert (result.ending, result.steps) == (Ending.STOPPED, 5)

    def test_a_stopped_robot_can_break_down_too(self):
        newcomer = Script(ask_at=6)
        run([Script(STOP), Script()], newcomer, breaks_down={0: 3})
        assert [it.text for it in newcomer.answers] == ["teammate_2 agrees"]


class TestLeaving:
    def test_a_robot_that_left_is_gone(self):
        team, newcomer = [Script(say="hi"), Script()], Script(ask_at=6)
        world = GridWorld()
        result = run(team, newcomer, max_steps=9, world=world, leaves={0: 4})
        assert team[0].acted == [0, 1, 2, 3]
        assert set(world.agents()) == {"teammate_2", "newcomer"}
        assert [it.text for it in newcomer.answers] == ["teammate_2 agrees"]
        assert result.agent_steps == {"teammate_1": 4, "teammate_2": 9, "newcomer": 9}
        assert "teammate_1" in result.trace.steps[3].poses
        assert "teammate_1" not in result.trace.steps[4].poses
        assert events(result) == [(4, "teammate_1", "left")]
        assert dict(result.left) == {"teammate_1": 4}

    def test_it_puts_down_what_it_holds_and_makes_way(self):
        ahead = [Action(ActionName.MOVE_AHEAD)] * 12
        team = [Script(*ahead), Script(fetch("apple", "counter")[0], TURN, TURN)]
        result = run(team, max_steps=12, leaves={1: 2})
        apple = result.trace.objects_after["apple"]
        assert (apple.holder, apple.receptacle, apple.position) == (None, "Floor", (2.0, 2.0, 0.05))
        assert (2, "teammate_2", "put down") in events(result)
        assert result.trace.steps[-1].poses["teammate_1"].x > 2.0

    def test_a_newcomer_can_join_later_and_at_that_step(self):
        for join_step in (4, 7):
            result = run([Script(), Script()], Script(), join_step, leaves={0: 4})
            assert result.joined

    def test_a_robot_can_break_down_and_be_taken_away(self):
        result = run([Script(), Script()], breaks_down={0: 3}, leaves={0: 6})
        assert events(result) == [(3, "teammate_1", "broke down"), (6, "teammate_1", "left")]
        result = run([Script(), Script()], breaks_down={0: 6}, leaves={0: 3})
        assert events(result) == [(3, "teammate_1", "left")]

    def test_at_the_very_beginning(self):
        result = run([Script(), Script()], max_steps=5, leaves={1: 0})
        assert result.agent_steps == {"teammate_1": 5, "teammate_2": 0}
        assert "teammate_2" not in result.trace.steps[0].poses

    def test_the_others_see_at_once_that_it_is_gone(self, house_world):
        class Watcher(Script):
            def reset(self, *arguments):
                super().reset(*arguments)
                self.saw = []

            def act(self, observation, inbox):
                self.saw.append("leaver" in {label.id for label in observation.labels.values()})
                return super().act(observation, inbox)

        house = contract_house()
        team = (
            Member("watcher", Capability(), Pose(1.0, 1.0)),
            Member("leaver", Capability(), Pose(2.0, 1.0)),
        )
        where = scenario(house=house, misplaced=(Displacement("apple", "Floor"),), team=team)
        watcher, rest = (
            Watcher(*[Action(ActionName.PUT_DOWN)] * 9),
            Script(*[Action(ActionName.PUT_DOWN)] * 9),
        )
        run_episode(
            house_world,
            where,
            Errand(),
            [watcher, rest],
            max_steps=6,
            imperfections=Imperfections(leaves={1: 4}),
        )
        assert watcher.saw == [True] * 4 + [False] * 2


class TestBattery:
    def test_only_the_display_tells(self):
        class Reader(Script):
            def reset(self, me, capability, *more):
                super().reset(me, capability, *more)
                self.told, self.read = capability.max_steps, []

            def act(self, observation, inbox):
                self.read.append(observation.steps_left)
                return super().act(observation, inbox)

        team = [Reader(), Reader()]
        result = run(team, max_steps=9, battery={0: 4, 1: 1000})
        assert [it.told for it in team] == [100, 100]
        assert [it.read[0] for it in team] == [4, 100]
        assert team[0].acted == [0, 1, 2, 3]
        assert events(result) == [(4, "teammate_1", "battery empty")]


class TestMinds:
    def test_faults_sit_below_the_dialect_and_silence_above(self):
        spoken = Speaking(Script(), Codes())
        faults = Imperfections(wrong={0: 0.5}, untruthful={0: 0.5, 1: 0.5}, silent=[2])
        first, second, third = (faults.mind(seat, spoken) for seat in range(3))
        assert isinstance(first, Speaking)
        assert isinstance(first.policy, UntruthfulPolicy)
        assert isinstance(first.policy.policy, MistakenPolicy)
        assert isinstance(second.policy.policy, Script)
        assert isinstance(third, Speaking)
        assert third.policy is spoken
        assert isinstance(spoken.policy, Script)
        assert faults.mind(3, spoken) is spoken

    def test_the_silent_work_and_talk_in_private(self):
        class Both(Script):
            def act(self, observation, inbox):
                turn = super().act(observation, inbox)
                return replace(turn, outbox=(*turn.outbox, Message(MessageKind.DETECTION, "look")))

        team, newcomer = [Both(say="psst"), Both(say="psst")], Script(ask_at=2)
        result = run(team, newcomer, max_steps=5, silent=[0])
        said = {(it.sender, it.kind.value) for it in result.trace.messages}
        assert said == {
            ("teammate_1", "team"),
            ("teammate_2", "team"),
            ("teammate_2", "detection"),
            ("teammate_2", "reply"),
            ("newcomer", "intention"),
        }
        assert team[0].acted == [0, 1, 2, 3, 4]


EVERYTHING = {
    "loss": 0.2,
    "jitter": 3,
    "range": 4.0,
    "silent": [1],
    "wrong": {0: 0.5},
    "untruthful": {0: 0.5},
    "battery": {1: 44},
    "breaks_down": {2: 18},
    "leaves": {0: 26},
}


@pytest.fixture(scope="module")
def house_world():
    world = PyBulletWorld(image_size=64)
    yield world
    world.close()


class TestSharedPast:
    @pytest.mark.parametrize("join_step", [18, 40])
    def test_an_imperfect_team_is_the_same_until_somebody_joins(self, house_world, join_step):
        where = sample_scenario(house_world, sample_house("four_rooms"), 3, teammates=3)

        def episode(newcomer=None, alone=None):
            return run_episode(
                house_world,
                where,
                TidyingUp(),
                [Speaking(HeuristicPolicy(), Codes()), HeuristicPolicy(), HeuristicPolicy()],
                newcomer,
                join_step,
                48,
                alone=alone,
                imperfections=Imperfections(**EVERYTHING),
            )

        alone = episode()
        joined = episode(HeuristicPolicy(member=False), alone.history)
        assert joined.joined
        assert joined.history[: join_step + 1] == alone.history[: join_step + 1]
        assert joined.history[-1] != alone.history[-1]
        assert min(vars(alone.deliveries).values()) > 0

    def test_another_fault_is_another_past(self):
        team = [Script(say="a"), Script(say="b")]
        perfect = run(team, max_steps=12)
        with pytest.raises(EpisodeError, match="at step 6,"):
            run_episode(
                GridWorld(),
                scenario(),
                Errand(),
                team,
                Script(),
                8,
                12,
                alone=perfect.history,
                imperfections=Imperfections(leaves={0: 6}),
            )


class TestSettings:
    def test_nothing_wrong_is_nothing_to_tell(self):
        assert (PERFECT.settings, PERFECT.summary) == ({}, "")
        nothing = Imperfections(0.0, 0, 0, None, [], {}, {}, {}, {}, {})
        assert nothing.settings == {}

    def test_what_is_wrong_is_told_in_one_way(self):
        text = Imperfections(loss=1, silent=[2, 0], wrong={"1": 1, 0: 0.5})
        assert text.settings == {"loss": 1.0, "silent": [0, 2], "wrong": {"0": 0.5, "1": 1.0}}
        assert text.summary == "loss 1.0, silent 0 2, wrong 0:0.5 1:1.0"

    def test_a_long_summary_is_cut_and_still_its_own(self):
        one, other = (Imperfections(**{**EVERYTHING, "loss": loss}).summary for loss in (0.1, 0.2))
        assert max(len(one), len(other)) <= 60
        assert one != other

    @pytest.mark.parametrize(
        ("faults", "told"),
        [
            ({"silent": 3}, "imperfections.silent=3: must be a list"),
            ({"silent": ["first"]}, "seats are numbers"),
            ({"silent": [-1]}, "seats are numbers"),
            ({"silent": [1, "1"]}, "twice"),
            ({"wrong": [0.5]}, "must have a value for each seat"),
            ({"wrong": {0: 1.5}}, "imperfections.wrong={0:1.5}: seat 0: 1.5 must be a probability"),
            ({"untruthful": {0: float("nan")}}, "probability"),
            ({"untruthful": {0: True}}, "probability"),
            (
                {"breaks_down": {0: -1}},
                "imperfections.breaks_down={0:-1}: seat 0: -1 must be a number of steps",
            ),
            ({"battery": {0: 1.5}}, "number of steps"),
            ({"leaves": {"a": 5}}, "imperfections.leaves={a:5}: seats are numbers"),
            ({"loss": 2.0}, "imperfections.loss=2.0: must be"),
            ({"range": -1.0}, "imperfections.range=-1.0: must be"),
        ],
    )
    def test_wrong_values_are_named(self, faults, told):
        with pytest.raises(ConfigurationError) as error:
            Imperfections(**faults)
        assert told in str(error.value)


TEAM = Contender("walkers", "Walkers", lambda seat: Script(), {"name": "walkers"})


class TestRuns:
    def test_without_imperfections_an_episode_is_known_as_before(self):
        """Folders of earlier versions must stay resumable: this hash was computed before there were any."""
        key = EpisodeKey(scenario(), EpisodeKind(Conditions(Errand(), TEAM, settings={"world": {"size": 1}})))
        assert key.kind.config_hash == "549d9290eb6ae4f4"
        assert key.id == "two_rooms-s0--walkers--alone"
        assert set(key.kind.settings) == {"max_steps", "failed_share", "team", "world"}

    def test_records_tell_and_folders_hold_several(self, tmp_path):
        folder = RunFolder(tmp_path)
        talkers = replace(TEAM, make=lambda seat: Script(say="hi"))
        for faults in ({}, {"loss": 0.5, "leaves": {0: 3}}, {"breaks_down": {"1": 4}}):
            conditions = Conditions(Errand(), talkers, max_steps=10, imperfections=Imperfections(**faults))
            helper = Contender("helper", "Helper", lambda seat: Script(say="hi"), {})
            comparison = Comparison(GridWorld(), [scenario()], conditions, (Entrant(helper, 5),))
            run_comparison(comparison, folder)
        records = RecordFile(tmp_path).read()
        assert len({it["config_hash"] for it in records}) == 6
        assert [it["team"] for it in records[::2]] == [
            "walkers",
            "walkers (loss 0.5, leaves 0:3)",
            "walkers (breaks down 1:4)",
        ]
        perfect, lossy, broken = records[1::2]
        assert perfect["imperfections"] is None
        assert perfect["deliveries"] == {"lost": 0, "out_of_range": 0, "delayed": 0}
        assert lossy["imperfections"] == {"loss": 0.5, "leaves": {"0": 3}}
        assert lossy["deliveries"]["lost"] > 0
        assert (lossy["left"], lossy["broke_down"]) == ({"teammate_1": 3}, {})
        assert (broken["left"], broken["broke_down"]) == ({}, {"teammate_2": 4})

    def test_a_capability_of_the_scenario_is_not_changed(self):
        """Scenario hashes tell what was drawn, not what went wrong."""
        where = scenario()
        weak = Imperfections(battery={0: 3}).batteries(where)
        assert weak.team[0].capability == Capability(max_steps=3)
        assert weak.team[1:] == where.team[1:]
        assert where.team[0].pose == Pose(1.0, 2.0)
        assert PERFECT.batteries(where) is where
