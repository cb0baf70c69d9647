from __future__ import annotations

from functools import partial

import pytest
from grid_world import Errand, GridWorld, Script, fetch, scenario

from adhoc.agents.policy import Turn
from adhoc.core.errors import ConfigurationError, EpisodeError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName, Capability, Pose
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.episode_result import Ending
from adhoc.evaluation.referee import PlacementReferee
from adhoc.evaluation.scenario import Member

TURN = Action(ActionName.ROTATE_LEFT)
STOP = Action(ActionName.STOP)


def run(team, newcomer=None, world=None, where=None, **options):
    return run_episode(world or GridWorld(), where or scenario(), Errand(), team, newcomer, **options)


@pytest.mark.parametrize("turn", [None, "left", Turn("left"), TURN])
def test_what_is_no_turn_is_told(turn):
    class Careless(Script):
        def act(self, observation, inbox):
            return turn

    with pytest.raises(EpisodeError, match=r"teammate_1: act\(\) must return a Turn with an Action, not "):
        run([Careless(), Script()])


class TestEnding:
    def test_success_ends_the_episode_at_the_step_after_the_last_object_is_placed(self):
        team = [Script(*fetch("apple", "counter"), *[TURN] * 9), Script(TURN, *fetch("knife", "counter"))]
        result = run(team)
        assert result.ending is Ending.REPLACED
        assert result.success
        assert result.steps == 3
        assert set(result.replaced) == {"apple", "knife"}
        assert result.agent_steps == {"teammate_1": 3, "teammate_2": 3}

    def test_an_object_in_the_hand_is_not_replaced(self):
        result = run([Script(fetch("apple", "counter")[0], STOP), Script(STOP)])
        assert result.ending is Ending.STOPPED
        assert result.replaced == ()

    def test_an_unreasonable_place_does_not_count(self):
        result = run([Script(*fetch("apple", "bed"), STOP), Script(STOP)])
        assert result.replaced == ()

    def test_partial_success(self):
        result = run([Script(*fetch("apple", "counter"), STOP), Script(STOP)])
        assert result.replaced == ("apple",)
        assert result.steps == 3

    def test_stopped_robots_do_nothing_more(self):
        team = [Script(STOP), Script(*[TURN] * 5, STOP)]
        result = run(team)
        assert result.ending is Ending.STOPPED
        assert result.agent_steps == {"teammate_1": 1, "teammate_2": 6}
        assert team[0].acted == [0]

    def test_empty_batteries_end_the_episode(self):
        tired = tuple(
            Member(name, Capability(max_steps=4), Pose(x, 2.0)) for name, x in (("a", 1.0), ("b", 2.0))
        )
        result = run([Script(), Script()], where=scenario(team=tired))
        assert result.ending is Ending.STOPPED
        assert result.agent_steps == {"a": 4, "b": 4}
        assert [event.kind for event in result.trace.events] == ["battery empty"] * 2

    def test_the_step_limit(self):
        result = run([Script(), Script()], max_steps=7)
        assert (result.ending, result.steps) == (Ending.MAX_STEPS, 7)
        assert len(result.history) == 8
        assert len(result.trace.steps) == 8

    def test_another_rule_of_the_referee(self):
        result = run(
            [Script(*fetch("apple", "bed"), STOP), Script(*fetch("knife", "bed"), STOP)],
            referee=partial(
                PlacementReferee,
                rule=lambda truth, room_type: room_type == "Bedroom" and truth.category == "Apple",
            ),
        )
        assert result.replaced == ("apple",)


class TestJoining:
    def test_the_newcomer_acts_last_from_its_joining_step(self):
        team, newcomer = [Script(), Script()], Script()
        result = run(team, newcomer, join_step=4, max_steps=9)
        assert newcomer.acted == [4, 5, 6, 7, 8]
        assert result.joined
        assert result.joined_at == Pose(6.0, 2.0)
        assert result.agent_steps == {"teammate_1": 9, "teammate_2": 9, "newcomer": 5}
        assert result.trace.agents[-1] == "newcomer"
        assert "newcomer" not in result.trace.steps[4].poses
        assert "newcomer" in result.trace.steps[5].poses

    def test_a_newcomer_too_late_never_joins(self):
        result = run([Script(*[TURN] * 3, STOP), Script(STOP)], Script(), join_step=8)
        assert not result.joined
        assert result.joined_at is None
        assert result.steps == 4
        assert "newcomer" not in result.agent_steps

    def test_an_occupied_pose_is_left_for_the_nearest_free_one(self):
        taken = scenario(newcomer=Member("newcomer", Capability(), Pose(1.0, 2.0)))
        result = run([Script(*[TURN] * 9), Script(*[TURN] * 9)], Script(), where=taken, max_steps=5)
        assert result.moved
        assert result.joined_at == Pose(1.5, 2.0) or result.joined_at == Pose(1.0, 2.5)
        again = run([Script(*[TURN] * 9), Script(*[TURN] * 9)], Script(), where=taken, max_steps=5)
        assert again.joined_at == result.joined_at

    @pytest.mark.parametrize("join_step", [-1, 20, 21])
    def test_an_impossible_joining_step_is_refused(self, join_step):
        with pytest.raises(ConfigurationError, match=f"join_step={join_step}"):
            run([Script(), Script()], Script(), join_step=join_step, max_steps=20)

    def test_a_wrong_number_of_policies_is_refused(self):
        with pytest.raises(ConfigurationError, match="2 teammates, not 1"):
            run([Script()])


