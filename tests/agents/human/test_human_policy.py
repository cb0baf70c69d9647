"""A robot that a person plays, from scripts."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_robot import MUG, SINK, WAIT, Robot, observation, scripted

from adhoc.agents.human.manual import introduction
from adhoc.agents.human.policy import HumanPolicy
from adhoc.agents.human.purpose import Purpose
from adhoc.agents.human.terminal import Terminal
from adhoc.agents.memory import Memory
from adhoc.core.calls import Call
from adhoc.core.errors import ConfigurationError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import ActionName, Capability
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.testing.policy_contract import PolicyContract

SCRIPT = Path(__file__).with_name("small_script.txt")


class TestNewcomer(PolicyContract):
    make = staticmethod(lambda: HumanPolicy(script=str(SCRIPT)))


class TestMember(PolicyContract):
    make = staticmethod(lambda: HumanPolicy(member=True, asked="steps", at_end="wait", script=str(SCRIPT)))


def person(robot: Robot) -> dict[str, int]:
    """What the robot counted of its person's lines, in all."""
    counts: dict[str, int] = {}
    for turn in robot.turns:
        for name, count in turn.trace.get("person", {}).items():
            counts[name] = counts.get(name, 0) + count
    return counts


def texts(turn) -> list[str]:
    return [message.text for message in turn.outbox]


class TestCommands:
    def test_actions_are_done_one_a_step(self, tmp_path):
        robot = Robot(scripted(tmp_path, "wwa", "wait 2", "d", "stop"))
        assert robot.actions(8) == [
            "MoveAhead",
            "MoveAhead",
            "MoveLeft",
            WAIT,
            WAIT,
            "MoveRight",
            "Stop",
            "Stop",
        ]
        assert person(robot) == {"lines": 4}

    def test_a_failed_action_calls_off_the_rest(self, tmp_path):
        robot = Robot(scripted(tmp_path, "w 5", "q", asked="ends"))
        robot.act()
        robot.bump()
        assert robot.actions(1) == ["RotateLeft"]

    def test_what_is_said_goes_out_at_once(self, tmp_path):
        robot = Robot(scripted(tmp_path, "say come here", "say now", "w"))
        assert texts(robot.act()) == ["come here", "now"]
        assert robot.turns[0].outbox[0].kind is MessageKind.TASK_STATE

    def test_it_goes_to_everybody_with_the_robot_s_state(self, tmp_path):
        robot = Robot(scripted(tmp_path, "task stop", "say hello", "w"))
        said, _ = robot.act(steps_left=77).outbox
        assert said.recipient is None
        assert said.payload["steps_left"] == 77
        assert said.payload["sub_task"] == {"name": "Stop", "args": []}

    def test_a_sub_skill_is_announced_with_the_sub_task_that_it_serves(self, tmp_path):
        robot = Robot(scripted(tmp_path, "wait", "go mug_1"))
        robot.act()
        robot.know(MUG, SINK)
        turn = robot.act()
        assert texts(turn)[0].startswith(
            "My sub-task is now: Re-place Mug_1 DiningTable Kitchen. My sub-skill is now: GoToObject Mug_1."
        )
        assert turn.outbox[0].payload["sub_task"]["name"] == "Re-place"
        assert turn.trace["skills"] == [{"chosen": "GoToObject Mug_1", "fallback": None}]

    def test_one_sub_task_goes_on_over_several_sub_skills_to_its_end(self):
        memory = Memory("robot", TidyingUp())
        memory._tell(MUG)
        purpose = Purpose(memory, TidyingUp(), Capability())
        go, pick = (Call(name, ("Mug_1",)) for name in ("GoToObject", "PickupObject"))
        purpose.begin(go, observation())
        purpose.succeed(go)
        purpose.begin(pick, observation())
        assert (purpose.sub_task, purpose.done) == (
            Call("Re-place", ("Mug_1", "DiningTable", "Kitchen")),
            [go],
        )
        purpose.succeed(Call("PutObject", ("Mug_1", "Sink_1", "room_2")))
        assert (purpose.sub_task, purpose.done) == (None, [])

    def test_a_sub_skill_that_fails_at_once_is_followed_by_the_next_line(self, tmp_path):
        robot = Robot(scripted(tmp_path, "go 9 9", "w"))
        turn = robot.act()
        assert str(turn.action) == "MoveAhead"
        assert "GoToPoint 9 9 failed: the point is 12.7 m away" in texts(turn)[0]

    def test_a_sub_task_is_told_and_taken_back(self, tmp_path):
        robot = Robot(scripted(tmp_path, "task stop", "w", "task none", "w"))
        assert texts(robot.act()) == ["My sub-task is now: Stop."]
        assert robot.turns[0].trace["doing"] == {"sub_task": "Stop", "sub_skill": None}
        assert texts(robot.act()) == ["My sub-task is now: none."]
        assert robot.turns[1].trace["doing"] == {"sub_task": None, "sub_skill": None}

    def test_what_is_in_the_hand_is_announced(self, tmp_path):
        robot = Robot(scripted(tmp_path, "wait 9"))
        robot.act()
        assert texts(robot.act(held="Mug_1")) == ["I hold Mug_1."]

    def test_a_robot_that_stops_is_about_nothing_any_more(self, tmp_path):
        robot = Robot(scripted(tmp_path, "task stop", "go 0 1", "stop", asked="steps"))
        robot.act()
        assert robot.turns[0].trace["doing"] == {"sub_task": "Stop", "sub_skill": "GoToPoint 0 1"}
        assert robot.act().trace["doing"] == {"sub_task": None, "sub_skill": None}

    def test_an_empty_battery_stops_the_robot_without_a_question(self, tmp_path):
        robot = Robot(scripted(tmp_path, "w"))
        assert str(robot.act(steps_left=0).action) == "Stop"
        assert person(robot) == {}


