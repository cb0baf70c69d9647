"""Messages say what was put in, survive JSON, and tolerate strangers who leave things out."""

from __future__ import annotations

import json
from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from adhoc.agents import communication
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind, TeammateView
from adhoc.core.values import Capability, ObjectRecord, Pose

CAPABILITY = Capability(True, True, 0.9, 3.25, 120)
SUB_TASK = Call("Re-place", ("Book_1", "Desk", "Bedroom"))
BOOK = ObjectRecord(
    "Book_1", "Book", (1.0, 2.0, 0.5), "room|1", "Sink_1", "Sink", True, 0.4, is_pickupable=True, last_seen=7
)


def state() -> dict:
    return communication.state_payload(
        Pose(1.0, 2.0), CAPABILITY, "room|1", "Cup_1", 99, SUB_TASK, None, ["room|2"]
    )


def sent(message: Message) -> Message:
    return replace(message, sender="teammate_1", step=9, payload=json.loads(json.dumps(message.payload)))


def test_a_state_is_read_back():
    message = sent(communication.reflected_message(state(), "newcomer"))
    view = communication.read_view(TeammateView("teammate_1"), message)
    assert view == TeammateView(
        "teammate_1", CAPABILITY, (1.0, 2.0), "room|1", "Cup_1", SUB_TASK, None, 99, ("room|2",), False, 9
    )


def test_a_detection_is_read_back_as_the_senders():
    (record,) = communication.read_objects(sent(communication.detection_message([BOOK], [])))
    assert record == replace(BOOK, source="teammate_1", last_seen=9)


def test_texts_name_the_facts():
    text = communication.reply_message("newcomer", state(), [BOOK], ["room|2", "room|3"]).text
    for fact in ("Book_1", "misplaced Book", "Sink_1", "room|1", "room|2, room|3", str(SUB_TASK), "Cup_1"):
        assert fact in text


def test_what_is_left_out_keeps_what_was_known():
    view = TeammateView("teammate_1", CAPABILITY, (1.0, 2.0), "room|1", None, SUB_TASK)
    heard = communication.read_view(view, Message(MessageKind.TASK_STATE, "hi", sender="teammate_1", step=3))
    assert heard == replace(view, last_heard=3)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=8,
)
FIELDS = st.sampled_from(
    (
        *("position", "capability", "room", "holding", "steps_left", "sub_task", "sub_skill", "stopped"),
        *("explored_rooms", "objects", "id", "category", "misplaced", "mass", "name", "args"),
    )
)


@given(st.dictionaries(FIELDS, JSON | st.lists(st.dictionaries(FIELDS, JSON, max_size=5), max_size=2)))
def test_whatever_a_stranger_says_is_read_or_passed_over(payload):
    message = Message(MessageKind.DETECTION, "hm", payload, sender="stranger", step=4)
    view = communication.read_view(TeammateView("stranger"), message)
    assert view.last_heard == 4
    assert view.position is None or len(view.position) == 2
    for record in communication.read_objects(message):
        assert len(record.position) == 3
        assert isinstance(record.category, str)
    assert all(isinstance(room, str) for room in communication.read_explored_rooms(message))


def test_what_is_readable_in_a_broken_message_is_read():
    payload = {"position": "kitchen", "stopped": True, "objects": [{}, communication.object_payload(BOOK)]}
    message = Message(MessageKind.DETECTION, "hm", payload, sender="stranger", step=9)
    assert communication.read_view(TeammateView("stranger"), message).stopped
    assert communication.read_objects(message) == [replace(BOOK, source="stranger", last_seen=9)]
