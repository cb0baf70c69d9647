"""What a person's lines mean."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from small_robot import MUG, SINK

from adhoc.agents.human.commands import (
    MAX_ACTIONS,
    CommandReader,
    DoActions,
    DoSkill,
    GoOn,
    Intend,
    Leave,
    Say,
    Show,
    Stop,
)
from adhoc.agents.human.names import Names
from adhoc.agents.human.short_numbers import ShortNumbers
from adhoc.agents.memory import Memory
from adhoc.core.calls import Call, CallSpec
from adhoc.core.errors import CommandError
from adhoc.core.values import Action, ActionName, Capability
from adhoc.tasks.tidying_up import TidyingUp


def reader(capability: Capability | None = None, held: bool = False) -> CommandReader:
    """A robot that knows a mug (1), a sink (2) and their rooms (3 and 4)."""
    memory, numbers = Memory("robot", TidyingUp()), ShortNumbers()
    for record in (MUG, SINK):
        memory.perception.tell_object(record)
    for name in ("Mug_1", "Sink_1", "room_1", "room_2"):
        numbers.of(name)
    if held:
        memory.held = MUG
        memory.lose(MUG.id)
    return CommandReader(TidyingUp(), capability or Capability(), Names(memory, numbers))


def actions(*names: str) -> DoActions:
    return DoActions(tuple(Action(ActionName(name)) for name in names))


@pytest.mark.parametrize(
    ("line", "command"),
    [
        ("", GoOn()),
        ("   ", GoOn()),
        ("help", Show("help")),
        ("LOOK", Show("look")),
        ("stop", Stop()),
        ("leave", Leave()),
        ("say  hello  there ", Say("hello  there ")),
        ("SAY Hello", Say("Hello")),
        ("wait", actions("RotateRight")),
        ("wait 3", actions("RotateRight", "RotateRight", "RotateRight")),
        ("w", actions("MoveAhead")),
        ("a 2", actions("MoveLeft", "MoveLeft")),
        ("wsadqerf", actions("MoveAhead", "MoveBack", "MoveLeft", "MoveRight", "RotateLeft", "RotateRight",
                             "LookUp", "LookDown")),
        ("moveback 2", actions("MoveBack", "MoveBack")),
        ("drop", actions("Drop")),
        ("pickup 1", DoActions((Action(ActionName.PICK_UP, "Mug_1"),))),
        ("PutDown sink_1", DoActions((Action(ActionName.PUT_DOWN, "Sink_1"),))),
        ("explore", DoSkill(Call("Explore"))),
        ("GoToObject Mug_1", DoSkill(Call("GoToObject", ("Mug_1",)))),
        ("go 1", DoSkill(Call("GoToObject", ("Mug_1",)))),
        ("go 3", DoSkill(Call("GoToRoom", ("room_1",)))),
        ("go 1.5 -2", DoSkill(Call("GoToPoint", (1.5, -2.0)))),
        ("pick mug_1", DoSkill(Call("PickupObject", ("Mug_1",)))),
        ("puto 1 2 4", DoSkill(Call("PutObject", ("Mug_1", "Sink_1", "room_2")))),
        ("puto 1 2", DoSkill(Call("PutObject", ("Mug_1", "Sink_1", "room_2")))),
        ("puto 1 floor 4", DoSkill(Call("PutObject", ("Mug_1", "Floor", "room_2")))),
        ("do stop", DoSkill(Call("Stop"))),
        ("task explore 4", Intend(Call("Explore", ("room_2",)))),
        ("task re-place 1 sink kitchen", Intend(Call("Re-place", ("Mug_1", "Sink", "Kitchen")))),
        ("task none", Intend(None)),
        ("task None", Intend(None)),
    ],
)  # fmt: skip
def test_a_line_means(line, command):
    assert reader().read(line) == command


def test_what_is_in_the_hand_need_not_be_said():
    assert reader(held=True).read("put 2") == DoSkill(Call("PutObject", ("Mug_1", "Sink_1", "room_2")))
    assert reader(held=True).read("puto 1 2 4") == DoSkill(Call("PutObject", ("Mug_1", "Sink_1", "room_2")))
    assert reader(held=True).read("put 2 4") == DoSkill(Call("PutObject", ("Mug_1", "Sink_1", "room_2")))


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("jump", "`jump` is no command; `help` explains all of them. Sub-skills: GoToObject"),
        ("jump", "Actions: MoveAhead, "),
        ("jump", "Others: say TEXT, task SUB-TASK, do SUB-SKILL, wait, look, help, stop, leave, Enter."),
        ("go", "`go` must be one of `GoToObject <object>` or `GoToPoint <dx> <dy>` or `GoToRoom <room>`."),
        ("go 9", "your robot knows no object '9'"),
        ("go 1 2 3", "`go` must be one of `GoToObject <object>`"),
        ("goto 1 2 3", "`goto` must be one of `GoToObject <object>`"),
        ("gotor 1 2 3", "GoToRoom <room> takes 1 argument, not 3."),
        ("go Mug_2", "knows no room 'Mug_2'"),
        ("go x y", "<dx> must be a finite number, not 'x'"),
        ("go nan 1", "<dx> must be a finite number"),
        ("explore 3", "Explore takes 0 arguments, not 1"),
        ("pickup", "PickUp takes one target"),
        ("pickup 1 2", "PickUp takes one target"),
        ("pickup 3", "knows no object '3'"),
        ("wait 0", "after `wait` only a number from 1 to 100"),
        ("wait soon", "after `wait` only a number"),
        ("w 101", "after `w` only a number"),
        ("w ²", "after `w` only a number"),
        ("w 2 3", "after `w` only a number"),
        ("w " + "9" * 5000, "after `w` only a number"),
        ("W", "`W` is no command"),
        ("w" * (MAX_ACTIONS + 1), "keys stand alone"),
        ("ww 2", "keys stand alone"),
        ("stop now", "Stop takes 0 arguments, not 1"),
        ("say", "the text is missing: `say TEXT`"),
        ("task", "the sub-task is missing: `task SUB-TASK`"),
        ("do", "the sub-skill is missing: `do NAME ...`"),
        ("look 3", "`look` stands alone"),
        ("help me", "`help` stands alone"),
        ("leave now", "`leave` stands alone"),
        ("task fly", "`fly` is no sub-task"),
        ("task none now", "`none` is no sub-task"),
        ("task re-place 1 s!nk kitchen", "<receptacle_type> must be one word"),
        ("puto 1 9", "which room '9' is in must be said"),
        ("\x1b[2J", "is no command"),
    ],
)
def test_nonsense_is_answered_with_a_sentence(line, told):
    with pytest.raises(CommandError) as error:
        reader().read(line)
    assert told in str(error.value)
    assert str(error.value).isprintable()


@pytest.mark.parametrize(
    "line", ["pickup 1", "putdown 2", "drop", "pick 1", "puto 1 2", "task re-place 1 sink kitchen"]
)
def test_a_robot_without_a_hand_is_not_asked_to_use_it(line):
    with pytest.raises(CommandError, match="manipulation ability"):
        reader(Capability(can_manipulate=False)).read(line)


def test_a_robot_without_a_hand_is_offered_no_commands_for_one():
    with pytest.raises(CommandError) as error:
        reader(Capability(can_manipulate=False)).read("jump")
    assert "GoToObject" in str(error.value)
    assert not {"PickupObject", "PickUp", "Drop"} & set(str(error.value).replace(",", "").split())


def test_a_robot_that_cannot_move_is_not_asked_to():
    with pytest.raises(CommandError, match="no navigation ability"):
        reader(Capability(can_navigate=False)).read("w")


class Coming(TidyingUp):
    sub_skills = (CallSpec("Come", (), ""), CallSpec("ComeBack", (), ""))


def test_a_name_stands_for_itself_and_a_beginning_must_fit_one_alone():
    memory = Memory("robot", Coming())
    coming = CommandReader(Coming(), Capability(), Names(memory, ShortNumbers()))
    assert coming.read("COME") == DoSkill(Call("Come"))
    assert coming.read("comeb") == DoSkill(Call("ComeBack"))
    with pytest.raises(CommandError, match="`co` could be Come or ComeBack"):
        coming.read("co")
    with pytest.raises(CommandError, match="`c` is no command"):
        coming.read("c")


def test_ids_that_differ_in_case_alone_must_be_spelt():
    memory = Memory("robot", TidyingUp())
    for name in ("mug", "MUG"):
        memory.perception.tell_object(replace(MUG, id=name))
    names = Names(memory, ShortNumbers())
    assert names.target("MUG") == "MUG"
    with pytest.raises(CommandError):
        names.target("Mug")


@given(st.text())
def test_any_line_is_a_command_or_a_sentence(line):
    try:
        told = str(reader().read(line))
    except CommandError as error:
        told = str(error)
    assert told.isprintable()


def test_numbers_stay_what_they_were():
    numbers = ShortNumbers()
    assert [numbers.of(name) for name in ("a", "b", "a", "c")] == [1, 2, 1, 3]
    assert [numbers.id(text) for text in ("1", "3", "4", "0", "-1", "٣", "x", "9" * 5000)] == [
        "a", "c", None, None, None, None, None, None,
    ]  # fmt: skip