class TestNonsense:
    def test_it_is_counted_and_asked_again_so_often_then_the_robot_waits_a_step(self, tmp_path):
        robot = Robot(scripted(tmp_path, *["blah"] * 4, "w", tries=3))
        assert robot.actions(2) == [WAIT, "MoveAhead"]
        assert robot.turns[0].trace["person"] == {"lines": 3, "refused": 3, "given_up": 1}
        assert robot.turns[1].trace["person"] == {"lines": 2, "refused": 1}

    def test_talking_without_end_costs_a_step_as_well(self, tmp_path):
        robot = Robot(scripted(tmp_path, *["say hi"] * 6, "w", lines=4))
        assert robot.actions(2) == [WAIT, "MoveAhead"]
        assert person(robot) == {"lines": 7, "given_up": 1}

    @given(st.lists(st.text(), max_size=8))
    def test_no_line_ends_an_episode(self, tmp_path_factory, lines):
        stamped = [f"@0 {' '.join(line.split())}" for line in lines]
        robot = Robot(scripted(tmp_path_factory.mktemp("scripts"), *stamped, tries=2, lines=4))
        assert all(turn in [name.value for name in ActionName] for turn in robot.actions(6))


class TestLeaving:
    def test_the_robot_finishes_what_it_is_at_and_stops(self, tmp_path):
        robot = Robot(scripted(tmp_path, "wait 2", "leave", "w"))
        assert robot.actions(4) == [WAIT, WAIT, "Stop", "Stop"]
        assert person(robot) == {"lines": 2, "left": 1}
        assert texts(robot.turns[2]) == ["I stop."]

    def test_or_waits_if_it_is_told_so(self, tmp_path):
        robot = Robot(scripted(tmp_path, "w", at_end="wait"))
        assert robot.actions(4) == ["MoveAhead", WAIT, WAIT, WAIT]
        assert person(robot) == {"lines": 2, "left": 1}, "the end of a script counts as leaving"

    def test_in_the_middle_of_something_that_is_finished_first(self, tmp_path):
        robot = Robot(scripted(tmp_path, "w 3", "leave", asked="steps"))
        assert robot.actions(4) == ["MoveAhead", "MoveAhead", "MoveAhead", "Stop"]

    def test_a_person_may_leave_instead_of_an_answer(self, tmp_path):
        robot = Robot(scripted(tmp_path, "w 2", "leave", "d", answers="person", member=True))
        robot.act()
        robot.policy.respond(TestQuestions.INTENTION)
        assert robot.actions(2) == ["MoveAhead", "Stop"]


