"""What becomes of a message on its way to one robot: it arrives, arrives late, or is lost."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from adhoc.core.errors import ConfigurationError
from adhoc.core.streams import derive_seed

MOST_STEPS = 10_000
"""The longest delay, and the longest jitter, in steps."""
_SEEDS = 2.0**63


@dataclass(frozen=True)
class Link:
    """One way of one message: who sent it when to whom, and how far apart they were.

    `index` is the number of the message among all that its sender said in that step, answers included;
    `distance` is in metres.
    """

    sender: str
    recipient: str
    step: int
    index: int
    distance: float


class Loss(str, Enum):
    """Why a message does not arrive."""

    LOST = "lost"
    OUT_OF_RANGE = "out of range"


@dataclass(frozen=True)
class Radio:
    """A radio with faults; by default it has none, as the paper supposes.

    What happens on one link depends on the seed of the episode and on that link alone, so the presence of one
    robot changes nothing between others. A broadcast may reach some and not others.

    Raises:
        ConfigurationError: a value is out of its range.
    """

    loss: float = 0.0
    """The probability that a message does not reach a robot."""
    delay: int = 0
    """Steps that every message takes longer than without faults."""
    jitter: int = 0
    """A message takes up to so many more steps, each number equally likely; one may overtake another."""
    range: float | None = None
    """Metres within which robots hear each other, at the step of sending; None is without limit. Walls do not
    matter."""

    def __post_init__(self) -> None:
        if not 0.0 <= self.loss <= 1.0:
            raise ConfigurationError(f"loss={self.loss!r}: must be a probability, 0 to 1")
        for name in ("delay", "jitter"):
            steps = getattr(self, name)
            if isinstance(steps, bool) or not isinstance(steps, int) or not 0 <= steps <= MOST_STEPS:
                raise ConfigurationError(f"{name}={steps!r}: must be a number of steps, 0 to {MOST_STEPS}")
        if self.range is not None and not 0.0 <= self.range < math.inf:
            raise ConfigurationError(f"range={self.range!r}: must be metres, at least 0, or null for any")

    def delay_on(self, seed: int, link: Link) -> int | Loss:
        """How many steps late a message arrives on that link, or why it does not."""
        if self.range is not None and link.distance > self.range:
            return Loss.OUT_OF_RANGE
        if self.loss and _uniform(seed, "loss", link) < self.loss:
            return Loss.LOST
        late = int(_uniform(seed, "jitter", link) * (self.jitter + 1)) if self.jitter else 0
        return self.delay + min(late, self.jitter)


def _uniform(seed: int, what: str, link: Link) -> float:
    """A number in [0, 1) of the link's own; a random generator for each would be slower than all else."""
    names = (link.sender, link.recipient, link.step, link.index)
    return min(derive_seed(seed, "radio", what, *names) / _SEEDS, math.nextafter(1.0, 0.0))
