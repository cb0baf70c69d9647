"""Whatever a robot says in a dialect is read back as it was meant."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.agents import communication
from adhoc.agents.dialects.codes import Codes
from adhoc.agents.dialects.listening import Listener
from adhoc.agents.dialects.meaning import checked, facts_of, payload_of
from adhoc.agents.dialects.sentences import Sentences
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Capability, ObjectRecord, Pose
from adhoc.testing.dialect_contract import ODD_NAMES, meaning, transmitted

NAMES = st.sampled_from(ODD_NAMES) | st.text(max_size=10) | st.text('ab"\\ .,:()|?+-1[]AB', max_size=10)
COORDINATES = st.floats(-1e5, 1e5)
NUMBERS = st.floats(-1e6, 1e6) | st.integers(-(10**6), 10**6)
CALLS = st.builds(Call, NAMES, st.lists(NAMES | NUMBERS, max_size=4).map(tuple))
RECORDS = st.builds(
    ObjectRecord,
    NAMES,
    NAMES,
    st.tuples(COORDINATES, COORDINATES, COORDINATES),
    *[st.none() | NAMES] * 3,
    st.sampled_from([None, True, False]),
    st.floats(0, 1e5),
    st.booleans(),
)
STATES = st.builds(
    communication.state_payload,
    st.builds(Pose, COORDINATES, COORDINATES),
    st.builds(
        Capability, st.booleans(), st.booleans(), st.floats(0.1, 5), st.floats(0, 1e3), st.integers(0, 10**6)
    ),
    st.none() | NAMES,
    st.none() | NAMES,
    st.integers(0, 10**6),
    st.none() | CALLS,
    st.none() | CALLS,
    st.lists(NAMES, max_size=4),
    st.booleans(),
)
ROOMS = st.lists(NAMES, max_size=4)
MESSAGES = st.one_of(
    st.builds(communication.join_message, NAMES, STATES),
    st.builds(communication.reflected_message, STATES, st.just("newcomer")),
    st.builds(communication.intention_message, CALLS),
    st.builds(communication.reply_message, st.just("newcomer"), STATES, st.lists(RECORDS, max_size=3), ROOMS),
    st.builds(communication.task_state_message, st.text(max_size=40), STATES),
    st.builds(communication.detection_message, st.lists(RECORDS, max_size=3), ROOMS),
)


@pytest.mark.parametrize("dialect", [Codes(), Sentences()], ids=lambda it: it.name)
@given(message=MESSAGES)
def test_a_message_is_read_back(dialect, message: Message) -> None:
    meant, written = transmitted(message), dialect.write(message)
    (understood,) = Listener().understand([transmitted(written)])
    assert meaning(understood) == meaning(meant)
    assert checked(understood) == checked(meant)
    if facts_of(message):
        assert written.payload == {}
        assert Listener().dialect_of(transmitted(written)) == dialect.name


@given(message=MESSAGES)
def test_understanding_twice_is_understanding_once(message: Message) -> None:
    once = Listener().understand([transmitted(Codes().write(message))])
    assert [checked(it) for it in Listener().understand(once)] == [checked(it) for it in once]


@given(message=MESSAGES)
def test_facts_are_all_that_a_message_says(message: Message) -> None:
    rebuilt = Message(message.kind, "", payload_of(facts_of(message)))
    assert checked(rebuilt) == checked(message)


def test_codes_look_like_this() -> None:
    state = communication.state_payload(
        Pose(1.0, -2.5),
        Capability(True, False, 0.9, 3.25, 120),
        "room|1",
        None,
        99,
        Call("Explore", ("room|2",)),
        None,
    )
    assert Codes().write(communication.reflected_message(state, "x")).text == (
        "X:- T:Explore,room|2 S:? H:? R:room|1 P:1.0,-2.5 B:99 N:+ M:- K:0.9 L:3.25 F:120"
    )


def test_sentences_look_like_this() -> None:
    book = ObjectRecord("Book_1", "Book", (1.0, 2.0, 0.5), "room|1", "Coffee Table", "Table", True, 0.4)
    table = ObjectRecord("Sink_1", "Sink", (0.0, 0.0, 1.0), is_receptacle=True)
    text = Sentences().write(communication.detection_message([book, table], ["room|1", "nothing"])).text
    assert text == (
        'Explored rooms: room|1, "nothing". I saw Book_1 (misplaced Book) at (1.0, 2.0, 0.5) in room|1 on '
        '"Coffee Table" (Table), weighing 0.4 kg. I saw Sink_1 (Sink, a receptacle) at (0.0, 0.0, 1.0) in an '
        "unknown room on an unknown place."
    )


def test_own_words_are_said_in_quotes_and_mean_nothing() -> None:
    event = 'I stop. I have stopped. "My room is x." \\ My room is room|9.'
    message = communication.task_state_message(event, {"room": "room|1", "stopped": False})
    written = transmitted(Sentences().write(message))
    assert written.text.startswith("I say: \"I stop. I have stopped. 'My room is x.' / My room is room|9\". ")
    assert checked(Listener().understand([written])[0]) == {"room": "room|1", "stopped": False}
    assert written.kind is MessageKind.TASK_STATE
