"""The messages of one episode on their ways to single robots."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from adhoc.core.messages import Message
from adhoc.evaluation.radio import Link, Loss, Radio

Places = Mapping[str, tuple[float, float]]
"""Where robots are: x and y in metres by name."""


@dataclass
class Deliveries:
    """What a faulty radio did, counted for each robot that a message was sent to."""

    lost: int = 0
    out_of_range: int = 0
    delayed: int = 0


@dataclass(frozen=True)
class Coming:
    """A message that is on its way to one robot, until the step in which it is `due`."""

    due: int
    message: Message
    is_question: bool = False
    """Whether an answer is expected when it arrives."""


class Transit:
    """Sends messages over a radio, and holds what has not arrived yet.

    Args:
        radio: What becomes of a message on its way.
        seed: Of the radio's faults.
    """

    def __init__(self, radio: Radio, seed: int) -> None:
        self._radio, self._seed = radio, seed
        self._step = 0
        self._places: Places = {}
        self._coming: dict[str, list[Coming]] = {}
        self.deliveries = Deliveries()

    def begin_step(self, step: int, places: Places) -> None:
        """`places` is where the robots are now; one that it does not name is near everybody."""
        self._step, self._places = step, places

    def delay(self, message: Message, recipient: str, index: int) -> int | Loss:
        """How many steps late a message of this step reaches one robot, or why it does not; it is counted.

        `index` is its number among what its sender says in this step.
        """
        link = Link(message.sender, recipient, self._step, index, self._distance(message.sender, recipient))
        delay = self._radio.delay_on(self._seed, link)
        if delay is Loss.LOST:
            self.deliveries.lost += 1
        elif delay is Loss.OUT_OF_RANGE:
            self.deliveries.out_of_range += 1
        elif delay:
            self.deliveries.delayed += 1
        return delay

    def hold(self, message: Message, recipient: str, steps: int, is_question: bool = False) -> None:
        """Let a message arrive so many steps from now."""
        coming = Coming(self._step + steps, message, is_question)
        self._coming.setdefault(recipient, []).append(coming)

    def take(self, recipient: str) -> list[Coming]:
        """What has arrived for a robot by now, in the order of sending; it is taken out."""
        coming = self._coming.pop(recipient, [])
        self._coming[recipient] = [it for it in coming if it.due > self._step]
        return [it for it in coming if it.due <= self._step]

    def _distance(self, one: str, other: str) -> float:
        if one not in self._places or other not in self._places:
            return 0.0
        return math.dist(self._places[one], self._places[other])
