"""How far a mean over episodes can be trusted: bootstrap intervals over houses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.core.errors import ConfigurationError
from adhoc.core.streams import stream

RESAMPLES = 10_000
LEVEL = 0.95
_AT_ONCE = 500
"""Resamples that are drawn at once, to bound memory."""


@dataclass(frozen=True)
class Interval:
    """A mean, and the interval that holds it at the level asked for."""

    mean: float
    low: float
    high: float

    @property
    def excludes_zero(self) -> bool:
        """Whether a difference of nothing is outside."""
        return not self.low <= 0.0 <= self.high


def clustered_interval(
    values: Sequence[float],
    clusters: Sequence[str],
    level: float = LEVEL,
    resamples: int = RESAMPLES,
    seed: int = 0,
) -> Interval:
    """The mean of `values` with a percentile bootstrap interval that resamples whole clusters.

    Tasks in one house share its rooms and doors, so that their outcomes are not independent: houses are
    drawn with replacement, each with all of its tasks. With fewer than about ten clusters such intervals are
    too narrow.

    Args:
        values: One number per episode; for differences, that of the paired episodes.
        clusters: The house of each.
        level: Between 0 and 1.
        resamples: How many times the houses are drawn.
        seed: Of the draws; equal values give equal intervals.

    Raises:
        ConfigurationError: no values, not one cluster for each, or a level that is none.
    """
    if not values or len(values) != len(clusters):
        raise ConfigurationError(f"{len(values)} values in {len(clusters)} clusters: need one for each")
    if not 0.0 < level < 1.0:
        raise ConfigurationError(f"level={level}: must be between 0 and 1")
    _, of = np.unique(np.asarray(clusters), return_inverse=True)
    sums = np.bincount(of, np.asarray(values, dtype=np.float64)).astype(np.float64)
    sizes = np.bincount(of).astype(np.float64)
    draws = stream(seed, "bootstrap")
    means = np.concatenate(
        [
            _means(draws, sums, sizes, min(_AT_ONCE, resamples - start))
            for start in range(0, resamples, _AT_ONCE)
        ]
    )
    low, high = np.quantile(means, [(1.0 - level) / 2.0, (1.0 + level) / 2.0])
    return Interval(float(sums.sum() / sizes.sum()), float(low), float(high))


def _means(
    draws: np.random.Generator, sums: NDArray[np.float64], sizes: NDArray[np.float64], count: int
) -> NDArray[np.float64]:
    """Means of so many resamples: `sums` and `sizes` (C,) of the clusters, result (count,)."""
    times = draws.multinomial(len(sums), np.full(len(sums), 1.0 / len(sums)), size=count)
    return np.asarray((times @ sums) / (times @ sizes))
