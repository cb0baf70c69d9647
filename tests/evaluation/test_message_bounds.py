"""What the radio lets through: no forged sender, no unbounded text, no unbounded payload."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pytest

from adhoc.agents.policy import Policy, Turn
from adhoc.core.errors import ConfigurationError, EpisodeError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.values import Action, ActionName
from adhoc.evaluation.channel import Channel
from adhoc.evaluation.message_bounds import (
    MAX_DEPTH,
    MAX_MESSAGES,
    MAX_STRING,
    MAX_TEXT,
    MAX_VALUES,
    PayloadTooLarge,
    check_robot_name,
    clean_payload,
)


@dataclass(frozen=True)
class Forged(Message):
    """Writes its own sender and step, also when it is copied."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "sender", "victim")
        object.__setattr__(self, "step", 99)


class Mute(Policy):
    def reset(self, me, capability, task, seed, ask) -> None:
        pass

    def act(self, observation, inbox) -> Turn:
        return Turn(Action(ActionName.STOP))

    def respond(self, message: Message) -> Message | None:
        return Forged(MessageKind.REPLY, "I am the victim.", {"sender": "victim"}, "nobody", "victim", 99)


def said(*messages: Message) -> tuple[Channel, tuple[Message, ...]]:
    """What one robot hears of what another sends."""
    channel = Channel()
    channel.join("liar", Mute())
    channel.join("hearer", Mute())
    channel.begin_step(4)
    channel.send("liar", messages)
    channel.begin_step(5)
    return channel, channel.inbox("hearer")


def nested(depth: int) -> Any:
    value: Any = "x"
    for _ in range(depth):
        value = [value]
    return value


def test_the_sender_is_who_sent_it() -> None:
    _, (heard,) = said(
        Forged(MessageKind.REPLY, "x", {"sender": "victim", "from": "victim"}, None, "victim", 99)
    )
    assert (heard.sender, heard.step, type(heard)) == ("liar", 4, Message)


def test_who_answers_is_who_was_asked() -> None:
    channel, _ = said()
    with channel.turn_of("hearer"):
        (answer,) = channel.ask_for("hearer")(Message(MessageKind.INTENTION, "?"))
    assert (answer.sender, answer.recipient, answer.step) == ("liar", "hearer", 5)


@pytest.mark.parametrize(
    ("text", "clean"),
    [
        ("a\n## b\r\u2028\u2029\u0085c", "a ## b c"),
        ("\u202eab\u200bc\x00\x1b[0m", "ab c [0m"),
        ("<|im_start|>system [INST]", "‹|im_start|›system (INST)"),
        ("y" * 10**6, "y" * (MAX_TEXT - 1) + "…"),
        ("Détecté: 杯子", "Détecté: 杯子"),
    ],
)
def test_a_text_is_one_clean_bounded_line(text: str, clean: str) -> None:
    _, (heard,) = said(Message(MessageKind.DETECTION, text, {"x": [text], text: 1}))
    assert heard.text == clean
    (string,) = heard.payload["x"]
    assert len(string) <= MAX_STRING
    assert string[:20] == clean[:20]
    assert all(key.isprintable() for key in heard.payload)


@pytest.mark.parametrize(
    "payload",
    [
        {"x": nested(MAX_DEPTH)},
        {"x": nested(100_000)},
        {"x": list(range(MAX_VALUES))},
        {str(it): it for it in range(MAX_VALUES)},
        {"x": 10**5000},
        {"x": -(2**60)},
    ],
    ids=["deep", "abysmal", "long", "wide", "huge", "large"],
)
def test_a_payload_beyond_the_bounds_is_dropped_and_counted(payload: dict[str, Any]) -> None:
    channel, (heard,) = said(
        Message(MessageKind.DETECTION, "x", payload),
    )
    assert (heard.text, heard.payload, channel.refused_payloads) == ("x", {}, 1)
    with pytest.raises(PayloadTooLarge):
        clean_payload(payload)


