"""Strangers' words are believed within bounds, and numbers that no robot has are not."""

from __future__ import annotations

from typing import Any

import pytest

from adhoc.agents.communication import MAX_ENTRIES, read_call, read_objects, read_view
from adhoc.agents.hearsay import Hearsay
from adhoc.agents.roster import MemberState, Roster
from adhoc.core.messages import Message, MessageKind, TeammateView
from adhoc.core.values import Capability


def told(sender: str = "teammate_1", **payload: Any) -> Message:
    return Message(MessageKind.DETECTION, "", payload, None, sender, 3)


def thing(name: str, room: str | None = None) -> dict[str, Any]:
    return {"id": name, "category": "Mug", "position": [0, 0, 0], "room": room}


def test_a_thing_too_many_is_not_believed_and_the_others_stay_so() -> None:
    hearsay = Hearsay(objects=2, rooms=1)
    first = hearsay.objects(told(objects=[thing("a", "r"), thing("b", "s"), thing("c", "r")]))
    assert [(it.id, it.room) for it in first] == [("a", "r"), ("b", None)]
    again = hearsay.objects(told(objects=[thing("c"), thing("b", "r")]))
    assert [(it.id, it.room) for it in again] == [("b", "r")]
    assert hearsay.explored_rooms(told(explored_rooms=["r", "s"])) == ["r"]


def test_who_makes_up_things_keeps_nobody_else_from_being_believed() -> None:
    hearsay = Hearsay(objects=2, rooms=2)
    liar = told("liar", objects=[thing(str(it), str(it)) for it in range(9)], explored_rooms=["x", "y", "z"])
    assert len([*hearsay.objects(liar)]) == 2
    honest = told("honest", objects=[thing("Cup_1", "room_5")], explored_rooms=["room_6"])
    assert [(it.id, it.room) for it in hearsay.objects(honest)] == [("Cup_1", "room_5")]
    assert hearsay.explored_rooms(honest) == ["room_6"]


@pytest.mark.parametrize("number", [1e300, -1e300, 10**400, float("nan"), float("inf"), True, "1", None])
def test_numbers_that_no_robot_has_are_not_believed(number: Any) -> None:
    capability = {"payload": number, "camera_height": number, "max_steps": number}
    message = told(position=[number, 1], steps_left=number, capability=capability)
    view = read_view(TeammateView("teammate_1", Capability(payload=3.0)), message)
    assert (view.position, view.steps_left, view.capability) == (None, None, Capability(payload=3.0))
    assert read_objects(told(objects=[{**thing("a"), "position": [number, 0, 0]}])) == []
    (known,) = read_objects(told(objects=[{**thing("a"), "mass": number}]))
    assert known.mass == 0.0


def test_lists_are_read_up_to_a_bound() -> None:
    many = [str(it) for it in range(10 * MAX_ENTRIES)]
    view = TeammateView("teammate_1")
    for start in (0, MAX_ENTRIES):
        view = read_view(view, told(explored_rooms=many[start:]))
    assert len(view.explored_rooms) == MAX_ENTRIES
    assert len(read_objects(told(objects=[thing(it) for it in many]))) == MAX_ENTRIES
    call = read_call({"name": "Explore", "args": many})
    assert call is not None
    assert len(call.args) < 10


NOISE: tuple[Any, ...] = ("x", 3, None, [], {}, [[1]], [["a", "b"]], {"x": 1}, [None], 1e300, True)


@pytest.mark.parametrize("noise", NOISE, ids=repr)
@pytest.mark.parametrize("field", sorted(MemberState.__dataclass_fields__))
def test_a_roster_survives_team_talk_of_any_type(field: str, noise: Any) -> None:
    good = MemberState("robot", (1.0, 2.0), Capability(), "Cup_1", covered=((1, 2),)).message()
    message = Message(MessageKind.TEAM, "", {**good.payload, field: noise}, None, "liar", 2)
    roster = Roster()
    for state in roster.hear(3, [message]):
        assert state.name == "liar"
        assert all(len(cell) == 2 for cell in state.covered)
        assert state.worker().capability.payload >= 0
    assert set(roster.members) <= {"liar"}
    assert list(roster.positions()) == [it.position for it in roster.members.values() if not it.stopped]


def test_a_roster_reads_what_a_member_says() -> None:
    state = MemberState(
        "robot", (1.0, 2.0), Capability(payload=3.0), "Cup_1", True, False, ("a",), ("b",), ((1, 2),)
    )
    message = Message(MessageKind.TEAM, "", state.message().payload, None, "robot", 2)
    assert Roster().hear(3, [message]) == (state,)
