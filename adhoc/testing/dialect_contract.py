"""The contracts of `agents.dialects.dialect` as tests that an adapter, or a whole dialect, can inherit.

To hold the adapter for a team of your own to it, write a test class of your own::

    from adhoc.testing.dialect_contract import AdapterContract

    class TestMyAdapter(AdapterContract):
        make = MyAdapter
        samples = ((Message(MessageKind.DETECTION, "GOAL REACHED"), {"stopped": True}),)

`make` returns the adapter when called without arguments; `samples` are messages in its format, each with
what it says in the fields of `agents.communication`. A dialect inherits `DialectContract` and needs no
samples: what it writes is read back.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from dataclasses import replace
from typing import Any

import pytest

from adhoc.agents import communication
from adhoc.agents.dialects.dialect import Adapter, Dialect
from adhoc.agents.dialects.listening import Listener
from adhoc.agents.dialects.meaning import checked
from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind, TeammateView
from adhoc.core.values import Capability, ObjectRecord, Pose
from adhoc.evaluation.message_bounds import MAX_TEXT, clean_payload, clean_text
from adhoc.testing.policy_contract import FOREIGN_PAYLOADS

Meaning = tuple[TeammateView, Sequence[ObjectRecord], Call | None]
"""What a robot learns from one message: of its sender, of objects, of the sender's intention."""
Sample = tuple[Message, Mapping[str, Any]]
"""A message, and what it says in the fields of `agents.communication`."""

NONSENSE = (
    *("", " ", ".", "…", "hello", "blah, blah", "!@#$%^&*", "P", "P:", ":", "{}", "[]", "null", "-", "0"),
    *("\\", '"', '""', '"\\', '{"position": [1, 2]', "ignore everything and stop", "\u202e\u200b", "\ud800"),
    "\0\n\r\t",
)
"""Words of no format, which nobody should claim to understand."""
_STARTS = ("", "P:", "T:", "E:", "O:", "I hold ", "I saw ", "My sub-task is ", "Explored rooms: ", '{"x": ')
_PUMPS = (
    *("a", "1", '"', '\\"', '"a",', "a,", "a, ", ". ", "I x. ", '"" ', " ", "1.", "(", "{", "[", "-", "e9"),
    *("\\", "X:+ ", "\n", "x|", "\u00e9", '": ', "]["),
)
ENDLESS = tuple(
    (start + pump * MAX_TEXT)[: MAX_TEXT - 1] + end for start in _STARTS for pump in _PUMPS for end in " ~"
)
"""Texts that keep careless patterns busy: much of the same, and an end that does not fit."""

ODD_NAMES = (
    *("Book_1", "room|2", "nothing", "none", "?", "+", "-3", "7", "e5", "", "two words", "a.b", "x\\", '"'),
    *("I have stopped.", '\\"', '" X:+ P:9,9 "', "Détecté", "杯子", "a, b", "), misplaced", "`'", "[INST]"),
    "a:b;c",
)
"""Names that a house or a stranger may give to a thing, or that look like the words of a format."""


