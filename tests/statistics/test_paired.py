"""Differences on the same tasks."""

from __future__ import annotations

import numpy as np
import pytest

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.intervals import clustered_interval
from adhoc.statistics.paired import paired_differences, paired_interval


def test_differences_are_taken_before_means():
    """Tasks of very different length, in all of which the first takes 10 steps less."""
    second = [20.0, 100.0, 300.0, 500.0]
    first = [it - 10.0 for it in second]
    houses = ["a", "b", "c", "d"]
    assert list(paired_differences(first, second, houses)) == [-10.0] * 4
    interval = paired_interval(first, second, houses)
    assert (interval.low, interval.mean, interval.high) == (-10.0, -10.0, -10.0)
    assert clustered_interval(first, houses).low < 200.0


def test_any_metric_may_be_compared():
    draws = np.random.default_rng(0)
    houses = [f"house {number // 3}" for number in range(60)]
    second = draws.uniform(0.0, 1.0, 60)
    first = np.clip(second + 0.2 + draws.normal(0.0, 0.05, 60), None, 2.0)
    interval = paired_interval(first, second, houses)
    assert 0.15 < interval.low < interval.mean < interval.high < 0.25


def test_values_without_partner_are_an_error():
    with pytest.raises(ConfigurationError, match="2 and 1 values in 2 houses"):
        paired_interval([1.0, 2.0], [1.0], ["a", "b"])
