from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.radio import Link, Loss, Radio

LINK = Link("a", "b", 3, 1, 2.0)
LINKS = [replace(LINK, step=step, index=index) for step in range(100) for index in range(20)]


def fates(radio, seed=0, links=LINKS):
    return [radio.delay_on(seed, link) for link in links]


def test_without_faults_everything_arrives_at_once():
    assert set(fates(Radio())) == {0}


def test_so_many_are_lost():
    assert fates(Radio(loss=0.3)).count(Loss.LOST) == pytest.approx(0.3 * len(LINKS), rel=0.15)
    assert set(fates(Radio(loss=1.0))) == {Loss.LOST}


def test_a_delay_is_the_same_for_all_and_a_jitter_is_not():
    assert set(fates(Radio(delay=4))) == {4}
    late = fates(Radio(delay=2, jitter=3))
    assert {it: pytest.approx(late.count(it), rel=0.2) for it in set(late)} == dict.fromkeys(
        (2, 3, 4, 5), len(LINKS) / 4
    )


@pytest.mark.parametrize(("distance", "fate"), [(0.0, 0), (3.0, 0), (3.0001, Loss.OUT_OF_RANGE)])
def test_the_range_is_a_distance(distance, fate):
    assert Radio(range=3.0).delay_on(0, replace(LINK, distance=distance)) == fate


@pytest.mark.parametrize(
    "other",
    [
        replace(LINK, sender="c"),
        replace(LINK, recipient="c"),
        replace(LINK, step=4),
        replace(LINK, index=2),
    ],
)
def test_each_link_has_a_fate_of_its_own(other):
    radio = Radio(loss=0.5)
    pairs = [(radio.delay_on(seed, LINK), radio.delay_on(seed, other)) for seed in range(60)]
    assert len(set(pairs)) == 4


def test_the_distance_decides_nothing_but_the_range():
    radio = Radio(loss=0.5, jitter=5)
    far = [replace(link, distance=50.0) for link in LINKS]
    assert fates(radio) == fates(radio, links=far)


@given(
    st.floats(0, 1),
    st.integers(0, 50),
    st.integers(0, 50),
    st.none() | st.floats(0, 1e6),
    st.integers(0, 2**40),
    st.floats(0, 1e6),
)
def test_a_fate_is_a_bounded_delay_or_a_loss(loss, delay, jitter, reach, seed, distance):
    radio, link = Radio(loss, delay, jitter, reach), replace(LINK, distance=distance)
    fate = radio.delay_on(seed, link)
    assert fate == radio.delay_on(seed, link)
    assert isinstance(fate, Loss) or delay <= fate <= delay + jitter


@pytest.mark.parametrize(
    ("field", "value"),
    [
        *(("loss", it) for it in (-0.1, 1.1, math.nan)),
        *(("delay", it) for it in (-1, 10_001, 1.5, True)),
        *(("jitter", it) for it in (-1, 10_001)),
        *(("range", it) for it in (-1.0, math.inf, math.nan)),
    ],
)
def test_values_out_of_range_are_refused(field, value):
    with pytest.raises(ConfigurationError, match=f"{field}="):
        Radio(**{field: value})
