"""How a person plays: when it is asked, how often, and what happens when it has left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from adhoc.core.errors import ConfigurationError


class Asked(str, Enum):
    """When a person is asked while something is being done. When nothing is, always."""

    STEPS = "steps"
    """At every step."""
    EVENTS = "events"
    """When something has happened: things found that need attention, a robot that joined or stopped."""
    ENDS = "ends"
    """Never before it is over."""


class AtEnd(str, Enum):
    """What becomes of a robot whose person has left, once it has finished what it is at."""

    STOP = "stop"
    WAIT = "wait"


@dataclass(frozen=True)
class Manner:
    """The settings of `HumanPolicy` of the same names, checked."""

    asked: Asked
    at_end: AtEnd
    answers_itself: bool
    """Whether the robot answers from memory, without the person."""
    tries: int
    lines: int

    @classmethod
    def of(cls, asked: str, answers: str, at_end: str, tries: int, lines: int, at: str) -> Manner:
        """Read them. `at` is where they are configured. Raises ConfigurationError if one is out of range."""
        manner = cls(
            Asked(_one_of(f"{at}.asked", asked, [it.value for it in Asked])),
            AtEnd(_one_of(f"{at}.at_end", at_end, [it.value for it in AtEnd])),
            _one_of(f"{at}.answers", answers, ["memory", "person"]) == "memory",
            tries,
            lines,
        )
        for name, count in (("tries", tries), ("lines", lines)):
            if count < 1:
                raise ConfigurationError(f"{at}.{name}={count}: must be at least 1")
        return manner


def _one_of(key: str, value: str, known: Sequence[str]) -> str:
    if value not in known:
        raise ConfigurationError(f"{key}={value}: must be one of {', '.join(known)}")
    return value