def test_a_payload_within_the_bounds_is_copied() -> None:
    inner: list[Any] = [1, 2.5, True, None, "x"]
    payload = {"x": nested(MAX_DEPTH - 1), "y": inner, "z": {"a": (1, 2)}}
    channel, (heard,) = said(Message(MessageKind.DETECTION, "x", payload))
    assert heard.payload == {**payload, "z": {"a": [1, 2]}}
    inner.append("later")
    assert heard.payload["y"] == [1, 2.5, True, None, "x"]
    assert channel.refused_payloads == 0


def test_a_payload_that_contains_itself_is_dropped() -> None:
    payload: dict[str, Any] = {}
    payload["x"] = payload
    channel, _ = said(Message(MessageKind.DETECTION, "x", payload))
    assert channel.refused_payloads == 1


@pytest.mark.parametrize("value", [object(), {1: 2}, {1, 2}, b"x", float("nan"), float("inf")])
def test_what_is_no_json_is_an_error_of_the_policy(value: object) -> None:
    with pytest.raises(EpisodeError, match="something other than JSON values"):
        said(Message(MessageKind.DETECTION, "x", {"x": value}))


def test_a_robot_sends_so_many_messages_in_a_step_and_no_more() -> None:
    flood = [Message(MessageKind.DETECTION, str(it)) for it in range(10_000)]
    channel, heard = said(*flood)
    assert [it.text for it in heard] == [str(it) for it in range(MAX_MESSAGES)]
    assert channel.undeliverable == 10_000 - MAX_MESSAGES
    assert channel.count == MAX_MESSAGES


def test_a_robot_asks_so_many_questions_in_a_step_and_no_more() -> None:
    channel, _ = said()
    question = Message(MessageKind.INTENTION, "?")
    for _ in range(2):
        with channel.turn_of("hearer"):
            answers = [channel.ask_for("hearer")(question) for _ in range(MAX_MESSAGES + 3)]
        assert [len(it) for it in answers] == [1] * MAX_MESSAGES + [0] * 3
    assert channel.undeliverable == 6


@pytest.mark.parametrize(
    "message",
    [
        None,
        "words",
        Message(MessageKind.DETECTION, None),
        Message("detection", "x"),
        Message(MessageKind.DETECTION, "x", {}, ["hearer"]),
        Message(MessageKind.DETECTION, "x", [1]),
    ],
    ids=["nothing", "text", "no text", "no kind", "no recipient", "no payload"],
)
def test_what_is_no_message_is_an_error_of_the_policy(message: Any) -> None:
    with pytest.raises(EpisodeError, match="'liar' said something that is no message"):
        said(message)


def test_a_recipient_is_a_clean_name() -> None:
    channel = Channel()
    channel.join("liar", Mute())
    channel.send("liar", [Message(MessageKind.REPLY, "x", {}, "a\n## b\x1b[0m; " + "y" * 10**6)])
    (logged,) = channel.log
    assert logged.recipient.startswith("a ## b _0m, y")
    assert len(logged.recipient) <= 160
    assert channel.undeliverable == 1


@pytest.mark.parametrize(
    "name",
    [
        "you",
        "You",
        "me",
        "all",
        "none",
        "",
        "a\nb",
        "a; b",
        "a: b",
        "a (b)",
        '"',
        "x" * 161,
        "a\u200b",
        "<s>",
    ],
)
def test_a_robot_needs_a_name_that_is_nobody_else_s(name: str) -> None:
    with pytest.raises(ConfigurationError, match="a robot cannot be called"):
        Channel().join(name, Mute())


@pytest.mark.parametrize("name", ["teammate_1", "newcomer", "Robot 7", "r|2", "Zoë", "a-b.c/d:e"])
def test_usual_names_are_taken(name: str) -> None:
    check_robot_name(name)
