import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.houses.box_rays import along_axes, crossing

LOW, HIGH = (1.0, 2.0, 3.0), (2.0, 4.0, 6.0)
MISS = (math.inf, -math.inf)


@pytest.mark.parametrize(
    ("start", "way", "longest", "expected"),
    [
        pytest.param((0.0, 3.0, 4.0), (1.0, 0.0, 0.0), math.inf, (1.0, 2.0), id="straight through"),
        pytest.param((0.0, 3.0, 4.0), (0.5, 0.0, 0.0), math.inf, (2.0, 4.0), id="in units of its way"),
        pytest.param((4.0, 3.0, 4.0), (-1.0, 0.0, 0.0), math.inf, (2.0, 3.0), id="backwards"),
        pytest.param((1.5, 0.0, 4.0), (0.0, 2.0, 0.0), math.inf, (1.0, 2.0), id="along the second axis"),
        pytest.param((1.5, 3.0, 8.0), (0.0, 0.0, -4.0), math.inf, (0.5, 1.25), id="from above"),
        pytest.param((0.0, 1.0, 4.0), (1.0, 1.0, 0.0), math.inf, (1.0, 2.0), id="slanting, both axes"),
        pytest.param((0.0, 0.0, 4.0), (1.0, 1.5, 0.0), math.inf, (4 / 3, 2.0), id="slanting, a corner"),
        pytest.param((0.0, 0.0, 4.0), (1.0, 0.5, 0.0), math.inf, MISS, id="slanting past"),
        pytest.param((3.0, 3.0, 4.0), (1.0, 0.0, 0.0), math.inf, MISS, id="away from it"),
        pytest.param((1.5, 3.0, 4.0), (1.0, 0.0, 0.0), math.inf, (0.0, 0.5), id="from inside"),
        pytest.param((2.0, 3.0, 4.0), (1.0, 0.0, 0.0), math.inf, (0.0, 0.0), id="away from its face"),
        pytest.param((1.0, 3.0, 4.0), (1.0, 0.0, 0.0), math.inf, (0.0, 1.0), id="inwards from its face"),
        pytest.param((0.0, 5.0, 4.0), (1.0, 0.0, 0.0), math.inf, MISS, id="parallel, above a face"),
        pytest.param((0.0, 1.0, 4.0), (1.0, 0.0, 0.0), math.inf, MISS, id="parallel, below a face"),
        pytest.param(
            (0.0, 4.0, 4.0), (1.0, 0.0, 0.0), math.inf, (1.0, 2.0), id="parallel, in the upper face"
        ),
        pytest.param(
            (0.0, 2.0, 4.0), (1.0, 0.0, 0.0), math.inf, (1.0, 2.0), id="parallel, in the lower face"
        ),
        pytest.param((0.0, 3.0, 4.0), (1.0, 1.0, 0.0), math.inf, (1.0, 1.0), id="touching an edge"),
        pytest.param((0.0, 3.0, 4.0), (1.0, 0.0, 0.0), 1.5, (1.0, 1.5), id="ending inside"),
        pytest.param((0.0, 3.0, 4.0), (1.0, 0.0, 0.0), 1.0, (1.0, 1.0), id="ending at the face"),
        pytest.param((0.0, 3.0, 4.0), (1.0, 0.0, 0.0), 0.999, MISS, id="ending before it"),
        pytest.param((1.5, 3.0, 4.0), (0.0, 0.0, 0.0), 7.0, (0.0, 7.0), id="standing still inside"),
    ],
)
def test_crossings_by_hand(start, way, longest, expected):
    assert crossing(start, way, LOW, HIGH, longest) == expected


coordinate = st.integers(-8, 8).map(lambda quarters: quarters / 4)
point = st.tuples(coordinate, coordinate, coordinate)


@given(start=point, way=point, one=point, other=point)
def test_a_crossing_is_where_the_points_of_the_ray_are_in_the_box(start, way, one, other):
    low, high = np.minimum(one, other), np.maximum(one, other)
    enter, leave = crossing(start, way, tuple(low.tolist()), tuple(high.tolist()), 3.0)
    for multiple in np.linspace(0.0, 3.0, 49):
        if min(abs(multiple - enter), abs(multiple - leave)) > 1e-9:
            place = np.array(start) + multiple * np.array(way)
            inside = bool(((low <= place) & (place <= high)).all())
            assert inside == (enter < multiple < leave)


def test_along_axes_turned_by_a_quarter_what_lay_left_lies_ahead():
    assert along_axes((0.0, 2.0, 5.0), 0.0, 1.0) == (2.0, 0.0, 5.0)
    assert along_axes((2.0, 0.0, 5.0), 0.0, 1.0) == (0.0, -2.0, 5.0)


def test_along_axes_turned_by_the_angle_of_3_4_5():
    assert along_axes((4.0, 3.0, -1.0), 0.8, 0.6) == pytest.approx((5.0, 0.0, -1.0))