@pytest.mark.parametrize("last", ["leave", "stop"])
def test_what_has_ended_in_one_episode_has_not_in_the_next(tmp_path, last):
    policy = scripted(tmp_path, "w", last)
    assert [Robot(policy).actions(3) for _ in range(2)] == [["MoveAhead", "Stop", "Stop"]] * 2


@pytest.mark.parametrize("member", [False, True])
def test_a_newcomer_greets_in_every_episode_and_a_member_never(tmp_path, member):
    policy = scripted(tmp_path, "w", member=member)
    asked: list[MessageKind] = []
    for _ in range(2):
        robot = Robot(policy)
        policy.reset("robot", Capability(), TidyingUp(), 0, lambda it: asked.append(it.kind) or ())
        robot.actions(2)
    assert asked == ([] if member else [MessageKind.JOIN] * 2)


FOUND = Message(
    MessageKind.DETECTION,
    "look",
    {"objects": [{"id": "Mug_1", "category": "Mug", "position": [2, 0, 1], "misplaced": True}]},
    None,
    "teammate_1",
    1,
)


SETTLED = replace(
    FOUND,
    payload={"objects": [{"id": "Mug_1", "category": "Mug", "position": [2, 0, 1], "misplaced": False}]},
)
STOPPED = Message(MessageKind.TASK_STATE, "I stop.", {"stopped": True}, None, "teammate_1", 1)


@pytest.mark.parametrize("message", [SETTLED, STOPPED])
def test_a_person_is_told_what_is_over(tmp_path, message):
    robot = Robot(scripted(tmp_path, "w", "s 9", "a"))
    robot.act()
    robot.act([FOUND])
    assert str(robot.act([message]).action) == "MoveLeft"


def test_a_short_number_stays_with_its_object_when_a_nearer_one_is_found(tmp_path):
    robot = Robot(scripted(tmp_path, "wait", "wait", "go 1"))
    robot.know(MUG)
    robot.act()
    robot.know(replace(MUG, id="Cup_1", position=(1.0, 0.0, 0.8)))
    robot.act()
    assert robot.act().trace["skills"][0]["chosen"] == "GoToObject Mug_1"


@pytest.mark.parametrize(
    ("asked", "expected"),
    [
        ("steps", ["MoveAhead", "MoveLeft", "MoveRight"]),
        ("events", ["MoveAhead", "MoveAhead", "MoveLeft"]),
        ("ends", ["MoveAhead", "MoveAhead", "MoveAhead"]),
    ],
)
def test_when_a_person_is_asked_in_the_middle_of_something(tmp_path, asked, expected):
    robot = Robot(scripted(tmp_path, "w 3", "a", "d", asked=asked))
    robot.act()
    robot.act()
    robot.act([FOUND])
    assert [str(turn.action) for turn in robot.turns] == expected


def test_enter_goes_on_with_what_is_being_done_and_else_waits(tmp_path):
    robot = Robot(scripted(tmp_path, "w 2", "@1 ", "@2 ", "a", asked="steps"))
    assert robot.actions(4) == ["MoveAhead", "MoveAhead", WAIT, "MoveLeft"]


class TestQuestions:
    JOIN = Message(MessageKind.JOIN, "I join", {}, None, "newcomer", 0)
    INTENTION = Message(MessageKind.INTENTION, "I intend to do: Explore room_1.", {}, None, "newcomer", 0)

    def test_the_memory_answers(self, tmp_path):
        robot = Robot(scripted(tmp_path, "task explore room_9", "w 9", member=True))
        robot.know(MUG)
        robot.act()
        answer = robot.policy.respond(self.INTENTION)
        assert answer is not None
        assert "Mug_1 (misplaced Mug)" in answer.text
        assert robot.policy.respond(self.JOIN).kind is MessageKind.REFLECTED

    def test_the_person_may_put_words_before_it(self, tmp_path):
        robot = Robot(scripted(tmp_path, "w 9", "no, I do", "", answers="person", member=True))
        robot.act()
        assert robot.policy.respond(self.INTENTION).text.startswith("no, I do Current sub-task: none.")

    def test_a_robot_whose_person_has_left_answers_all_the_same(self, tmp_path):
        robot = Robot(scripted(tmp_path, "w 2", answers="person", member=True))
        robot.act()
        for _ in range(2):
            assert robot.policy.respond(self.INTENTION).text.startswith("Current sub-task: none.")
        assert robot.actions(2) == ["MoveAhead", "Stop"]
        assert person(robot)["left"] == 1

    def test_before_its_first_step_it_says_nothing(self, tmp_path):
        assert Robot(scripted(tmp_path, "w")).policy.respond(self.JOIN) is None

    def test_a_newcomer_is_an_event(self, tmp_path):
        robot = Robot(scripted(tmp_path, "w 9", "a", member=True))
        robot.act()
        robot.policy.respond(self.JOIN)
        assert robot.actions(1) == ["MoveLeft"]


