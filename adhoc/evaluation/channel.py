"""The radio of an episode: what robots say arrives a step later, what they ask is answered at once."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from adhoc.agents.policy import Ask, Policy
from adhoc.core.errors import EpisodeError
from adhoc.core.messages import Message
from adhoc.evaluation.message_bounds import (
    MAX_MESSAGES,
    PayloadTooLarge,
    check_robot_name,
    clean_payload,
    clean_recipient,
    clean_text,
    is_message,
)


class Channel:
    """Carries messages between the robots that are present (paper, section Communication).

    A message reaches the robots that were present when it was sent, at the next step, in the order of
    sending. The channel writes `sender` and `step` and copies the payload, so that nobody can speak in
    another's name or reach into another's memory; it lets through bounded amounts of clean text only (see
    `evaluation.message_bounds`). Robots answer in the order in which they joined.
    """

    def __init__(self) -> None:
        self._members: dict[str, Policy] = {}
        self._deaf: set[str] = set()
        self._inboxes: dict[str, list[Message]] = {}
        self._arriving: dict[str, list[Message]] = {}
        self._step = 0
        self._speaker: str | None = None
        self._asked = 0
        """Questions of the speaker in its turn."""
        self.count = 0
        """Messages sent so far; a broadcast counts once, and so does each answer."""
        self.undeliverable = 0
        """Messages to a robot that is not present, or beyond what one robot may send or ask in a step;
        dropped."""
        self.refused_payloads = 0
        """Payloads that were too large or too deep; their messages arrived without them."""
        self.log: list[Message] = []
        """Everything sent in the current step, in order."""

    def join(self, name: str, policy: Policy) -> None:
        """Let a robot take part from now on. Raises ConfigurationError if its name is not plain."""
        check_robot_name(name)
        self._members[name] = policy
        self._inboxes[name] = []
        self._arriving[name] = []

    def silence(self, name: str) -> None:
        """A robot that is out of power neither hears nor answers any more."""
        self._deaf.add(name)

    def begin_step(self, step: int) -> None:
        """What was sent in the step before is now in the inboxes; the log starts afresh."""
        self._step = step
        self.log = []
        for name in self._members:
            self._inboxes[name], self._arriving[name] = self._arriving[name], []

    def inbox(self, name: str) -> tuple[Message, ...]:
        """What arrived for that robot at the current step."""
        return tuple(self._inboxes[name])

    def send(self, sender: str, messages: Iterable[Message]) -> None:
        """Post messages; they arrive at the next step."""
        for number, message in enumerate(messages):
            if number >= MAX_MESSAGES:
                self.undeliverable += 1
                continue
            stamped = self._stamp(message, sender)
            for name in self._audience(stamped):
                self._arriving[name].append(stamped)

    @contextmanager
    def turn_of(self, name: str) -> Iterator[None]:
        """While in this context, that robot, and no other, may ask."""
        self._speaker, self._asked = name, 0
        try:
            yield
        finally:
            self._speaker = None

    def ask_for(self, name: str) -> Ask:
        """The `ask` of one robot: a question that the others answer within the step.

        Nobody hears what goes beyond the questions of one step.
        """

        def ask(message: Message) -> Sequence[Message]:
            if self._speaker != name:
                raise EpisodeError(f"{name!r} asked a question outside its own `act`")
            self._asked += 1
            if self._asked > MAX_MESSAGES:
                self.undeliverable += 1
                return ()
            question = self._stamp(message, name)
            return tuple(self._answers(question))

        return ask

    def _answers(self, question: Message) -> Iterator[Message]:
        for name in self._audience(question):
            answer = self._members[name].respond(question)
            if answer is not None:
                yield self._stamp(answer, name, answers=question.sender)

    def _audience(self, message: Message) -> list[str]:
        present = [name for name in self._members if name != message.sender and name not in self._deaf]
        if message.recipient is None:
            return present
        if message.recipient not in self._members:
            self.undeliverable += 1
        return [name for name in present if name == message.recipient]

    def _stamp(self, message: Message, sender: str, answers: str | None = None) -> Message:
        if not is_message(message):
            raise EpisodeError(f"{sender!r} said something that is no message at step {self._step}")
        payload = self._payload(message, sender)
        recipient = answers or clean_recipient(message.recipient)
        stamped = Message(message.kind, clean_text(message.text), payload, recipient, sender, self._step)
        self.log.append(stamped)
        self.count += 1
        return stamped

    def _payload(self, message: Message, sender: str) -> dict[str, Any]:
        try:
            return clean_payload(message.payload)
        except PayloadTooLarge:
            self.refused_payloads += 1
            return {}
        except (TypeError, ValueError) as error:
            raise EpisodeError(
                f"the payload of a {message.kind.value!r} message from {sender!r} at step {self._step} "
                f"holds something other than JSON values: {error}"
            ) from error


def message_text(message: Message) -> str:
    """A message as one canonical line of JSON: for hashes and logs."""
    parts = (
        message.step,
        message.sender,
        message.recipient,
        message.kind.value,
        message.text,
        message.payload,
    )
    return json.dumps(parts, sort_keys=True, separators=(",", ":"))