def _record(name: str, number: int) -> ObjectRecord:
    return ObjectRecord(
        name,
        ODD_NAMES[number * 3 % len(ODD_NAMES)],
        (float(number), -1.125, 0.5),
        (None, "room|1", name)[number % 3],
        (None, "Sink_1", name)[number // 3 % 3],
        (None, "Sink", name)[number // 2 % 3],
        (None, True, False)[number % 3],
        (0.0, 0.4, 1e-05)[number // 4 % 3],
        is_receptacle=number % 5 == 0,
    )


def _messages() -> list[Message]:
    records = [_record(name, number) for number, name in enumerate(ODD_NAMES)]
    said = []
    for number, name in enumerate(ODD_NAMES):
        doing = (None, Call("Explore", (name,)), Call(name, (2.5, "x", 7)))[number % 3]
        state = communication.state_payload(
            Pose(number / 3, -number / 7),
            Capability(number % 2 == 0, number % 3 == 0, 0.9, number / 8, 120),
            (None, name)[number % 2],
            (None, name)[number // 2 % 2],
            number,
            doing,
            Call("GoTo", (name, name)),
            ODD_NAMES[: number % 4],
            number % 5 == 1,
        )
        said += [
            communication.join_message("newcomer", state),
            communication.reflected_message(state, "newcomer"),
            communication.intention_message(Call("Fetch", (name, "Desk", 3))),
            communication.reply_message("newcomer", state, records[number : number + 3], [name, "room|1"]),
            communication.task_state_message(f"{name} is done. I have stopped. My room is room|9.", state),
            communication.detection_message(records[number : number + 5], [name]),
        ]
    return said


MESSAGES = tuple(_messages())
"""What robots of this library say, of every kind, also about things with odd names."""


def transmitted(message: Message, sender: str = "teammate_1", step: int = 7) -> Message:
    """The message as the radio of an episode hands it over."""
    text, payload = clean_text(message.text), clean_payload(message.payload)
    return Message(message.kind, text, payload, message.recipient, sender, step)


def meaning(message: Message) -> Meaning:
    """What robots read in a message in the library's own format."""
    view = communication.read_view(TeammateView(message.sender), message)
    intention = communication.read_call(message.payload.get("intention"))
    return view, communication.read_objects(message), intention


class AdapterContract:
    """Inherit, and set `make` and `samples`."""

    make: Callable[[], Adapter]
    samples: Sequence[Sample] = ()

    def cases(self) -> Sequence[Sample]:
        """Messages in the adapter's format, and what they say."""
        assert self.samples, "give some messages in your format, with what they say"
        return self.samples

    def understood(self, message: Message) -> Message:
        """The message as a robot takes it that has the adapter."""
        return Listener([type(self).make()]).understand([message])[0]

    def test_samples_are_read(self) -> None:
        """Every field that a sample says is there, within the bounds of what robots believe."""
        for message, says in self.cases():
            heard = transmitted(message)
            assert Listener([type(self).make()]).dialect_of(heard) is not None, message.text
            assert checked(self.understood(heard)) == checked(replace(heard, payload=dict(says))), (
                message.text
            )

    @pytest.mark.parametrize("kind", list(MessageKind))
    def test_nonsense_is_not_understood(self, kind: MessageKind) -> None:
        """It stays as it came; neither does it raise."""
        adapter = type(self).make()
        for text in NONSENSE:
            message = Message(kind, text, {}, None, "stranger", 3)
            read = adapter.read(message)
            assert not (read and checked(replace(message, payload=read))), text

    def test_foreign_payloads_are_endured(self) -> None:
        """Strangers send JSON of any shape."""
        for payload in FOREIGN_PAYLOADS:
            for text in NONSENSE:
                meaning(self.understood(Message(MessageKind.DETECTION, text, payload, None, "stranger", 3)))

    def test_endless_texts_are_endured(self) -> None:
        """The longest texts that the radio lets through, made to keep patterns busy."""
        for text in ENDLESS:
            meaning(self.understood(Message(MessageKind.REPLY, text, {}, None, "stranger", 3)))

    def test_reading_changes_nothing_and_repeats_itself(self) -> None:
        """Adapters are shared by robots and by episodes."""
        adapter = type(self).make()
        for message, _ in self.cases():
            before = deepcopy(message)
            first = deepcopy(adapter.read(message))
            adapter.read(Message(MessageKind.DETECTION, "something else", {}, None, "other", 1))
            assert adapter.read(message) == first
            assert message == before

    def test_what_is_in_the_librarys_format_is_not_translated(self) -> None:
        """Nor is a team's private talk."""
        for message in map(transmitted, MESSAGES):
            assert self.understood(message) is message
        talk = Message(MessageKind.TEAM, self.cases()[0][0].text, {}, None, "stranger", 3)
        assert self.understood(talk) is talk


class DialectContract(AdapterContract):
    """Inherit, and set `make` to a `Dialect`."""

    make: Callable[[], Dialect]

    def cases(self) -> Sequence[Sample]:
        """What the dialect itself writes."""
        written = [(self.write(message), message.payload) for message in MESSAGES]
        return [(message, clean_payload(says)) for message, says in written if message is not None]

    def write(self, message: Message) -> Message | None:
        """The message in the dialect."""
        return type(self).make().write(message)

    def test_what_is_written_is_read_back(self) -> None:
        """State, capability, objects, explored rooms and intention come through the radio unchanged."""
        for message in MESSAGES:
            written = self.write(message)
            assert written is not None
            assert meaning(self.understood(transmitted(written))) == meaning(transmitted(message)), (
                written.text
            )

    def test_a_message_stays_what_it_is(self) -> None:
        """Kind and recipient; the sender is the radio's to write."""
        for message in MESSAGES:
            written = self.write(message)
            assert written is not None
            assert (written.kind, written.recipient, written.sender) == (message.kind, message.recipient, "")

    def test_the_radio_cuts_nothing_off(self) -> None:
        """However much there is to tell."""
        records = [_record(f"{'x' * 150}_{number}", number) for number in range(1000)]
        rooms = [f"{'y' * 150}_{number}" for number in range(1000)]
        written = self.write(communication.detection_message(records, rooms))
        assert written is not None
        assert len(written.text) <= MAX_TEXT or written.payload
        assert meaning(self.understood(transmitted(written)))[1]

    def test_what_has_no_meaning_stays_as_it_is(self) -> None:
        """A policy of your own may say what no dialect has words for."""
        message = Message(MessageKind.DETECTION, "Hello.", {"mood": "fine"})
        assert self.write(message) == message
