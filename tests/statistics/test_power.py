"""How many tasks it takes, against hand-computed cases, exact counting and simulation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.paired_tests import mcnemar, sign_flip_test
from adhoc.statistics.power import (
    design_effect,
    detectable_difference,
    episodes_needed,
    mcnemar_power,
    pilot,
)
from adhoc.statistics.power_by_resampling import resampled_power
from adhoc.statistics.simulated import Effects, simulate


def test_connors_formula_by_hand():
    """(1.95996 sqrt(0.3) + 0.84162 sqrt(0.3 - 0.04))^2 / 0.04 = 56.4, and 1 / 0.2 = 5 for whole tasks."""
    assert episodes_needed(0.2, 0.3) == 62
    assert episodes_needed(-0.2, 0.3) == 62
    assert episodes_needed(0.2, 0.3, design_effect=2.0) == 123
    with pytest.raises(ConfigurationError, match=r"design_effect=-1\.0: must be above 0"):
        episodes_needed(0.2, 0.3, design_effect=-1.0)
    assert episodes_needed(0.0, 0.3) == math.inf


def test_the_power_of_few_tasks_by_hand():
    """Six wins of six are the fewest that the test calls beyond chance at 5%: p = 2 / 64."""
    assert mcnemar_power(6, 1.0, 1.0) == pytest.approx(1.0)
    assert mcnemar_power(5, 1.0, 1.0) == 0.0
    assert mcnemar_power(6, 0.5, 0.5) == pytest.approx(0.5**6)
    assert mcnemar_power(6, 0.0, 1.0) == pytest.approx(2 / 64)
    assert mcnemar_power(6, 0.0, 0.0) == 0.0


def test_the_power_is_that_of_simulated_tasks():
    draws = np.random.default_rng(5)
    tables = draws.multinomial(80, [0.22, 0.08, 0.7], size=3000)
    told = np.mean([mcnemar(int(wins), int(losses)) <= 0.05 for wins, losses, _ in tables])
    assert mcnemar_power(80, 0.14, 0.30) == pytest.approx(told, abs=0.03)


@pytest.mark.parametrize("discordant", [0.05, 0.1, 0.2, 0.35, 0.6])
@pytest.mark.parametrize("difference", [0.03, 0.05, 0.1, 0.2, 0.3])
@pytest.mark.parametrize(("level", "power"), [(0.05, 0.8), (0.05, 0.9), (0.005, 0.8)])
def test_as_many_tasks_as_are_needed_have_the_power(difference, discordant, level, power):
    if difference <= discordant:
        needed = int(episodes_needed(difference, discordant, level, power))
        found = mcnemar_power(needed, difference, discordant, level)
        assert power - 0.03 <= found
        if difference < 0.8 * discordant:  # where nearly every discordant task is won, it is a few too many
            assert found <= power + 0.06


@given(st.floats(0.02, 1.0), st.floats(0.0, 1.0), st.floats(1.0, 4.0))
def test_what_is_told_needs_no_more_tasks_than_there_are(difference, discordant, effect):
    pairs = 200
    found = detectable_difference(pairs, discordant, design_effect=effect)
    assert found is not None
    needed = episodes_needed(difference, max(difference, discordant), design_effect=effect)
    if difference >= found:
        assert needed <= pairs
    if difference < found - 1e-9:
        assert needed > pairs


def test_five_tasks_tell_nothing():
    assert detectable_difference(3, 0.5) is None
    assert detectable_difference(30, 0.5, design_effect=math.inf) is None


def test_a_design_effect_by_hand():
    """Two houses of two that are alike inside: squares of sums 4 + 4, of values 4, times 2/1 and 3/4."""
    assert design_effect([1, 1, -1, -1], ["a", "a", "b", "b"]) == pytest.approx(3.0)
    assert design_effect([1, -1, 1, -1], ["a", "a", "b", "b"]) == 1.0
    assert design_effect([1, -1, 1, 0], ["a", "b", "c", "d"]) == 1.0
    assert design_effect([0, 0, 0], ["a", "a", "b"]) == 1.0
    assert design_effect([1, 0], ["a", "a"]) == math.inf


def test_what_a_pilot_tells():
    found = pilot([1, 1, 0, 1], [0, 1, 1, 0], ["a", "a", "b", "b"])
    assert (found.pairs, found.houses, found.difference, found.discordant) == (4, 2, 0.25, 0.75)
    assert found.houses_for(9) == 5
    assert found.houses_for(math.inf) == math.inf


@pytest.mark.parametrize(("tasks", "rates"), [(15, (0.35, 0.45)), (3, (0.2, 0.4)), (1, (0.2, 0.4))])
def test_in_simulated_houses_four_of_five_benchmarks_of_that_size_tell(tasks, rates):
    draws = np.random.default_rng(11)
    gains = _gains(simulate(draws, 1, 5000, tasks, rates))[0]
    effect = design_effect(gains.ravel(), np.repeat(np.arange(5000).astype(str), tasks))
    needed = episodes_needed(rates[1] - rates[0], float(np.abs(gains).mean()), design_effect=effect)
    houses = -int(-needed // tasks)
    by_house = _gains(simulate(draws, 500, houses, tasks, rates)).sum(axis=2)
    told = np.mean([sign_flip_test(it) <= 0.05 for it in by_house.tolist()])
    assert 0.73 <= told <= 0.87


def test_resampling_a_large_pilot_agrees_with_new_houses():
    draws, rates, effects = np.random.default_rng(3), (0.35, 0.45), Effects(own=0.6)
    known = _gains(simulate(draws, 1, 20_000, 5, rates, effects)).sum(axis=2)[0]
    fresh = _gains(simulate(draws, 500, 40, 5, rates, effects)).sum(axis=2)
    told = np.mean([sign_flip_test(it) <= 0.05 for it in fresh.tolist()])
    assert resampled_power(known.tolist(), 40) == pytest.approx(told, abs=0.08)
    assert resampled_power([1], 6, runs=10) == 1.0
    assert resampled_power([1], 5, runs=10) == 0.0


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: episodes_needed(0.3, 0.2),
        lambda: episodes_needed(0.3, 1.2),
        lambda: episodes_needed(0.1, 0.2, level=0.0),
        lambda: episodes_needed(0.1, 0.2, power=1.0),
        lambda: mcnemar_power(10, 0.3, 0.2),
        lambda: resampled_power([], 10),
        lambda: resampled_power([1], 0),
        lambda: pilot([], [], []),
    ],
)
def test_what_makes_no_sense_is_an_error(wrong):
    with pytest.raises(ConfigurationError):
        wrong()


def _gains(drawn):
    outcomes = drawn.successes.astype(int)
    return outcomes[..., 1] - outcomes[..., 0]
