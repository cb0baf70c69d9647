"""What the methods promise, held against simulated benchmarks whose truth is known."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.coverage import coverage
from adhoc.statistics.intervals import Sample, clustered_intervals
from adhoc.statistics.many import holm
from adhoc.statistics.paired_tests import mcnemar, sign_flip_test
from adhoc.statistics.simulated import Effects, simulate

BENCHMARKS = 1000


USUAL = Effects()


def simulated(houses, tasks, effects=USUAL, low=0.15, high=0.5, count=BENCHMARKS):
    draws = np.random.default_rng(2024)
    first = draws.uniform(low, high, count)
    rates = np.stack([first, first + draws.uniform(0.0, 0.1, count)], axis=1)
    return simulate(draws, count, houses, tasks, rates, effects)


@pytest.mark.parametrize(
    ("houses", "tasks", "effects"),
    [
        (90, 15, USUAL),
        (90, 15, Effects(house=1.0, own=0.6)),
        (30, 15, USUAL),
        (30, 3, USUAL),
        (30, 1, USUAL),
        (15, 2, USUAL),
    ],
)
def test_intervals_hold_the_truth_in_92_to_97_of_100_benchmarks(houses, tasks, effects):
    found = coverage(simulated(houses, tasks, effects), resamples=1000)
    assert 0.92 <= found.success <= 0.97
    assert 0.92 <= found.difference <= 0.97


def test_plain_percentile_intervals_of_few_houses_are_too_narrow():
    drawn = simulated(10, 15)
    plain, used = (coverage(drawn, resamples=1000, expanded=expanded) for expanded in (False, True))
    assert plain.success < 0.91 < used.success
    assert plain.difference < 0.91 < used.difference


def test_houses_may_have_different_numbers_of_tasks():
    """From 2 to 15 of 15 tasks were done."""
    drawn = simulated(40, 15)
    sizes = np.random.default_rng(6).integers(2, 16, (BENCHMARKS, 40))
    done = np.arange(15) < sizes[..., None]
    gains = drawn.successes[..., 1].astype(float) - drawn.successes[..., 0]
    sums = (gains * done).sum(axis=2)
    samples = [Sample(*house) for house in zip(sums, sizes.astype(float))]
    truth = drawn.rates[:, 1] - drawn.rates[:, 0]
    found = clustered_intervals(samples, resamples=1000)
    assert 0.92 <= np.mean([it.low <= value <= it.high for it, value in zip(found, truth)]) <= 0.97


def test_other_levels_hold_what_they_say():
    assert 0.77 <= coverage(simulated(30, 5), level=0.8, resamples=1000).success <= 0.83


def test_true_rates_are_those_asked_for():
    drawn = simulate(np.random.default_rng(1), 1, 40_000, 2, [0.15, 0.4, 0.8])
    assert np.allclose(drawn.successes.mean(axis=(0, 1, 2)), [0.15, 0.4, 0.8], atol=0.01)
    assert drawn.rates.tolist() == [[0.15, 0.4, 0.8]]


def test_episodes_of_one_house_and_of_one_task_resemble_each_other():
    drawn = simulate(np.random.default_rng(1), 1, 40_000, 2, [0.4, 0.4]).successes[0].astype(float)
    in_house = np.corrcoef(drawn[:, 0, 0], drawn[:, 1, 0])[0, 1]
    on_task = np.corrcoef(drawn[:, 0, 0], drawn[:, 0, 1])[0, 1]
    assert 0.07 < in_house < 0.15 < on_task < 0.4


@pytest.mark.parametrize("rates", [[0.0, 0.5], [0.5, 1.0]])
def test_rates_that_are_none_are_an_error(rates):
    with pytest.raises(ConfigurationError):
        simulate(np.random.default_rng(0), 1, 2, 2, rates)


def test_equal_policies_are_told_apart_by_houses_in_at_most_5_of_100_benchmarks():
    """McNemar's test takes tasks for independent, and errs far more often where houses suit policies."""
    drawn = simulate(np.random.default_rng(4), BENCHMARKS, 90, 15, [0.4, 0.4], Effects(own=0.6)).successes
    gains = drawn[..., 0].astype(int) - drawn[..., 1]
    wins, losses = (gains > 0).sum(axis=(1, 2)), (gains < 0).sum(axis=(1, 2))
    by_houses = np.mean([sign_flip_test(it) <= 0.05 for it in gains.sum(axis=2).tolist()])
    by_tasks = np.mean([mcnemar(*counts) <= 0.05 for counts in zip(wins.tolist(), losses.tolist())])
    assert 0.03 <= by_houses <= 0.07
    assert by_tasks > 0.15


def test_mcnemar_keeps_its_level_where_houses_suit_no_policy():
    drawn = simulate(np.random.default_rng(4), BENCHMARKS, 90, 15, [0.4, 0.4], Effects(own=0.0)).successes
    gains = drawn[..., 0].astype(int) - drawn[..., 1]
    wins, losses = (gains > 0).sum(axis=(1, 2)), (gains < 0).sum(axis=(1, 2))
    by_tasks = np.mean([mcnemar(*counts) <= 0.05 for counts in zip(wins.tolist(), losses.tolist())])
    assert 0.02 <= by_tasks <= 0.07


def test_a_family_of_equal_policies_is_cleared_in_at_least_95_of_100_benchmarks():
    drawn = simulate(np.random.default_rng(9), 300, 40, 5, [0.3] * 5, Effects(own=0.4)).successes
    outcomes = drawn.astype(int).sum(axis=2)
    accused = alone = 0
    for benchmark in outcomes:
        p_values = [
            sign_flip_test((benchmark[:, one] - benchmark[:, other]).tolist())
            for one, other in itertools.combinations(range(5), 2)
        ]
        accused += min(holm(p_values)) <= 0.05
        alone += min(p_values) <= 0.05
    assert accused / 300 <= 0.075
    assert alone / 300 > 0.12