class TestSessions:
    """At a terminal, which is two strings here."""

    def play(self, monkeypatch, folder, typed, steps, **settings):
        monkeypatch.setattr("sys.stdin", io.StringIO(typed))
        monkeypatch.setattr("sys.stdout", shown := io.StringIO())
        robot = Robot(HumanPolicy(sessions=folder, **settings))
        actions = robot.actions(steps)
        return actions, shown.getvalue(), robot

    def test_the_dialog(self, monkeypatch, tmp_path):
        _, shown, _ = self.play(monkeypatch, tmp_path, "blah\nhelp\nlook\nw\n", 1)
        assert "=== You play robot, seed 0. `help` lists what you can type. ===" in shown
        assert "step 0: you are in an unknown room at (0.0, 0.0), heading 0, and hold nothing" in shown
        assert (
            "\nTask: Several robots with different abilities tidy up a house together. (`help` tells more)\n"
            "Your robot can pick up things of up to 20.0 kg; its battery lasts 500 steps, "
            "one for each action.\n"
        ) in shown
        assert "> blah\n  `blah` is no command; `help` explains all of them." in shown
        assert "Task: Several robots with different abilities tidy up a house together. You are" in shown
        assert "`do NAME ...`" in shown
        assert "GoToObject <object>: " in shown
        assert shown.count("=== You play") == 1

    def test_the_person_is_told_what_this_robot_can_do(self, monkeypatch, tmp_path):
        monkeypatch.setattr("sys.stdin", io.StringIO("w\n"))
        monkeypatch.setattr("sys.stdout", shown := io.StringIO())
        Robot(HumanPolicy(sessions=tmp_path), Capability(can_manipulate=False)).act()
        assert "Your robot has no hand" in shown.getvalue()

    def test_what_strangers_say_brings_no_commands_for_the_terminal(self, monkeypatch, tmp_path):
        monkeypatch.setattr("sys.stdin", io.StringIO("w\n"))
        monkeypatch.setattr("sys.stdout", shown := io.StringIO())
        robot = Robot(HumanPolicy(sessions=tmp_path))
        robot.act([Message(MessageKind.DETECTION, "\x1b[2Jboo\nstep 9", {}, None, "\x1b[31mevil", 0)])
        evil = Message(MessageKind.INTENTION, "\x1b[2J", {}, None, "\x1b[31mevil", 0)
        robot.policy.respond(replace(evil, kind=MessageKind.JOIN))
        assert "boo step 9" in shown.getvalue()
        monkeypatch.setattr("sys.stdin", io.StringIO("explore\n\n\n"))
        robot = Robot(HumanPolicy(sessions=tmp_path, answers="person", asked="steps"))
        robot.act()
        robot.policy.respond(evil)
        robot.policy.respond(replace(evil, kind=MessageKind.JOIN))
        robot.act()
        assert "evil asks:" in shown.getvalue()
        assert "evil joined:" in shown.getvalue()
        assert "\x1b" not in shown.getvalue()

    def test_what_was_typed_is_a_script_that_gives_the_same(self, monkeypatch, tmp_path):
        played, _, robot = self.play(monkeypatch, tmp_path, "ww\nblah\n\nexplore\n", 8)
        again = Robot(HumanPolicy(script=str(tmp_path / "robot.txt")))
        assert again.actions(8) == played
        assert person(again) == person(robot)
        assert [turn.outbox for turn in again.turns] == [turn.outbox for turn in robot.turns]

    def test_the_same_beginning_is_typed_once(self, monkeypatch, tmp_path):
        first, _, _ = self.play(monkeypatch, tmp_path, "ww\nblah\na\nd\n", 4)
        second, shown, _ = self.play(monkeypatch, tmp_path, "q\n", 5)
        assert second == [*first, "RotateLeft"]
        assert shown.count("(as before)") == 4

    def test_unless_it_is_not_wanted(self, monkeypatch, tmp_path):
        self.play(monkeypatch, tmp_path, "ww\na\n", 3)
        assert self.play(monkeypatch, tmp_path, "s 3\n", 3, repeat=False)[0] == ["MoveBack"] * 3

    def test_a_question_makes_another_situation(self, monkeypatch, tmp_path):
        self.play(monkeypatch, tmp_path, "w\nw\nw\n", 3)
        monkeypatch.setattr("sys.stdin", io.StringIO("s\n"))
        robot = Robot(HumanPolicy(sessions=tmp_path))
        robot.act()
        robot.policy.respond(TestQuestions.INTENTION)
        assert robot.actions(1) == ["MoveBack"]

    def test_another_situation_is_asked_about(self, monkeypatch, tmp_path):
        self.play(monkeypatch, tmp_path, "w\nw\nw\n", 3)
        monkeypatch.setattr("sys.stdin", io.StringIO("s\n"))
        robot = Robot(HumanPolicy(sessions=tmp_path))
        robot.act()
        robot.bump()
        assert robot.actions(1) == ["MoveBack"]


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"asked": "often"}, "HumanPolicy.asked=often: must be one of steps, events, ends"),
        ({"answers": "me"}, "answers=me: must be one of memory, person"),
        ({"at_end": "die"}, "at_end=die: must be one of stop, wait"),
        ({"tries": 0, "configured_at": "policy.agent"}, r"^policy\.agent\.tries=0: must be at least 1$"),
        ({"lines": 0}, "^HumanPolicy.lines=0: must be at least 1$"),
    ],
)
def test_settings_out_of_range(settings, told):
    with pytest.raises(ConfigurationError, match=told):
        HumanPolicy(**settings)


