"""What a robot has gone through in an episode, as one short text: equal for equal situations."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable

from adhoc.core.messages import Message
from adhoc.core.values import Capability, Observation

_LENGTH = 12
_DIGITS = 6


class Situation:
    """A chain of hashes over all that a robot perceived, heard and was asked, and that its person typed.

    A person who meets the same situation again is taken to type the same again. What is in view counts by
    its ids; single pixels do not.
    """

    def __init__(self, me: str, capability: Capability, seed: int) -> None:
        self.digest = ""
        """12 hexadecimal digits."""
        self._add(me, vars(capability), seed)

    def see(self, observation: Observation, inbox: Iterable[Message]) -> None:
        """The robot begins a step."""
        pose, result = observation.pose, observation.last_result
        self._add(
            observation.step,
            [round(value, _DIGITS) for value in (pose.x, pose.y, pose.yaw, pose.pitch)],
            observation.held,
            observation.steps_left,
            None if result is None else [str(result.action), result.failure, result.detail],
            sorted(label.id for label in observation.labels.values()),
            [_text(message) for message in inbox],
        )

    def ask(self, message: Message) -> None:
        """Another robot asks it something."""
        self._add("asked", _text(message))

    def type(self, text: str) -> None:
        """The person types a line."""
        self._add("typed", text)

    def _add(self, *parts: object) -> None:
        text = json.dumps([self.digest, *parts], sort_keys=True, default=str)
        self.digest = hashlib.sha256(text.encode("utf-8", "backslashreplace")).hexdigest()[:_LENGTH]


def _text(message: Message) -> list[object]:
    return [message.sender, message.recipient, message.kind.value, message.text, dict(message.payload)]
