"""A situation's row of numbers, computed by hand."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from learned_situations import FRIEND, MUG, situation

from adhoc.agents.learned.features import (
    DETECTION_SIZE,
    DETECTION_SLOTS,
    FEATURE_SIZE,
    OTHER_SIZE,
    OTHER_SLOTS,
    OWN_SIZE,
    encode,
)
from adhoc.core.values import Capability


def own_of(row):
    return row[:OWN_SIZE]


def detections_of(row):
    return row[OWN_SIZE : OWN_SIZE + DETECTION_SLOTS * DETECTION_SIZE].reshape(DETECTION_SLOTS, -1)


def others_of(row):
    return row[-OTHER_SLOTS * OTHER_SIZE :].reshape(OTHER_SLOTS, -1)


def test_a_robot_alone():
    row = encode(situation())
    assert row.shape == (FEATURE_SIZE,)
    assert row.dtype == np.float32
    assert own_of(row).tolist() == pytest.approx(
        [1, 0.8, 0.5, 0.5, 0.1, 0, 0, 0, 1, 0.3, 0.4, 0.25, 0, 0, 1, 0, 0.75, 0, 0.25, 0]
    )
    assert not row[OWN_SIZE:].any()


def test_a_detection_ahead_with_a_rival_that_is_nearer():
    row = encode(situation([MUG], [FRIEND]))
    # 3 m straight ahead, since the robot looks along y; the friend is 1 m from it
    assert detections_of(row)[0].tolist() == pytest.approx(
        [1, 0.3, 0, 0.3, 0.025, 1, 0, 0, 0.2, 0.1, 0.75], abs=1e-6
    )
    assert others_of(row)[0].tolist() == pytest.approx(
        [1, 0.2, 0, 0.2, 1, 1, 0.25, 0, 0, 0, 0.1, 1, 0, 1], abs=1e-6
    )
    assert own_of(row)[12] == 1
    assert not detections_of(row)[1:].any()


@pytest.mark.parametrize(
    "change",
    [
        {"busy": True},
        {"stopped": True},
        {"unable": frozenset({"mug"})},
        {"position": None},
        {"position": (1.0, 9.0)},
        {"capability": Capability(can_manipulate=False)},
        {"capability": Capability(payload=0.4)},
    ],
)
def test_who_cannot_or_need_not_come_is_no_rival(change):
    row = encode(situation([MUG], [replace(FRIEND, **change)]))
    assert detections_of(row)[0][8] == 0


@pytest.mark.parametrize("change", [{"handled": True}, {"given_up": True}, {"mass": 11.0}])
def test_what_the_robot_cannot_take_is_not_open(change):
    assert own_of(encode(situation([replace(MUG, **change)])))[12] == 0


def test_a_robot_without_a_hand_has_no_payload_and_takes_nothing():
    row = encode(situation([MUG], capability=Capability(can_manipulate=False)))
    assert own_of(row)[[0, 2, 12]].tolist() == [0, 0, 0]
    assert detections_of(row)[0][5] == 0


def test_order_does_not_matter_and_the_nearest_have_the_slots():
    things = [replace(MUG, id=f"mug_{n}", position=(1.0, 3.0 + n)) for n in range(3)]
    rows = {encode(situation(order, [FRIEND])).tobytes() for order in permutations(things)}
    assert len(rows) == 1
    many = [replace(MUG, id=f"mug_{n:02d}", position=(1.0, 3.0 + n)) for n in range(12)]
    distances = detections_of(encode(situation(many[::-1])))[:, 3]
    assert distances.tolist() == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5])


numbers = st.floats(-1e6, 1e6)


@given(position=st.tuples(numbers, numbers), mass=st.floats(0, 1e6), seen=st.integers(-1, 10**6))
def test_foreign_numbers_stay_small(position, mass, seen):
    strange = replace(MUG, position=position, mass=mass, last_seen=seen)
    row = encode(situation([strange], [replace(FRIEND, position=position)]))
    assert np.isfinite(row).all()
    assert abs(row).max() <= 3.0