def test_a_script_is_read_before_any_episode(tmp_path):
    with pytest.raises(ConfigurationError, match=r"^policy\.agent\.script=.*gone\.txt: cannot be read"):
        HumanPolicy(script=str(tmp_path / "gone.txt"), configured_at="policy.agent")
    (tmp_path / "bad.txt").write_text("w\n@soon w\n")
    with pytest.raises(ConfigurationError, match=r"^HumanPolicy\.script=.*bad\.txt, line 2: '@soon w'"):
        HumanPolicy(script=str(tmp_path / "bad.txt"))


def test_a_script_begins_again_with_every_episode(tmp_path):
    policy = scripted(tmp_path, "w", "a", "d")
    assert [Robot(policy).actions(2) for _ in range(2)] == [["MoveAhead", "MoveLeft"]] * 2


def test_a_run_without_a_person_is_refused(tmp_path):
    empty = Terminal(io.StringIO(), io.StringIO(), must_begin=True)
    robot = Robot(HumanPolicy(sessions=tmp_path, terminal=empty, configured_at="team.seats.0.agent"))
    told = r"^no person: standard input is empty; give \+team\.seats\.0\.agent\.script=FILE"
    with pytest.raises(ConfigurationError, match=told):
        robot.act()
    assert not list(tmp_path.iterdir())


def test_a_robot_without_a_hand_or_wheels_is_introduced_as_such():
    told = introduction(TidyingUp(), Capability(False, False, payload=3.0, max_steps=60)).splitlines()
    assert told[1] == (
        "Your robot cannot move, has no hand: it cannot pick up anything; its battery lasts 60 steps, "
        "one for each action."
    )


def test_a_robot_without_a_hand_is_told_so(tmp_path):
    robot = Robot(scripted(tmp_path, "drop", "w"), Capability(can_manipulate=False))
    assert robot.actions(1) == ["MoveAhead"]
    assert person(robot) == {"lines": 2, "refused": 1}
