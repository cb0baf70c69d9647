"""Two policies on the same tasks: exact tests against tables that are counted by hand."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.paired_tests import mcnemar, paired_test, sign_flip_test


@pytest.mark.parametrize(
    ("wins", "losses", "p_value"),
    [
        (0, 0, 1.0),
        (1, 0, 1.0),
        (0, 5, 2 / 32),
        (6, 0, 2 / 64),
        (5, 1, 2 * (1 + 6) / 64),
        (2, 8, 2 * (1 + 10 + 45) / 1024),
        (4, 4, 1.0),
    ],
)
def test_mcnemar_is_twice_the_smaller_tail_of_fair_coins(wins, losses, p_value):
    assert mcnemar(wins, losses) == pytest.approx(p_value, abs=0.0, rel=1e-15)


def test_mcnemar_is_exact_for_thousands_of_tasks():
    """Where the normal approximation is good: 100 more of 10,000 are one standard deviation off."""
    assert mcnemar(5050, 4950) == pytest.approx(0.3222, abs=2e-4)
    assert 0.0 < mcnemar(600, 400) < 1e-9


def test_whole_houses_change_sides():
    """Houses of 2, 1 and -1: of the eight sums 4, 2, 2, 0, 0, -2, -2, -4 six are as far from 0 as 2."""
    assert sign_flip_test([2, 1, -1]) == 6 / 8
    assert sign_flip_test([2, 1, 1]) == 2 / 8
    assert sign_flip_test([0, 0]) == sign_flip_test([]) == 1.0


@given(st.lists(st.integers(-4, 4), max_size=9))
def test_by_houses_is_what_counting_all_signs_gives(by_house):
    sums = [
        sum(sign * it for sign, it in zip(signs, by_house))
        for signs in itertools.product((-1, 1), repeat=len(by_house))
    ]
    as_far = sum(abs(it) >= abs(sum(by_house)) for it in sums)
    assert sign_flip_test(by_house) == pytest.approx(as_far / len(sums), rel=1e-12)


@given(st.integers(0, 60), st.integers(0, 60))
def test_with_one_task_in_each_house_both_tests_are_one(wins, losses):
    assert sign_flip_test([1] * wins + [-1] * losses) == pytest.approx(mcnemar(wins, losses), rel=1e-9)


def test_a_table_is_counted():
    test = paired_test([1, 1, 0, 1, 1, 0], [0, 1, 1, 0, 0, 0], ["a", "a", "a", "b", "b", "c"])
    assert (test.pairs, test.houses, test.wins, test.losses) == (6, 3, 3, 1)
    assert test.difference == pytest.approx(2 / 6)
    assert test.p_episodes == 2 * (1 + 4) / 16
    assert test.p_houses == 1.0  # house a is even, and a single house that is not says nothing


def test_houses_that_agree_inside_count_once():
    """Twelve wins in three houses say no more than three coins."""
    test = paired_test([True] * 12, [False] * 12, ["a"] * 4 + ["b"] * 4 + ["c"] * 4)
    assert test.p_episodes == 2 / 4096
    assert test.p_houses == 2 / 8


@pytest.mark.parametrize(
    ("first", "second", "houses"),
    [([], [], []), ([1], [1, 0], ["a", "a"]), ([1, 0], [1, 0], ["a"]), ([0.5], [1], ["a"])],
)
def test_what_is_no_pair_of_outcomes_is_an_error(first, second, houses):
    with pytest.raises(ConfigurationError):
        paired_test(first, second, houses)


def test_negative_counts_are_an_error():
    with pytest.raises(ConfigurationError, match="losses=-1"):
        mcnemar(3, -1)
