"""Messages and questions of whole episodes over a radio with faults."""

from __future__ import annotations

from collections import Counter

from grid_world import Errand, GridWorld, Script, scenario

from adhoc.agents.policy import Turn
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName, Capability, Pose
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.imperfections import Imperfections
from adhoc.evaluation.scenario import Member

TURNS = [Action(ActionName.ROTATE_LEFT)] * 50


def run(team, newcomer=None, join_step=0, max_steps=8, where=None, **faults):
    return run_episode(
        GridWorld(),
        where or scenario(),
        Errand(),
        team,
        newcomer,
        join_step,
        max_steps,
        imperfections=Imperfections(**faults),
    )


class Choir(Script):
    """Says several things a step, and when it heard what."""

    def reset(self, *arguments):
        super().reset(*arguments)
        self.when = []

    def act(self, observation, inbox):
        self.when += [(observation.step, message.step, message.text) for message in inbox]
        turn = super().act(observation, inbox)
        said = [Message(MessageKind.TASK_STATE, f"{number}") for number in range(5)]
        return Turn(turn.action, tuple(said))


def heard_from(sender, robot):
    return [(it.step, it.text) for it in robot.heard if it.sender == sender]


def test_without_faults_everything_comes_a_step_later_in_order():
    team = [Choir(*TURNS), Choir(*TURNS)]
    result = run(team, max_steps=3)
    assert team[1].when == [(step + 1, step, f"{number}") for step in range(2) for number in range(5)]
    assert vars(result.deliveries) == {"lost": 0, "out_of_range": 0, "delayed": 0}


def test_losses_are_counted_for_each_robot_and_differ_between_them():
    team = [Choir(*TURNS), Choir(*TURNS), Choir(*TURNS)]
    crowd = scenario(team=tuple(Member(f"r{x}", Capability(), Pose(float(x), 2.0)) for x in (1, 2, 3)))
    result = run(team, where=crowd, max_steps=41, loss=0.25)
    sent = 41 * 5 * 3 * 2
    heard = sum(len(robot.when) for robot in team)
    assert 0.18 < result.deliveries.lost / sent < 0.32
    last_step = 5 * 3 * 2
    assert heard + result.deliveries.lost >= sent - last_step
    assert heard_from("r1", team[1]) != heard_from("r1", team[2])


def test_messages_of_one_step_have_fates_of_their_own():
    team = [Choir(*TURNS), Choir(*TURNS)]
    run(team, max_steps=30, loss=0.5)
    counts = Counter(it.step for it in team[1].heard)
    assert {1, 2, 3, 4} <= set(counts.values())


def test_all_is_lost():
    team = [Choir(*TURNS), Script(*TURNS, ask_at=2)]
    result = run(team, loss=1.0)
    assert team[1].heard == []
    assert team[1].answers == []
    assert team[0].questions == []
    assert result.messages == 8 * 5 + 1


def test_a_delay_adds_steps():
    team = [Choir(*TURNS), Choir(*TURNS)]
    result = run(team, delay=2, max_steps=6)
    assert {heard - said for heard, said, _ in team[1].when} == {3}
    assert result.deliveries.delayed == 6 * 5 * 2


def test_with_jitter_messages_overtake_each_other():
    team = [Choir(*TURNS), Choir(*TURNS)]
    run(team, jitter=4, max_steps=30)
    said = [step for _, step, _ in team[1].when]
    assert said != sorted(said)
    assert {heard - step for heard, step, _ in team[1].when} == {1, 2, 3, 4, 5}


def test_a_late_question_is_answered_late_and_the_answer_is_heard():
    asker, asked = Script(*TURNS, ask_at=1), Script(*TURNS)
    result = run([asker, asked], delay=2, max_steps=9)
    assert asker.answers == []
    assert [(it.sender, it.step) for it in asked.questions] == [("teammate_1", 1)]
    assert [(it.text, it.step) for it in asker.heard] == [("teammate_2 agrees", 3)]
    assert result.deliveries.delayed == 2


def test_a_broken_robot_answers_no_late_question():
    asker, asked = Script(*TURNS, ask_at=1), Script(*TURNS)
    run([asker, asked], delay=2, breaks_down={1: 2})
    assert asked.questions == []


def test_an_answer_can_be_late_alone():
    """The fate of an answer is its own: some questions are answered in time, some late, some never."""

    class Asking(Choir):
        def act(self, observation, inbox):
            self.asked = [*getattr(self, "asked", []), self.ask(Message(MessageKind.INTENTION, "?"))]
            return super().act(observation, inbox)

    asker, asked = Asking(*TURNS), Script(*TURNS)
    run([asker, asked], max_steps=40, loss=0.3, jitter=1)
    in_time = sum(map(len, asker.asked))
    late = sum(text.endswith("agrees") for _, _, text in asker.when)
    assert in_time
    assert late
    assert in_time + late < len(asked.questions) < 40


class TestRange:
    """Teammates stand 1 m apart, the newcomer 4 and 5 m from them."""

    def test_the_far_are_not_heard(self):
        team, newcomer = [Choir(*TURNS), Choir(*TURNS)], Choir(*TURNS, ask_at=3)
        result = run(team, newcomer, max_steps=5, range=2.0)
        assert len(team[1].when) == 4 * 5
        assert newcomer.when == []
        assert newcomer.answers == []
        assert result.deliveries.out_of_range == 5 * 5 * 4 + 2

    def test_some_may_be_near_enough(self):
        team, newcomer = [Script(*TURNS), Script(*TURNS)], Script(*TURNS, ask_at=3)
        run(team, newcomer, range=4.5)
        assert [it.text for it in newcomer.answers] == ["teammate_2 agrees"]

    def test_it_is_measured_where_the_robots_are_now(self):
        away = [Action(ActionName.MOVE_AHEAD)] * 20
        team = [Choir(*TURNS), Script(*away)]
        run(team, max_steps=20, range=2.0)
        heard = [it.step for it in team[1].heard]
        assert max(heard) == 4  # 1 m, and 0.25 m more at every step


def test_a_newcomer_changes_nothing_between_others():
    def team_hears(newcomer):
        team = [Choir(*TURNS), Choir(*TURNS)]
        run(team, newcomer, join_step=10, max_steps=30, loss=0.3, jitter=2)
        return heard_from("teammate_1", team[1])

    assert team_hears(None) == team_hears(Script(*TURNS, say="hello"))
