"""Two policies on the same tasks: the differences, and how far their mean can be trusted."""

from __future__ import annotations

import numpy as np

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.intervals import (
    LEVEL,
    RESAMPLES,
    FloatArray,
    Houses,
    Interval,
    Values,
    clustered_interval,
)


def paired_differences(first: Values, second: Values, houses: Houses) -> FloatArray:
    """What the first has over the second in each task, of any metric.

    Raises:
        ConfigurationError: no tasks, or not one value of each and one house for every task.
    """
    if not len(first) == len(second) == len(houses) or not len(first):
        raise ConfigurationError(
            f"{len(first)} and {len(second)} values in {len(houses)} houses: need one of each for every task"
        )
    return np.asarray(first, dtype=np.float64) - np.asarray(second, dtype=np.float64)


def success_differences(first: Values, second: Values, houses: Houses) -> FloatArray:
    """The same of success: 1 where only the first succeeded, -1 where only the second did, else 0.

    Raises:
        ConfigurationError: as above, or an outcome that is neither 0 nor 1.
    """
    for outcomes in (first, second):
        numbers = np.asarray(outcomes, dtype=np.float64)
        wrong = numbers[(numbers != 0.0) & (numbers != 1.0)]
        if wrong.size:
            raise ConfigurationError(f"success {wrong[0]:g}: must be 1 or 0")
    return paired_differences(first, second, houses)


def paired_interval(
    first: Values,
    second: Values,
    houses: Houses,
    level: float = LEVEL,
    resamples: int = RESAMPLES,
    seed: int = 0,
) -> Interval:
    """The mean difference of any metric on the same tasks, with its bootstrap interval over houses.

    Differences are taken in each task before anything is averaged, so that what makes a task hard for both
    does not widen the interval. Arguments and errors are those of `clustered_interval`.
    """
    return clustered_interval(paired_differences(first, second, houses), houses, level, resamples, seed)
