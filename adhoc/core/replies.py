"""What a reply of a language model must look like, and what is made of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

EMPTY, TRUNCATED, UNREADABLE = "empty", "truncated", "unreadable"
ILLEGAL, DUPLICATE, UNKNOWN_ID = "illegal", "duplicate", "unknown id"


class Outcome(str, Enum):
    """How one reply ended, as records count it for every stage.

    Every asked question ends in exactly one of VALID, REPAIRED and INVALID; the others count what was wrong
    with replies or with single entries of them, so that their sum may be larger.
    """

    VALID = "valid"
    """Usable at once, perhaps without some of its entries."""
    REPAIRED = "repaired"
    """Usable after the model was told what was wrong."""
    INVALID = "invalid"
    """Not usable in the end: the planner falls back."""
    ILLEGAL = "illegal"
    """Outside the vocabulary, or beyond what the robot can do."""
    DUPLICATE = "duplicate"
    UNKNOWN_ID = "unknown id"
    """An argument that names nothing in the prompt."""


@dataclass(frozen=True)
class Fault:
    """What was wrong with one entry of a reply that is usable without it."""

    outcome: str
    """`illegal`, `duplicate` or `unknown id`."""
    detail: str


@dataclass(frozen=True)
class Reading:
    """What was read from a reply."""

    value: Any
    faults: tuple[Fault, ...] = ()


@dataclass(frozen=True)
class ReplyFormat:
    """The form that a reply must have.

    `schema` is a JSON schema, for models that can be held to one. `read` makes a value of a reply's text,
    leniently as to form and strictly as to content; it raises ReplyError if there is nothing usable.
    """

    name: str
    schema: Mapping[str, Any]
    read: Callable[[str], Reading]
