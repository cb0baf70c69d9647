"""Intervals over houses, against what can be computed by hand or simulated."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.intervals import clustered_interval


def test_a_constant_has_no_width():
    interval = clustered_interval([2.0] * 6, ["a", "a", "b", "b", "c", "c"])
    assert (interval.mean, interval.low, interval.high) == (2.0, 2.0, 2.0)
    assert interval.excludes_zero


def test_two_houses_give_three_means():
    """Both houses drawn: 0.5; one of them twice: 0 or 1, each in a quarter of the draws."""
    interval = clustered_interval([0.0, 0.0, 1.0, 1.0], ["a", "a", "b", "b"])
    assert (interval.mean, interval.low, interval.high) == (0.5, 0.0, 1.0)
    assert not interval.excludes_zero


def test_all_resamples_of_three_houses():
    sums, sizes = {"a": 3.0, "b": 1.0, "c": 0.0}, {"a": 3, "b": 2, "c": 1}
    means = sorted(
        sum(sums[it] for it in draw) / sum(sizes[it] for it in draw)
        for draw in itertools.product("abc", repeat=3)
    )
    interval = clustered_interval([1, 1, 1, 1, 0, 0], ["a", "a", "a", "b", "b", "c"], level=0.6)
    low, high = np.quantile(means, [0.2, 0.8], method="inverted_cdf")
    assert interval.low == pytest.approx(low)
    assert interval.high == pytest.approx(high)


def test_houses_count_and_not_episodes():
    """The same ten outcomes, as ten houses of ten tasks each and as a hundred houses."""
    outcomes = [float(house % 2) for house in range(10) for _ in range(10)]
    few = clustered_interval(outcomes, [str(house) for house in range(10) for _ in range(10)])
    many = clustered_interval(outcomes, [str(number) for number in range(100)])
    assert few.high - few.low > 2.5 * (many.high - many.low)


def test_equal_values_give_equal_intervals_whatever_the_houses_are_called():
    values = [0.0, 1.0, 1.0, 0.0, 1.0]
    assert clustered_interval(values, list("abcde")) == clustered_interval(values, list("vwxyz"))


def test_the_interval_holds_the_truth_about_as_often_as_it_says():
    draws = np.random.default_rng(7)
    held = 0
    for _ in range(200):
        rates = draws.beta(2.0, 3.0, size=30)
        outcomes = [float(it) for rate in rates for it in draws.random(3) < rate]
        houses = [str(house) for house in range(30) for _ in range(3)]
        interval = clustered_interval(outcomes, houses, resamples=400)
        held += interval.low <= 0.4 <= interval.high
    assert 0.88 <= held / 200 <= 0.99


@pytest.mark.parametrize(
    ("values", "houses", "level"), [([], [], 0.9), ([1.0], [], 0.9), ([1.0], ["a"], 1.0), ([1.0], ["a"], 0.0)]
)
def test_what_makes_no_sense_is_an_error(values, houses, level):
    with pytest.raises(ConfigurationError):
        clustered_interval(values, houses, level)
