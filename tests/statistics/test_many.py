"""Holm's correction against a worked example, and what must hold of any."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.many import holm

P_VALUES = st.lists(st.floats(0.0, 1.0), max_size=12)


def test_the_worked_example():
    """0.005 x 4, 0.01 x 3, 0.03 x 2, and 0.04 x 1, which is below the one before it."""
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])


def test_nothing_and_one_stay_as_they_are():
    assert holm([]) == []
    assert holm([0.3]) == [0.3]


@given(P_VALUES)
def test_between_no_correction_and_bonferroni_in_the_same_order(p_values):
    adjusted = holm(p_values)
    for before, after in zip(p_values, adjusted):
        assert before <= after <= min(1.0, len(p_values) * before) or after == before
    order = sorted(range(len(p_values)), key=lambda it: p_values[it])
    assert [adjusted[it] for it in order] == sorted(adjusted)


@given(P_VALUES, st.floats(0.001, 0.999))
def test_what_is_called_beyond_chance_is_what_stepping_down_finds(p_values, level):
    """Holm's own words: go up from the smallest until one is over level / (how many are left)."""
    called = 0
    for rank, value in enumerate(sorted(p_values)):
        if (len(p_values) - rank) * value > level:
            break
        called += 1
    assert sum(it <= level for it in holm(p_values)) == called


@pytest.mark.parametrize("value", [-0.1, 1.1, float("nan")])
def test_no_p_value_is_an_error(value):
    with pytest.raises(ConfigurationError):
        holm([0.5, value])
