"""The radio of an episode: what robots say arrives a step later, what they ask is answered at once."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from adhoc.agents.policy import Ask, Policy
from adhoc.core.errors import EpisodeError
from adhoc.core.messages import Message, MessageKind
from adhoc.evaluation.message_bounds import (
    MAX_MESSAGES,
    PayloadTooLarge,
    check_robot_name,
    clean_payload,
    clean_recipient,
    clean_text,
    is_message,
)
from adhoc.evaluation.radio import Radio
from adhoc.evaluation.transit import Deliveries, Places, Transit


class Channel:
    """Carries messages between the robots that are present (paper, section Communication).

    A message reaches the robots that were present when it was sent, at the next step, in the order of
    sending. The channel writes `sender` and `step` and copies the payload, so that nobody can speak in
    another's name or reach into another's memory; it lets through bounded amounts of clean text only (see
    `evaluation.message_bounds`). Robots answer in the order in which they joined. What a team says to itself
    (`MessageKind.TEAM`) may be heard by anybody and said by its members alone: a newcomer's is dropped.

    With a `radio` that has faults, a message reaches a robot late or not at all. A question that comes in
    time is answered within the step; one that comes late is answered then, and a late answer comes like any
    other message.

    Args:
        radio: What becomes of messages on their way; without faults by default.
        seed: Of the radio's faults: that of the scenario.
    """

    def __init__(self, radio: Radio | None = None, seed: int = 0) -> None:
        self._transit = Transit(radio or Radio(), seed)
        self._spoken: Counter[str] = Counter()
        """Messages of each robot in this step."""
        self._members: dict[str, Policy] = {}
        self._strangers: set[str] = set()
        self._deaf: set[str] = set()
        self._inboxes: dict[str, list[Message]] = {}
        self._step = 0
        self._speaker: str | None = None
        self._asked = 0
        """Questions of the speaker in its turn."""
        self.count = 0
        """Messages sent so far; a broadcast counts once, and so does each answer."""
        self.undeliverable = 0
        """Messages to a robot that is not present, beyond what one robot may send or ask in a step, or a
        stranger's in a team's private talk; dropped."""
        self.refused_payloads = 0
        """Payloads that were too large or too deep; their messages arrived without them."""
        self.log: list[Message] = []
        """Everything sent in the current step, in order."""

    def join(self, name: str, policy: Policy, of_team: bool = True) -> None:
        """Let a robot take part from now on, one of the original team or another one. Raises
        ConfigurationError if its name is not plain."""
        check_robot_name(name)
        if not of_team:
            self._strangers.add(name)
        self._members[name] = policy
        self._inboxes[name] = []

    @property
    def deliveries(self) -> Deliveries:
        """What the radio's faults did so far."""
        return self._transit.deliveries

    def silence(self, name: str) -> None:
        """A robot that is out of power, broken or gone neither hears nor answers any more."""
        self._deaf.add(name)

    def begin_step(self, step: int, places: Places | None = None) -> None:
        """What was sent in the step before is now in the inboxes; the log starts afresh.

        `places` is where the robots are now, if the radio has a range.
        """
        self._step = step
        self._transit.begin_step(step, places or {})
        self._spoken.clear()
        self.log = []
        late: list[tuple[str, Message]] = []
        for name in self._members:
            arrived = self._transit.take(name)
            self._inboxes[name] = [it.message for it in arrived if not it.is_question]
            late += [(name, it.message) for it in arrived if it.is_question and name not in self._deaf]
        for name, question in late:
            answer = self._answer(name, question)
            if answer is not None:
                self._post(answer, self._audience(answer))

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
            self._post(stamped, self._audience(stamped))

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
        index = self._spoken[question.sender]
        for name in self._audience(question):
            delay = self._transit.delay(question, name, index)
            if isinstance(delay, int) and delay > 0:
                self._transit.hold(question, name, delay, is_question=True)
            elif delay == 0:
                answer = self._answer(name, question)
                if answer is not None and self._is_in_time(answer, question.sender):
                    yield answer

    def _answer(self, name: str, question: Message) -> Message | None:
        answer = self._members[name].respond(question)
        if answer is None:
            return None
        stamped = self._stamp(answer, name, answers=question.sender)
        return stamped if self._audience(stamped) else None

    def _is_in_time(self, answer: Message, asker: str) -> bool:
        """Whether an answer comes within the step; one that is late comes like any other message."""
        delay = self._transit.delay(answer, asker, self._spoken[answer.sender])
        if isinstance(delay, int) and delay > 0:
            self._transit.hold(answer, asker, delay)
        return delay == 0

    def _post(self, message: Message, audience: Iterable[str]) -> None:
        """Send off a message; it arrives at the next step, or as much later as the radio delays it."""
        index = self._spoken[message.sender]
        for name in audience:
            delay = self._transit.delay(message, name, index)
            if isinstance(delay, int):
                self._transit.hold(message, name, 1 + delay)

    def _audience(self, message: Message) -> list[str]:
        if message.kind is MessageKind.TEAM and message.sender in self._strangers:
            self.undeliverable += 1
            return []
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
        self._spoken[sender] += 1
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
