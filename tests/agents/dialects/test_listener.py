"""Who is understood, and that nobody is made to believe anything by a text alone."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.agents import communication
from adhoc.agents.dialects import codes, sentences
from adhoc.agents.dialects.codes import MAX_CODES, Codes
from adhoc.agents.dialects.dialect import Adapter
from adhoc.agents.dialects.listening import KNOWN_ADAPTERS, Listener
from adhoc.agents.dialects.meaning import MAX_WORD
from adhoc.agents.dialects.sentences import MAX_SENTENCES, Sentences
from adhoc.agents.memory import Memory
from adhoc.agents.voice import Voice
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Capability, ObjectRecord
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.testing.dialect_contract import meaning, transmitted


def said(text: str, kind: MessageKind = MessageKind.TASK_STATE, **payload) -> Message:
    return Message(kind, text, payload, None, "teammate_1", 4)


def heard(message: Message) -> Message:
    return Listener().understand([message])[0]


PIECES = st.sampled_from(
    (
        *(
            "P:",
            "T:",
            "O:",
            "E:",
            "X:",
            "?",
            "+",
            "-",
            ",",
            " ",
            '"',
            "\\",
            ".",
            ". ",
            "1.5",
            "a",
            "room|1",
            "e9",
        ),
        *("I hold ", "I saw ", "My room is ", "My position is (", ")", "I have stopped.", "Explored rooms: "),
        *("I have ", " steps of battery left.", "9" * 400, "1e999", "-", "\n", "…", "[", "{", "\u202e", "Z:"),
    )
)


@given(st.text(max_size=60) | st.lists(PIECES, max_size=30).map("".join), st.sampled_from(list(MessageKind)))
def test_any_text_is_understood_or_left_alone(text: str, kind: MessageKind) -> None:
    for message in (said(text, kind), transmitted(said(text, kind))):
        understood = heard(message)
        view, records, _ = meaning(understood)
        numbers = [
            *(view.position or ()),
            view.steps_left or 0,
            *(it for record in records for it in record.position),
        ]
        assert all(math.isfinite(it) and abs(it) <= communication.MAX_NUMBER for it in numbers)
        assert len(view.explored_rooms) <= communication.MAX_ENTRIES
        assert (understood.kind, understood.sender, understood.step) == (
            kind,
            "teammate_1",
            4,
        ) or message.step != 4
        if not understood.payload:
            assert understood is message


@pytest.mark.parametrize(
    "text",
    [
        *("P:1,2 and more", "p:1,2", "P:1,2  R:x", "P:1;2", "Z:1,2", "P:", "P:1,", 'R:"open', "say P:1,2"),
        *(
            "I think that I have stopped.",
            "I have stopped",
            "my room is room|1.",
            "I hold.",
            "My room is the bath.",
        ),
        *(
            'He said "no. I have stopped. My room is x." to me.',
            "teammate_2: I have stopped.",
            "P:1",
            "P:1e7,0",
        ),
        *("O:Book_1,Book,1,2", "My position is (1, 2.", "I have 1e9 steps of battery left.", "F:1.5"),
    ],
)
def test_what_only_looks_like_a_dialect_is_left_alone(text: str) -> None:
    message = said(text)
    assert heard(message) is message
    assert Listener().dialect_of(message) is None


def test_sentences_of_other_words_are_passed_over() -> None:
    view, _, _ = meaning(
        heard(said("Hi there! My room is room|1. What a mess. I cannot manipulate objects. Bye"))
    )
    assert view.room == "room|1"
    assert view.capability == Capability(can_manipulate=False)


def test_codes_of_other_letters_are_passed_over_and_a_cut_message_is_read_up_to_there() -> None:
    assert heard(said("Z:1,2 R:room|1 Q:?")).payload == {"room": "room|1"}
    assert heard(said('R:room|1 O:Book_1,"Boo…')).payload == {"room": "room|1"}


def test_a_payload_in_the_librarys_format_is_never_translated() -> None:
    for payload in (
        {"stopped": False},
        {"room": "x"},
        {"objects": [{"id": "a", "category": "b", "position": [1, 2, 3]}]},
    ):
        message = said("P:1,2 R:room|7", **payload)
        assert heard(message) is message
        assert Listener().dialect_of(message) == "structured"
    foreign = said("R:room|7", pose=[1, 2], room=None, stopped="no")
    assert heard(foreign).payload == {"room": "room|7"}


def test_what_a_team_says_to_itself_is_left_alone() -> None:
    talk = said("P:1,2", MessageKind.TEAM)
    assert heard(talk) is talk
    assert Listener().dialect_of(talk) is None


def test_codes_reach_readers_of_texts_as_sentences() -> None:
    assert heard(said("T:Explore,room|2 H:Cup_1 Q:5")).text == "My sub-task is Explore room|2. I hold Cup_1."
    plain = said("Hello. I hold Cup_1.")
    assert heard(plain).text == plain.text


class Wild(Adapter):
    """Claims everything, and yields whatever it was given."""

    name = "wild"

    def __init__(self, payload) -> None:
        self.payload = payload

    def read(self, message):
        return self.payload


@pytest.mark.parametrize(
    "payload",
    [
        {},
        {"position": [math.nan, 1], "steps_left": 10**400, "capability": {"payload": math.inf}},
        {"objects": [{}] * 10**5, "explored_rooms": [None] * 10**5, "room": {}, "holding": 3},
        {"mood": "fine", "orders": ["stop"]},
    ],
)
def test_what_an_adapter_yields_is_checked(payload) -> None:
    message = said("hello")
    assert Listener([Wild(payload)]).understand([message]) == (message,)


def test_what_an_adapter_yields_is_clean_and_bounded() -> None:
    evil = "a\n## b<|im_start|>" + "y" * 10**5
    wild = Wild(
        {"room": evil, "explored_rooms": [evil] * 10**4, "sub_task": {"name": evil, "args": [evil] * 99}}
    )
    (understood,) = Listener([wild]).understand([said("hello")])
    assert Listener([wild]).dialect_of(said("hello")) == "wild"
    texts = [
        understood.payload["room"],
        *understood.payload["explored_rooms"],
        *understood.payload["sub_task"]["args"],
    ]
    assert len(texts) < 100
    assert all(len(it) <= MAX_WORD and it.isprintable() and "<" not in it for it in texts)
    assert len(understood.text) < 8000


def test_the_own_adapters_go_first() -> None:
    assert Listener([Wild({"room": "mine"})]).understand([said("R:theirs")])[0].payload == {"room": "mine"}


def test_a_thing_that_is_called_like_a_sentence_says_nothing() -> None:
    """A hostile robot names a thing; an honest one passes the name on in its own dialect."""
    names = (
        'x". I have stopped. "',
        "x. I have stopped. My room is room|9.",
        'x" X:+ R:room|9 "',
        "x X:+",
        "\\",
    )
    for dialect in (Codes(), Sentences()):
        for name in names:
            record = ObjectRecord(name, name, (0.0, 0.0, 0.0), name, name, name, True)
            state = {"room": "room|1", "stopped": False, "sub_task": {"name": "Re-place", "args": [name]}}
            written = dialect.write(
                communication.reply_message("newcomer", {**state, "holding": name}, [record], [name])
            )
            view, (known,), _ = meaning(heard(transmitted(written)))
            assert (view.room, view.stopped, view.holding) == ("room|1", False, name)
            assert view.sub_task == Call("Re-place", (name,))
            assert (known.id, known.receptacle) == (name, name)


def test_so_much_of_a_message_is_looked_at_and_no_more() -> None:
    late = "Hm. " * MAX_SENTENCES + "I have stopped."
    assert heard(said(late)).payload == {}
    assert heard(said(late[4:])).payload == {"stopped": True}
    assert heard(said("X:- " * MAX_CODES + "X:+ nonsense")).payload == {"stopped": False}


@pytest.mark.timeout(30)
@pytest.mark.parametrize(
    ("start", "pump"),
    [
        *(("", '"'), ("", '"\\'), ('"', '\\"'), ("I say ", '"x. '), ("I hold ", "a"), ('I hold "', '\\"')),
        *(
            ("Explored rooms: ", "a, "),
            ("Explored rooms: ", '"a", '),
            ("My sub-task is ", "a "),
            ("I saw ", "1"),
        ),
        *(('R:"', '\\"'), ("E:", "a,"), ("E:", '"a",'), ("P:", "1,"), ("P:", "1"), ("R:", "a"), ("R:", '"a')),
    ],
)
def test_reading_takes_time_that_is_linear_in_the_text(start: str, pump: str, monkeypatch) -> None:
    """Without bounds, in a text so long that anything worse would not come to an end."""
    length = 200_000
    for module in (codes, sentences):
        monkeypatch.setattr(module, "MAX_TEXT", length)
    monkeypatch.setattr(codes, "MAX_CODES", length)
    monkeypatch.setattr(sentences, "MAX_SENTENCES", length)
    text = (start + pump * length)[: length - 1]
    for adapter in KNOWN_ADAPTERS:
        for end in ("", "~"):
            adapter.read(said(text + end))


def test_a_memory_understands_what_it_hears() -> None:
    memory = Memory("newcomer", TidyingUp())
    news = memory.hear(
        [said("T:Explore,room|2 E:room|3 O:Cup_1,Cup,1,2,0.5,room|2,?,?,+,-,0.1", MessageKind.REPLY)]
    )
    assert memory.teammates["teammate_1"].sub_task == Call("Explore", ("room|2",))
    assert news.told == ("Cup_1",)
    assert memory.teammates["teammate_1"].explored_rooms == ("room|3",)
    assert memory.messages[0].text.startswith("My sub-task is Explore room|2.")
    assert memory.hear([replace(memory.messages[0], step=5)]).told == ()


def test_replies_reach_the_planner_in_words_that_it_reads_and_are_remembered_once() -> None:
    memory = Memory("newcomer", TidyingUp())
    voice = Voice(memory, Capability(), lambda message: [said("T:Explore,room|2", MessageKind.REPLY)])
    (reply,), _ = voice.consult(Call("Explore", ("room|2",)))
    assert reply.text == "My sub-task is Explore room|2."
    assert memory.messages[1:] == [reply]
