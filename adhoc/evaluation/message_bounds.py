"""What the radio lets through of a message: clean text of bounded length, a payload of bounded size."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from adhoc.core.errors import ConfigurationError
from adhoc.core.messages import Message, MessageKind
from adhoc.prompting.clean import name, one_line

MAX_TEXT = 8000
"""Characters of a message's text; what is longer is cut off."""
MAX_STRING = 1000
"""Characters of one text in a payload."""
MAX_VALUES = 20_000
"""Values in one payload, keys not counted."""
MAX_DEPTH = 8
"""Lists and objects inside each other; the library's own payloads have 4."""
MAX_INTEGER = 2**53
"""Integers beyond it are no JSON numbers that everybody reads alike."""
MAX_MESSAGES = 64
"""Messages of one robot in one step, and questions likewise."""
RESERVED_NAMES = frozenset({"me", "you", "all", "none", "unknown", "nothing"})
"""What prompts and memories say for something else than a robot of that name."""


class PayloadTooLarge(Exception):
    """A payload has too many values, is too deep, or holds a number that is too large."""


def is_message(value: object) -> bool:
    """Whether it is a `Message` whose fields have their types; of the payload, see `clean_payload`."""
    return (
        isinstance(value, Message)
        and isinstance(value.kind, MessageKind)
        and isinstance(value.text, str)
        and isinstance(value.recipient, (str, type(None)))
        and isinstance(value.payload, Mapping)
    )


def clean_recipient(recipient: str | None) -> str | None:
    """The name as it may stand in a log; that of a robot stays as it is."""
    return None if recipient is None else name(recipient)


def clean_text(text: str) -> str:
    """The text on one line, without control, formatting and reserved characters, cut at MAX_TEXT."""
    return one_line(text, MAX_TEXT)


def clean_payload(payload: Mapping[str, Any]) -> dict[str, Any]:
    """A copy in plain JSON values, whose texts are clean and cut at MAX_STRING.

    Raises:
        PayloadTooLarge: It passes a bound.
        TypeError, ValueError: It holds something other than JSON values.
    """
    copied: dict[str, Any] = _Copier().copy(payload, MAX_DEPTH)
    return copied


def check_robot_name(robot: str) -> None:
    """Raises ConfigurationError for a name that could be taken for another robot's or for prompt text."""
    if robot.casefold() in RESERVED_NAMES or name(robot) != robot:
        raise ConfigurationError(
            f"a robot cannot be called {robot!r}: names are one line of at most 160 characters without "
            f"brackets, quotes, ';' and ': ', and none of {', '.join(sorted(RESERVED_NAMES))}"
        )


class _Copier:
    def __init__(self) -> None:
        self._left = MAX_VALUES

    def copy(self, value: Any, depth: int) -> Any:
        self._left -= 1
        if self._left < 0 or depth < 0:
            raise PayloadTooLarge
        if value is None or isinstance(value, bool):
            return value
        if isinstance(value, str):
            return one_line(value, MAX_STRING)
        if isinstance(value, (int, float)):
            return _number(value)
        if isinstance(value, Mapping):
            return {_key(key): self.copy(it, depth - 1) for key, it in value.items()}
        if isinstance(value, (list, tuple)):
            return self._list(value, depth - 1)
        raise TypeError(f"{type(value).__name__} is no JSON value")

    def _list(self, values: Sequence[Any], depth: int) -> list[Any]:
        return [self.copy(it, depth) for it in values]


def _key(key: Any) -> str:
    if not isinstance(key, str):
        raise TypeError(f"the key {key!r} is no text")
    return one_line(key, MAX_STRING)


def _number(value: int | float) -> int | float:
    if isinstance(value, int):
        if abs(value) > MAX_INTEGER:
            raise PayloadTooLarge
        return int(value)
    if not math.isfinite(value):
        raise ValueError(f"{value} is no JSON number")
    return float(value)