class TestSharedPast:
    def test_team_alone_and_with_newcomer_are_equal_up_to_the_joining_step(self):
        alone = run([Script(say="hi"), Script()], max_steps=30)
        joined = run([Script(say="hi"), Script()], Script(), join_step=12, max_steps=30, alone=alone.history)
        assert joined.history[:13] == alone.history[:13]
        assert joined.history_hash == alone.history[12]
        assert joined.history[13] != alone.history[13]

    def test_a_disturbance_of_a_billionth_of_a_metre_is_caught(self):
        world = GridWorld(disturb_step=5)
        alone = run([Script(), Script()], world=world, max_steps=30)
        with pytest.raises(EpisodeError, match="at step 5"):
            run([Script(), Script()], Script(), world=world, join_step=12, max_steps=30, alone=alone.history)

    def test_a_disturbance_after_joining_is_nobodys_business(self):
        world = GridWorld(disturb_step=15)
        alone = run([Script(), Script()], world=world, max_steps=30)
        run([Script(), Script()], Script(), world=world, join_step=12, max_steps=30, alone=alone.history)

    def test_another_word_is_caught(self):
        alone = run([Script(say="hi"), Script()], max_steps=30)
        with pytest.raises(EpisodeError, match="at step 1,"):
            run([Script(say="ho"), Script()], Script(), join_step=3, max_steps=30, alone=alone.history)

    def test_an_unshared_end_is_caught(self):
        alone = run([Script(STOP), Script(STOP)], max_steps=30)
        longer = [*alone.history[:1], "0" * 16]
        with pytest.raises(EpisodeError):
            run([Script(STOP), Script(STOP)], Script(), join_step=3, max_steps=30, alone=longer)

    def test_equal_calls_give_equal_histories(self):
        first, second = (run([Script(), Script()], Script(), join_step=3, max_steps=20) for _ in range(2))
        assert first.history == second.history


class TestTalk:
    def test_messages_arrive_a_step_later_stamped_and_not_at_the_sender(self):
        team = [Script(say="hello"), Script()]
        run(team, max_steps=3)
        assert team[0].heard == []
        assert [(it.sender, it.step, it.text) for it in team[1].heard] == [
            ("teammate_1", 0, "hello"),
            ("teammate_1", 1, "hello"),
        ]

    def test_a_newcomer_hears_nothing_from_before_its_joining(self):
        newcomer = Script()
        run([Script(say="hello"), Script()], newcomer, join_step=2, max_steps=5)
        assert [it.step for it in newcomer.heard] == [2, 3]

    def test_questions_are_answered_within_the_step_in_order(self):
        team, newcomer = [Script(), Script()], Script(ask_at=2)
        result = run(team, newcomer, join_step=2, max_steps=4)
        assert [it.text for it in newcomer.answers] == ["teammate_1 agrees", "teammate_2 agrees"]
        assert all(it.recipient == "newcomer" and it.step == 2 for it in newcomer.answers)
        assert team[0].questions[0].sender == "newcomer"
        assert result.messages == 3
        assert result.trace.messages[0].text == "I want the apple"

    def test_robots_without_power_do_not_answer_but_stopped_ones_do(self):
        tired = (
            Member("tired", Capability(max_steps=1), Pose(1.0, 2.0)),
            Member("stopped", Capability(), Pose(2.0, 2.0)),
        )
        newcomer = Script(ask_at=2)
        run([Script(), Script(TURN, STOP)], newcomer, where=scenario(team=tired), join_step=1, max_steps=4)
        assert [it.text for it in newcomer.answers] == ["stopped agrees"]

    def test_asking_out_of_turn_is_refused(self):
        class Sneak(Script):
            def respond(self, message: Message) -> Message | None:
                self.ask(Message(MessageKind.INTENTION, "me too"))
                return None

        with pytest.raises(EpisodeError, match="outside its own `act`"):
            run([Sneak(), Script()], Script(ask_at=0), max_steps=3)

    def test_payloads_hold_json_values_and_are_copied(self):
        class Odd(Script):
            def act(self, observation, inbox):
                turn = super().act(observation, inbox)
                return type(turn)(
                    turn.action, (Message(MessageKind.TEAM, "odd", {"pose": observation.pose}),)
                )

        with pytest.raises(EpisodeError, match="JSON values"):
            run([Odd(), Script()], max_steps=3)

    def test_messages_to_nobody_are_counted(self):
        class Lost(Script):
            def act(self, observation, inbox):
                turn = super().act(observation, inbox)
                return type(turn)(turn.action, (Message(MessageKind.TEAM, "?", recipient="nobody"),))

        assert run([Lost(), Script()], max_steps=3).undeliverable == 3


class TestTrace:
    def test_takes_puts_and_replacements_are_noted(self):
        result = run([Script(*fetch("apple", "counter"), STOP), Script(STOP)])
        noted = [
            (event.step, event.kind, event.object_id) for event in result.trace.events if event.object_id
        ]
        assert noted == [(1, "picked up", "apple"), (2, "put down", "apple"), (2, "replaced", "apple")]
        assert result.trace.objects_before["apple"].receptacle == "bed"
        assert result.trace.objects_after["apple"].receptacle == "counter"

    def test_failures_are_noted(self):
        result = run([Script(Action(ActionName.PUT_DOWN, "bed"), STOP), Script(STOP)])
        assert result.trace.steps[1].failures == {"teammate_1": "the robot holds nothing"}
        assert result.trace.steps[2].failures == {}
