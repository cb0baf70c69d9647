"""Polynomial weights, by hand."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.agents.plastic.beliefs import Beliefs
from adhoc.core.errors import ConfigurationError

PROBABILITY = st.floats(0.0, 1.0)


def test_one_observation_multiplies_by_one_minus_eta_times_loss():
    beliefs = Beliefs(("a", "b"), eta=0.5)
    assert beliefs.probabilities == pytest.approx({"a": 0.5, "b": 0.5})
    beliefs.update({"a": 1.0, "b": 0.2})  # losses 0 and 0.8: weights 1 and 0.6
    assert beliefs.probabilities == pytest.approx({"a": 1 / 1.6, "b": 0.6 / 1.6})
    beliefs.update({"a": 0.5, "b": 0.5})  # equal losses change nothing
    assert beliefs.probabilities == pytest.approx({"a": 1 / 1.6, "b": 0.6 / 1.6})


def test_a_smaller_eta_learns_more_slowly():
    slow, fast = Beliefs(("a", "b"), eta=0.1), Beliefs(("a", "b"), eta=0.5)
    for beliefs in (slow, fast):
        beliefs.update({"a": 1.0, "b": 0.0})
    assert 0.5 < slow.probabilities["a"] < fast.probabilities["a"]


def test_the_most_likely_is_the_first_of_equals():
    beliefs = Beliefs(("b", "a"))
    assert beliefs.most_likely == "b"
    beliefs.update({"a": 0.6, "b": 0.5})
    assert beliefs.most_likely == "a"


def test_beliefs_recover_from_thousands_of_wrong_observations():
    beliefs = Beliefs(("a", "b"))
    for _ in range(3000):
        beliefs.update({"a": 0.0, "b": 1.0})
    for _ in range(3001):
        beliefs.update({"a": 1.0, "b": 0.0})
    assert beliefs.most_likely == "a"


@given(st.lists(st.tuples(PROBABILITY, PROBABILITY, PROBABILITY), max_size=60), st.floats(0.01, 0.5))
def test_beliefs_are_probabilities_in_the_order_of_the_losses(observations, eta):
    beliefs = Beliefs(("a", "b", "c"), eta)
    for chances in observations:
        before = beliefs.probabilities
        beliefs.update(dict(zip("abc", chances)))
        after = beliefs.probabilities
        best = max("abc", key=lambda name: chances["abc".index(name)])
        assert after[best] >= before[best] - 1e-9
    assert sum(beliefs.probabilities.values()) == pytest.approx(1.0)
    assert min(beliefs.probabilities.values()) >= 0.0


@pytest.mark.parametrize(
    ("types", "eta", "told"),
    [((), 0.5, "one or more"), (("a", "a"), 0.5, "different"), (("a",), 0.0, "eta=0"), (("a",), 0.6, "0.6")],
)
def test_impossible_beliefs_are_refused(types, eta, told):
    with pytest.raises(ConfigurationError, match=told):
        Beliefs(types, eta)


@pytest.mark.parametrize("wrong", [math.nan, math.inf, -0.1, 1.5])
def test_what_is_no_probability_is_refused_and_changes_nothing(wrong):
    beliefs = Beliefs(("a", "b"))
    with pytest.raises(ConfigurationError, match=f"{wrong} by the model of type 'b': must be 0 to 1"):
        beliefs.update({"a": 0.2, "b": wrong})
    assert beliefs.probabilities == {"a": 0.5, "b": 0.5}
