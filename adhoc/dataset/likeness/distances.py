"""Distances between two samples, and how large they are by chance alone.

Both distances run from 0 (equal) to 1 (nothing in common) and have no unit, so that statistics of metres,
square metres and counts can stand in one table.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

Sample = TypeVar("Sample")

SPLITS = 50
"""Random halvings that a noise floor is the mean of."""


def kolmogorov_smirnov(first: ArrayLike, second: ArrayLike) -> float:
    """The largest gap between the empirical distribution functions of two samples of numbers.

    Args:
        first: Numbers of any unit, in any order; shape (n,).
        second: Numbers of the same unit; shape (m,).

    Returns:
        A distance in [0, 1]. Of two samples of one distribution it is about `0.87 * sqrt(1/n + 1/m)`.

    Raises:
        ValueError: A sample is empty.
    """
    a, b = np.sort(np.asarray(first, dtype=float)), np.sort(np.asarray(second, dtype=float))
    if not len(a) or not len(b):
        raise ValueError(
            "a sample is empty: the Kolmogorov-Smirnov distance needs at least one number in each"
        )
    steps = np.concatenate([a, b])
    below_a = np.searchsorted(a, steps, side="right") / len(a)
    below_b = np.searchsorted(b, steps, side="right") / len(b)
    return float(np.abs(below_a - below_b).max())


def total_variation(first: Mapping[str, float], second: Mapping[str, float]) -> float:
    """Half the summed difference of two sets of frequencies: the share that would have to change name.

    Args:
        first: Counts or shares by name; they are divided by their sum.
        second: The same; a name that is missing counts 0.

    Returns:
        A distance in [0, 1]. By chance it grows with the number of names.

    Raises:
        ValueError: The counts of a sample add up to nothing.
    """
    a, b = shares(first), shares(second)
    return sum(abs(a.get(name, 0.0) - b.get(name, 0.0)) for name in sorted({*a, *b})) / 2


def shares(counts: Mapping[str, float]) -> dict[str, float]:
    """Counts divided by their sum, most frequent first. Raises ValueError if the sum is 0."""
    total = sum(counts.values())
    if total <= 0:
        raise ValueError("the counts add up to nothing: frequencies need at least one thing counted")
    ranked = sorted(counts.items(), key=lambda entry: (-entry[1], entry[0]))
    return {name: count / total for name, count in ranked}


def noise_floor(
    samples: Sequence[Sample],
    distance: Callable[[Sequence[Sample], Sequence[Sample]], float | None],
    generator: np.random.Generator,
    most: int | None = None,
    splits: int = SPLITS,
) -> float | None:
    """The mean distance of two random halves of one set: a distance below it means nothing.

    Args:
        samples: Independent samples (rooms, say). They are split whole, so that what belongs together, such
            as the objects of one room, stays together.
        distance: Of two halves; None where a half has nothing to compare. Such splits do not count.
        generator: Where the halves are drawn from.
        most: The size of the set that the distances are compared with, if it is known: where it is smaller
            than a half, the second half is drawn as small, since few samples differ more by chance.
        splits: How many halvings to average over.

    Returns:
        The mean distance, or None if no split could be compared. Halves are half as large as the set: the
        noise between the whole set and another of its size is smaller by about the square root of 2.
    """
    half = len(samples) // 2
    if half == 0:
        return None
    found = []
    for _ in range(splits):
        order = generator.permutation(len(samples))
        first, second = order[:half], order[half:][:most]
        value = distance([samples[i] for i in first], [samples[i] for i in second])
        if value is not None:
            found.append(value)
    return float(np.mean(found)) if found else None
