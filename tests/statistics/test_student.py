"""Student's t against printed tables."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.student import student_probability, student_quantile


@pytest.mark.parametrize(
    ("probability", "degrees", "value"),
    [
        (0.975, 1, 12.7062047),
        (0.975, 2, 4.30265273),
        (0.975, 5, 2.57058184),
        (0.95, 10, 1.81246112),
        (0.975, 30, 2.04227246),
        (0.995, 100, 2.62589052),
        (0.025, 5, -2.57058184),
        (0.5, 7, 0.0),
    ],
)
def test_quantiles_are_those_of_printed_tables(probability, degrees, value):
    assert student_quantile(probability, degrees) == pytest.approx(value, rel=1e-8)


def test_many_degrees_of_freedom_are_nearly_normal():
    assert student_quantile(0.975, 10**9) == pytest.approx(1.959964, abs=1e-4)


def test_one_degree_of_freedom_is_cauchy():
    assert student_probability(3.0, 1) == pytest.approx(0.5 + math.atan(3.0) / math.pi)


@given(st.floats(0.0001, 0.9999), st.integers(1, 300))
def test_quantiles_and_probabilities_are_inverse(probability, degrees):
    value = student_quantile(probability, degrees)
    assert student_probability(value, degrees) == pytest.approx(probability, abs=1e-9)


@pytest.mark.parametrize(("probability", "degrees"), [(0.0, 3), (1.0, 3), (0.9, 0)])
def test_what_makes_no_sense_is_an_error(probability, degrees):
    with pytest.raises(ConfigurationError):
        student_quantile(probability, degrees)
