"""Student's t distribution for whole degrees of freedom, without a statistics library."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from adhoc.core.errors import ConfigurationError

_LARGEST = 100_000
"""Degrees of freedom from which the normal distribution stands for Student's (they differ by 1e-5)."""
_HALVINGS = 200


def student_probability(value: float, degrees: int) -> float:
    """P(T <= value) for so many degrees of freedom, at least 1.

    Finite sums in cosines, exact for whole numbers (Abramowitz and Stegun 26.7.3 and 26.7.4).

    Raises:
        ConfigurationError: fewer than one degree of freedom.
    """
    if degrees < 1:
        raise ConfigurationError(f"degrees={degrees}: must be at least 1")
    angle = math.atan(value / math.sqrt(degrees))
    square = math.cos(angle) ** 2
    odd = degrees % 2
    steps = np.arange(1, (degrees - odd) // 2, dtype=np.float64)
    ratios = (2.0 * steps - 1.0 + odd) / (2.0 * steps + odd) * square
    total = 1.0 + float(np.cumprod(ratios).sum())
    if not odd:
        return 0.5 + 0.5 * math.sin(angle) * total
    tail = math.sin(angle) * math.cos(angle) * total if degrees > 1 else 0.0
    return 0.5 + (angle + tail) / math.pi


@lru_cache(maxsize=256)
def student_quantile(probability: float, degrees: int) -> float:
    """The value that T stays below with this probability.

    Raises:
        ConfigurationError: a probability that is not between 0 and 1, or fewer than one degree of freedom.
    """
    if not 0.0 < probability < 1.0:
        raise ConfigurationError(f"probability={probability}: must be between 0 and 1")
    if probability < 0.5:
        return -student_quantile(1.0 - probability, degrees)
    degrees = min(degrees, _LARGEST)
    low, high = 0.0, 1.0
    while student_probability(high, degrees) < probability and high < 1e300:
        low, high = high, 2.0 * high
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if student_probability(middle, degrees) < probability else (low, middle)
    return high
