"""How far a mean over episodes can be trusted: bootstrap intervals over houses."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from adhoc.core.errors import ConfigurationError
from adhoc.core.streams import stream
from adhoc.statistics.student import student_quantile

RESAMPLES = 10_000
LEVEL = 0.95
LEAST_HOUSES = 5
"""With fewer houses an interval is not told: it would hold the truth far less often than its level says."""
_DRAWN_AT_ONCE = 1_000_000
"""Clusters of resamples that are drawn at once, and means that are held at once, to bound memory."""

FloatArray = NDArray[np.float64]
Values = Sequence[float] | FloatArray
"""One number for each episode."""
Houses = Sequence[str] | NDArray[np.str_]
"""The house of each episode."""


@dataclass(frozen=True)
class Interval:
    """A mean, and the interval that holds it at the level asked for."""

    mean: float
    low: float
    high: float
    houses: int | None = None
    """How many it was resampled from; None where that is not known."""

    @property
    def excludes_zero(self) -> bool:
        """Whether a difference of nothing is outside."""
        return not self.low <= 0.0 <= self.high

    @property
    def tells_spread(self) -> bool:
        """Whether the values said enough of how far they scatter: not where all houses are alike (no
        width), and not with fewer than `LEAST_HOUSES` (with a single one there are no bounds at all)."""
        is_of_few = self.houses is not None and self.houses < LEAST_HOUSES
        return math.isfinite(self.high - self.low) and self.high > self.low and not is_of_few


@dataclass(frozen=True)
class Sample:
    """Values of episodes in houses, as all that a mean over whole houses needs."""

    sums: FloatArray
    """(C,) sum of the values of each house."""
    sizes: FloatArray
    """(C,) episodes of each house."""

    @classmethod
    def of(cls, values: Values, clusters: Houses) -> Sample:
        """One number and one house for each episode. Raises ConfigurationError for none, not one house for
        each, or a number that is not finite."""
        numbers = np.asarray(values, dtype=np.float64)
        if numbers.size == 0 or len(numbers) != len(clusters):
            raise ConfigurationError(
                f"{len(numbers)} values in {len(clusters)} clusters: need one for each, and at least one"
            )
        if not np.isfinite(numbers).all():
            raise ConfigurationError(f"value {numbers[~np.isfinite(numbers)][0]}: must be a finite number")
        _, of = np.unique(np.asarray(clusters), return_inverse=True)
        return cls(np.bincount(of, numbers).astype(np.float64), np.bincount(of).astype(np.float64))

    @property
    def mean(self) -> float:
        """Over episodes."""
        return float(self.sums.sum() / self.sizes.sum())


def clustered_interval(
    values: Values,
    clusters: Houses,
    level: float = LEVEL,
    resamples: int = RESAMPLES,
    seed: int = 0,
    expanded: bool = True,
) -> Interval:
    """The mean of `values` with a bootstrap interval that resamples whole clusters.

    Tasks in one house share its rooms and doors, so that their outcomes are not independent: houses are
    drawn with replacement, each with all of its tasks. The interval lies between two quantiles of the
    means so drawn, a little further out than `level` says (see `expanded_tail`). A single house tells
    nothing of others: its interval is everything. `docs/statistics.md` says how often such intervals hold
    the truth.

    Args:
        values: One number per episode; for differences, that of the paired episodes.
        clusters: The house of each.
        level: Between 0 and 1.
        resamples: How many times the houses are drawn.
        seed: Of the draws; equal values give equal intervals.
        expanded: False for the plain percentile interval, to compare with other work: it is too narrow for
            few clusters.

    Raises:
        ConfigurationError: no values, not one cluster for each, or a level that is none.
    """
    return clustered_intervals([Sample.of(values, clusters)], level, resamples, seed, expanded)[0]


def clustered_intervals(
    samples: Sequence[Sample],
    level: float = LEVEL,
    resamples: int = RESAMPLES,
    seed: int = 0,
    expanded: bool = True,
) -> list[Interval]:
    """The same for many samples, in their order: those of equally many houses share the draws, so that
    hundreds take little longer than one. Each gets the interval that it gets alone.

    Raises:
        ConfigurationError: a level that is none, or no resamples.
    """
    if not 0.0 < level < 1.0:
        raise ConfigurationError(f"level={level}: must be between 0 and 1")
    if resamples < 1:
        raise ConfigurationError(f"resamples={resamples}: must be at least 1")
    found: dict[int, Interval] = {}
    by_houses: dict[int, list[int]] = {}
    for number, sample in enumerate(samples):
        by_houses.setdefault(len(sample.sums), []).append(number)
    at_once = max(1, _DRAWN_AT_ONCE // resamples)
    for houses, numbers in by_houses.items():
        if houses == 1:
            found.update((it, Interval(samples[it].mean, -math.inf, math.inf, 1)) for it in numbers)
            continue
        tail = expanded_tail(level, houses) if expanded else 0.5 - 0.5 * level
        for start in range(0, len(numbers), at_once):
            some = numbers[start : start + at_once]
            found.update(zip(some, _intervals([samples[it] for it in some], tail, resamples, seed)))
    return [found[number] for number in range(len(samples))]


def expanded_tail(level: float, clusters: int) -> float:
    """The share of resampled means that is cut off at each end, for at least two clusters.

    The bootstrap of few clusters scatters too little: by sqrt((C - 1) / C), and like a normal where a
    Student's t is due. Quantiles at Phi(-sqrt(C / (C - 1)) t) instead of (1 - level) / 2 make up for both
    and still stay between the smallest and the largest value that is possible (Hesterberg, What Teachers
    Should Know about the Bootstrap, The American Statistician 69, 2015, section 'expanded percentile
    interval').
    """
    quantile = student_quantile(0.5 + 0.5 * level, clusters - 1)
    return NormalDist().cdf(-math.sqrt(clusters / (clusters - 1)) * quantile)


def _intervals(samples: Sequence[Sample], tail: float, resamples: int, seed: int) -> Iterator[Interval]:
    houses = len(samples[0].sums)
    sums, sizes = (np.stack(columns, axis=1) for columns in zip(*((it.sums, it.sizes) for it in samples)))
    at_once = max(1, _DRAWN_AT_ONCE // houses)
    draws = stream(seed, "bootstrap")
    means = np.concatenate(
        [
            _means(draws, sums, sizes, min(at_once, resamples - start))
            for start in range(0, resamples, at_once)
        ]
    )
    lows, highs = np.quantile(means, [tail, 1.0 - tail], axis=0)
    for sample, low, high in zip(samples, lows, highs):
        yield Interval(sample.mean, float(low), float(high), houses)


def _means(draws: np.random.Generator, sums: FloatArray, sizes: FloatArray, count: int) -> FloatArray:
    """Means of so many resamples (count, M): `sums` and `sizes` (C, M) of the clusters of M samples."""
    houses = len(sums)
    drawn = draws.integers(houses, size=(count, houses)) + houses * np.arange(count)[:, None]
    times = np.bincount(drawn.ravel(), minlength=count * houses).reshape(count, houses).astype(np.float64)
    return np.asarray((times @ sums) / (times @ sizes))
