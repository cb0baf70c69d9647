from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from adhoc.core.geometry import camera_at, intrinsics
from adhoc.core.values import Pose
from adhoc.houses.solids import Box
from adhoc.worlds.sensor.box_table import BoxTable, Layer
from adhoc.worlds.sensor.occlusion import may_show
from adhoc.worlds.sensor.ray_casting import cast_boxes

SIZE = 32
ORIGIN = Pose(0.0, 0.0)
WALL = Box((2.5, 0.0, 1.0), (0.5, 9.0, 9.0))


def guess_and_truth(still: list[Box], moved: list[Box], pose: Pose = ORIGIN) -> tuple[bool, int]:
    """Whether the moved boxes may show before the others, and how many pixels they really cover."""
    table = BoxTable()
    table.add([[box] for box in still], Layer.STATIC)
    table.add([[box] for box in moved], Layer.MOVED)
    camera = camera_at(pose, 1.0, intrinsics(SIZE, SIZE, math.pi / 2))
    depth = np.full((SIZE, SIZE), math.inf, np.float32)
    owners = np.full((SIZE, SIZE), -1, np.int32)
    view = (camera.intrinsics, camera.world_from_camera)
    rows = (table.centers, table.halves, table.headings, table.instances, table.layers)
    cast_boxes(*rows, int(Layer.STATIC), -1, *view, depth, owners)
    guess = may_show(
        table.centers,
        table.halves,
        table.instances,
        table.layers,
        int(Layer.MOVED),
        -1,
        *view,
        depth,
    )
    return guess, cast_boxes(*rows, int(Layer.MOVED), -1, *view, depth, owners)


@pytest.mark.parametrize(
    ("moved", "expected"),
    [
        pytest.param(Box((1.5, 0.0, 1.0), (0.1, 0.1, 0.1)), True, id="before the wall"),
        pytest.param(Box((1.9, 0.0, 1.0), (0.05, 0.05, 0.05)), True, id="just before the wall"),
        pytest.param(Box((4.5, 0.0, 1.0), (0.1, 0.1, 0.1)), False, id="behind the wall"),
        pytest.param(Box((-1.5, 0.0, 1.0), (0.1, 0.1, 0.1)), False, id="behind the camera"),
        pytest.param(Box((1.0, 2.0, 1.0), (0.1, 0.1, 0.1)), False, id="beside the picture"),
    ],
)
def test_what_is_hidden_is_known_to_be_hidden(moved, expected):
    guess, pixels = guess_and_truth([WALL], [moved])
    assert guess is expected
    assert (pixels > 0) is expected


coordinate = st.floats(-4.0, 4.0)
extent = st.floats(0.02, 1.5)
angle = st.floats(-math.pi, math.pi) | st.sampled_from([0.0, math.pi / 2, -math.pi / 2])
boxes_ = st.builds(
    Box,
    st.tuples(coordinate, coordinate, st.floats(0.0, 3.0)),
    st.tuples(extent, extent, extent),
    angle,
)


@settings(max_examples=300, deadline=None)
@given(
    st.lists(boxes_, max_size=3),
    boxes_,
    angle,
    st.sampled_from([-math.pi / 6, 0.0, math.pi / 6, math.pi / 3]),
)
def test_no_box_that_shows_is_called_hidden(still, moved, yaw, pitch):
    guess, pixels = guess_and_truth(still, [moved], Pose(0.0, 0.0, yaw, pitch))
    assert guess or pixels == 0
