"""Deeds are read from views and glimpses alone, in tiny situations."""

from __future__ import annotations

from dataclasses import replace

import pytest

from adhoc import Call, Capability, Message, MessageKind, TidyingUp
from adhoc.agents import communication
from adhoc.agents.memory import Memory
from adhoc.agents.plastic.deeds import Heard, Seen
from adhoc.agents.plastic.situation import FEATURES
from adhoc.agents.plastic.watching import Watch
from adhoc.core.values import ObjectRecord, Pose

EXPLORE, ELSEWHERE = Call("Explore", ("room_1",)), Call("Explore", ("room_2",))


def replacing(name: str) -> Call:
    return Call("Re-place", (name, "Sink", "Kitchen"))


@pytest.fixture
def memory() -> Memory:
    memory = Memory("newcomer", TidyingUp())
    for name, x in (("Mug_1", 1.0), ("Mug_2", 6.0)):
        record = ObjectRecord(name, "Mug", (x, 0.0, 0.5), "room_1", misplaced=True, is_pickupable=True)
        memory.hear([replace(communication.detection_message([record], ()), sender="finder", step=0)])
    memory.teammates.clear()
    return memory


@pytest.fixture
def watch(memory: Memory) -> Watch:
    return Watch(memory, TidyingUp())


def says(
    memory: Memory,
    step: int,
    sub_task: Call | None,
    name: str = "a",
    x: float = 0.0,
    room: str = "room_1",
    stopped: bool = False,
    can: Capability = Capability(),  # noqa: B008
) -> None:
    state = communication.state_payload(Pose(x, 0.0), can, room, None, 400, sub_task, None, (), stopped)
    message = communication.task_state_message("", state)
    memory.hear([replace(message, sender=name, step=step)])


def deeds(watch: Watch, step: int, **robots: tuple[float, float]) -> list[tuple[str, object]]:
    return [(it.teammate, it.deed) for it in watch.observe(step, robots)]


def test_nobody_heard_and_nobody_seen_is_no_behaviour(watch):
    assert [watch.observe(step, {}) for step in range(60)] == [[]] * 60


def test_a_message_that_nobody_understands_is_no_behaviour(memory, watch):
    memory.hear([Message(MessageKind.TASK_STATE, "bleep", {"x": 1}, sender="a", step=3)])
    assert [watch.observe(step, {}) for step in range(4, 60)] == [[]] * 56


def test_the_team_s_private_talk_is_not_listened_to(memory, watch):
    payload = {"sub_task": communication.call_payload(EXPLORE), "position": [0, 0]}
    memory.hear([Message(MessageKind.TEAM, "", payload, sender="a", step=3)])
    assert watch.observe(4, {}) == []


@pytest.mark.parametrize(
    ("sub_task", "deed"),
    [
        (EXPLORE, Heard.SEARCHES_HERE),
        (ELSEWHERE, Heard.SEARCHES_ELSEWHERE),
        (replacing("Mug_1"), Heard.ATTENDS),
        (replacing("Mug_2"), Heard.ATTENDS_PAST_NEARER),
        (None, Heard.IDLES),
        (Call("Dance"), Heard.IDLES),
    ],
)
def test_what_a_first_word_shows(memory, watch, sub_task, deed):
    says(memory, 3, sub_task)
    assert deeds(watch, 4) == [("a", deed)]


def test_a_second_robot_in_the_same_search_is_company(memory, watch):
    says(memory, 3, EXPLORE)
    watch.observe(4, {})
    says(memory, 4, EXPLORE, "b")
    assert deeds(watch, 5) == [("b", Heard.SEARCHES_TOGETHER)]


def test_an_object_that_another_claims_is_contested(memory, watch):
    says(memory, 3, replacing("Mug_1"))
    watch.observe(4, {})
    says(memory, 4, replacing("Mug_1"), "b")
    assert deeds(watch, 5) == [("b", Heard.ATTENDS_CONTESTED)]


def test_it_is_out_of_turn_only_if_the_closer_one_is_able(memory, watch):
    says(memory, 3, EXPLORE, "b", x=0.9)
    watch.observe(4, {})
    says(memory, 4, replacing("Mug_1"))
    assert deeds(watch, 5) == [("a", Heard.ATTENDS_OUT_OF_TURN)]
    says(memory, 5, EXPLORE)
    says(memory, 5, EXPLORE, "b", x=0.9, can=Capability(can_manipulate=False))
    watch.observe(6, {})
    says(memory, 6, replacing("Mug_1"))
    assert deeds(watch, 7) == [("a", Heard.ATTENDS)]


def test_a_report_changes_nothing_and_a_stop_does(memory, watch):
    says(memory, 3, EXPLORE)
    watch.observe(4, {})
    says(memory, 8, EXPLORE, x=1.0)
    assert deeds(watch, 9) == [("a", Heard.REPORTS)]
    says(memory, 10, None, stopped=True)
    assert deeds(watch, 11) == [("a", Heard.STOPS)]
    assert [watch.observe(step, {}) for step in range(12, 60)] == [[]] * 48


def test_silence_counts_as_going_on_for_a_while_only(memory, watch):
    says(memory, 0, EXPLORE)
    spoken = {step: deeds(watch, step) for step in range(1, 100)}
    going_on = [step for step, found in spoken.items() if found == [("a", Heard.CONTINUES)]]
    assert going_on == [11, 21]


def test_glimpses_show_staying_moving_and_nearing(watch):
    assert deeds(watch, 0, a=(0.0, 3.0)) == []
    assert deeds(watch, 2, a=(0.0, 3.0)) == []
    assert deeds(watch, 5, a=(0.1, 3.0)) == [("a", Seen.STAYS)]
    assert deeds(watch, 10, a=(0.1, 4.5)) == [("a", Seen.MOVES)]
    assert deeds(watch, 15, a=(0.1, 3.5)) == [("a", Seen.NEARS_OBJECT)]
    assert deeds(watch, 40, a=(0.1, 0.5)) == []


def test_the_situation_is_that_before_the_deed(memory, watch):
    says(memory, 3, EXPLORE)
    watch.observe(4, {})
    says(memory, 23, replacing("Mug_1"))
    (behaviour,) = watch.observe(24, {})
    found = dict(zip(FEATURES, behaviour.features))
    assert found["was_searching"] == 1.0
    assert found["was_attending"] == 0.0
    assert found["able"] == found["any_open"] == found["closest_to_it"] == 1.0
    assert found["open_objects"] == pytest.approx(2 / 3)
    assert 0.0 < found["silence"] < 1.0
    assert (behaviour.features >= 0.0).all()
    assert (behaviour.features <= 1.0).all()
