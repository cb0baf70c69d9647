"""How often intervals hold the truth, in simulated benchmarks where it is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adhoc.statistics.intervals import LEVEL, FloatArray, Interval, Sample, clustered_intervals
from adhoc.statistics.simulated import SimulatedBenchmarks

RESAMPLES = 2_000
"""Fewer than for a table: over many benchmarks what single intervals lack in precision averages out."""


@dataclass(frozen=True)
class Coverage:
    """The share of benchmarks whose interval holds the truth."""

    success: float
    """Of the success rate of the first policy."""
    difference: float
    """Of the difference between the first two."""


def coverage(
    simulated: SimulatedBenchmarks, level: float = LEVEL, resamples: int = RESAMPLES, expanded: bool = True
) -> Coverage:
    """Measure the intervals of `clustered_intervals` on benchmarks with at least two policies."""
    outcomes = simulated.successes.astype(np.float64).sum(axis=2)
    tasks = simulated.successes.shape[2]
    shares = [
        _held(values, truth, tasks, level, resamples, expanded)
        for values, truth in (
            (outcomes[:, :, 0], simulated.rates[:, 0]),
            (outcomes[:, :, 0] - outcomes[:, :, 1], simulated.rates[:, 0] - simulated.rates[:, 1]),
        )
    ]
    return Coverage(*shares)


def _held(
    sums: FloatArray, truth: FloatArray, tasks: int, level: float, resamples: int, expanded: bool
) -> float:
    sizes = np.full(sums.shape[1], float(tasks))
    samples = [Sample(houses, sizes) for houses in sums]
    intervals = clustered_intervals(samples, level, resamples, expanded=expanded)
    return sum(_holds(it, float(value)) for it, value in zip(intervals, truth)) / len(intervals)


def _holds(interval: Interval, truth: float) -> bool:
    return interval.low - 1e-12 <= truth <= interval.high + 1e-12
