"""What scenarios are drawn from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Ranges:
    """What is drawn, and from where. The defaults are the paper's where it says."""

    misplaced: tuple[int, int] = (1, 5)
    """Fewest and most misplaced objects (k of the paper)."""
    teammates: tuple[int, int] = (3, 5)
    heights: tuple[float, ...] = (0.9, 1.6)
    """Camera heights in metres."""
    payload: tuple[float, float] = (0.1, 20.0)
    """Kilograms, uniform."""
    max_steps: tuple[int, int] = (50, 500)
    """Battery, in steps, uniform, both ends included."""
    can_manipulate: float = 0.5
    """Probability of the manipulation ability. The paper says 'randomly'."""
    floor: float = 0.5
    """Probability that an object is dropped on the floor rather than put on an unreasonable receptacle.
    The paper says 'or'. Objects that may lie on the floor are never dropped there."""
    apart: float = 0.75
    """Metres between the robots' starting positions, at least. The paper is silent."""
    crowded: float = 0.5
    """The same for a house that is too small for `apart`."""


PAPER_RANGES = Ranges()
"""What the paper draws from."""


def between(generator: np.random.Generator, bounds: tuple[int, int]) -> int:
    """A whole number, uniform, both bounds included."""
    return int(generator.integers(bounds[0], bounds[1], endpoint=True))
