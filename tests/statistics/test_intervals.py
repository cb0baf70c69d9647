"""Intervals over houses, against what can be computed by hand or simulated."""

from __future__ import annotations

import itertools
import math
from statistics import NormalDist

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.intervals import (
    LEAST_HOUSES,
    Sample,
    clustered_interval,
    clustered_intervals,
    expanded_tail,
)


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
    interval = clustered_interval(
        [1, 1, 1, 1, 0, 0], ["a", "a", "a", "b", "b", "c"], level=0.6, expanded=False
    )
    low, high = np.quantile(means, [0.2, 0.8], method="inverted_cdf")
    assert interval.low == pytest.approx(low)
    assert interval.high == pytest.approx(high)


def test_tails_are_cut_off_further_out_for_few_houses():
    """For three, t(0.975, 2) = 4.30265 times sqrt(3 / 2) is 5.26965, beyond which a normal has 6.8e-8."""
    assert expanded_tail(0.95, 3) == pytest.approx(6.83e-8, rel=0.01)
    assert expanded_tail(0.95, 10) == pytest.approx(NormalDist().cdf(-2.26216 * math.sqrt(10 / 9)), rel=1e-4)
    assert expanded_tail(0.95, 100_000) == pytest.approx(0.025, rel=1e-3)


def test_one_house_tells_nothing_of_others():
    interval = clustered_interval([1.0, 1.0, 0.0], ["a", "a", "a"])
    assert (interval.low, interval.high) == (-math.inf, math.inf)
    assert not interval.excludes_zero
    assert not interval.tells_spread
    assert not clustered_interval([1.0, 1.0], ["a", "b"]).tells_spread


@pytest.mark.parametrize("houses", [2, LEAST_HOUSES - 1, LEAST_HOUSES])
def test_few_houses_tell_no_spread(houses):
    values = [float(it % 2) for it in range(houses)]
    interval = clustered_interval(values, list(map(str, range(houses))))
    assert interval.houses == houses
    assert interval.low < interval.high
    assert interval.tells_spread is (houses >= LEAST_HOUSES)


def test_many_samples_get_what_each_gets_alone():
    """Also of different numbers of houses, and more than are computed at once."""
    draws = np.random.default_rng(3)
    samples = []
    for number in range(230):
        houses = [f"house {it // 2}" for it in range(20 if number % 3 else 30)]
        samples.append(Sample.of(draws.integers(0, 2, len(houses)).astype(float), houses))
    together = clustered_intervals(samples)
    for number in (0, 1, 2, 150, 229):
        assert together[number] == clustered_intervals([samples[number]])[0]


@given(st.lists(st.tuples(st.floats(-5.0, 5.0), st.sampled_from("abcde")), min_size=1, max_size=30))
def test_intervals_hold_their_mean_and_stay_among_the_values(pairs):
    values, houses = zip(*pairs)
    interval = clustered_interval(values, houses, resamples=200)
    assert interval.low - 1e-9 <= interval.mean <= interval.high + 1e-9 or len(set(values)) > 1
    if len(set(houses)) > 1:
        assert min(values) - 1e-9 <= interval.low <= interval.high <= max(values) + 1e-9


@given(st.floats(-3.0, 3.0), st.floats(0.1, 4.0))
def test_shifted_and_scaled_values_have_shifted_and_scaled_intervals(shift, scale):
    values, houses = [0.0, 1.0, 1.0, 0.0, 1.0, 3.0], list("aabbcd")
    plain = clustered_interval(values, houses, resamples=300)
    moved = clustered_interval([shift + scale * it for it in values], houses, resamples=300)
    for name in ("mean", "low", "high"):
        assert getattr(moved, name) == pytest.approx(shift + scale * getattr(plain, name), abs=1e-9)


def test_houses_count_and_not_episodes():
    """The same ten outcomes, as ten houses of ten tasks each and as a hundred houses."""
    outcomes = [float(house % 2) for house in range(10) for _ in range(10)]
    few = clustered_interval(outcomes, [str(house) for house in range(10) for _ in range(10)])
    many = clustered_interval(outcomes, [str(number) for number in range(100)])
    assert few.high - few.low > 2.5 * (many.high - many.low)


def test_equal_values_give_equal_intervals_whatever_the_houses_are_called():
    values = [0.0, 1.0, 1.0, 0.0, 1.0]
    assert clustered_interval(values, list("abcde")) == clustered_interval(values, list("vwxyz"))


@pytest.mark.parametrize(
    ("values", "houses", "level"),
    [
        ([], [], 0.9),
        ([1.0], [], 0.9),
        ([1.0], ["a"], 1.0),
        ([1.0], ["a"], 0.0),
        ([float("nan")], ["a"], 0.9),
        ([float("inf")], ["a"], 0.9),
    ],
)
def test_what_makes_no_sense_is_an_error(values, houses, level):
    with pytest.raises(ConfigurationError):
        clustered_interval(values, houses, level)
