from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from textbook_rays import depth_bounds, holds

from adhoc.core.geometry import camera_at, intrinsics
from adhoc.core.values import Pose
from adhoc.houses.solids import Box
from adhoc.worlds.sensor.box_table import BoxTable, Layer
from adhoc.worlds.sensor.ray_casting import cast_boxes

SIZE = 32
ORIGIN = Pose(0.0, 0.0)


def cast(boxes, pose=ORIGIN, height=1.0, own=-1, layers=Layer.STATIC, order=None):
    """Depth and instances of boxes, one instance each, drawn in the given order."""
    table = BoxTable()
    table.add([[box] for box in boxes], Layer.STATIC)
    rows = list(range(len(boxes))) if order is None else order
    camera = camera_at(pose, height, intrinsics(SIZE, SIZE, math.pi / 2))
    depth = np.full((SIZE, SIZE), math.inf, np.float32)
    owners = np.full((SIZE, SIZE), -1, np.int32)
    written = cast_boxes(
        table.centers[rows],
        table.halves[rows],
        table.headings[rows],
        table.instances[rows],
        table.layers[rows],
        int(layers),
        own,
        camera.intrinsics,
        camera.world_from_camera,
        depth,
        owners,
    )
    return depth, owners, written


def test_a_wall_ahead_has_one_depth_everywhere():
    depth, owners, written = cast([Box((2.5, 0.0, 1.0), (0.5, 9.0, 9.0))])
    assert written == SIZE * SIZE
    assert (owners == 0).all()
    assert depth == pytest.approx(2.0, rel=1e-6)


def test_a_box_covers_the_pixels_that_it_should():
    # 2 m ahead and 1 m wide: u and v in [-0.25, 0.25], sampled at u = 2j/32 - 1 and v = 2(i + 1)/32 - 1.
    _, owners, written = cast([Box((2.5, 0.0, 1.0), (0.5, 0.5, 0.5))])
    rows, columns = np.nonzero(owners == 0)
    assert (columns.min(), columns.max()) == (12, 20)
    assert (rows.min(), rows.max()) == (11, 19)
    assert written == 81


def test_the_depth_of_a_floor_follows_from_the_height():
    depth, _, _ = cast([Box((0.0, 0.0, -0.5), (50.0, 50.0, 0.5))], height=1.6)
    for row in range(20, SIZE):
        assert depth[row] == pytest.approx(1.6 / (2 * (row + 1) / SIZE - 1), rel=1e-5)
    assert np.isinf(depth[: SIZE // 2 - 1]).all()


def test_the_nearer_box_is_seen_whatever_the_order():
    boxes = [Box((3.5, 0.0, 1.0), (0.5, 9.0, 9.0)), Box((2.5, 0.0, 1.0), (0.5, 0.5, 0.5))]
    for order in ([0, 1], [1, 0]):
        depth, owners, _ = cast(boxes, order=order)
        assert owners[16, 16] == 1
        assert depth[16, 16] == pytest.approx(2.0)
        assert owners[0, 0] == 0


def test_of_equal_depths_the_smaller_instance_is_seen_whatever_the_order():
    boxes = [Box((2.5, 0.0, 1.0), (0.5, 9.0, 9.0))] * 3
    for order in ([0, 1, 2], [2, 1, 0], [1, 2, 0]):
        assert (cast(boxes, order=order)[1] == 0).all()


@pytest.mark.parametrize(
    "box",
    [
        Box((-2.5, 0.0, 1.0), (0.5, 0.5, 0.5)),
        Box((2.0, 9.0, 1.0), (0.5, 0.5, 0.5)),
        Box((0.0, 0.0, 1.0), (0.5, 0.5, 0.5)),
    ],
    ids=["behind", "beside", "around the camera"],
)
def test_what_is_not_in_view_is_not_drawn(box):
    depth, owners, written = cast([box])
    assert written == 0
    assert np.isinf(depth).all()
    assert (owners == -1).all()


def test_the_own_body_and_other_layers_are_not_drawn():
    wall = Box((2.5, 0.0, 1.0), (0.5, 9.0, 9.0))
    assert cast([wall], own=0)[2] == 0
    assert cast([wall], layers=Layer.MOVED)[2] == 0
    assert cast([wall], layers=Layer.MOVED | Layer.STATIC)[2] == SIZE * SIZE


def test_a_box_that_reaches_behind_the_camera_is_drawn_in_front_of_it():
    depth, _, _ = cast([Box((0.0, 1.25, 1.0), (9.0, 0.25, 9.0))])
    # The face at y = 1: depth = 1 / -u on the left half of the picture.
    for column in range(SIZE // 2):
        u = 2 * column / SIZE - 1
        expected = 1.0 / -u
        assert depth[16, column] == pytest.approx(expected if expected <= 9.0 else math.inf, rel=1e-5)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("offset", [0.0, 1e-17, -1e-17, 1e-12])
def test_a_box_ends_at_a_face_whose_plane_the_camera_lies_in(side, offset):
    # Robots stand on a lattice, so that this is common: the box reaches from y = 0 to one side only.
    _, owners, _ = cast([Box((2.5, side + offset, 1.0), (0.5, 1.0, 0.5))])
    columns = np.nonzero(owners == 0)[1]
    # u = -y / x: the box ends at u = 0, which is column 16, and reaches the border of the picture.
    expected = {(0, 15), (0, 16)} if side > 0 else {(16, 31), (17, 31)}
    assert (columns.min(), columns.max()) in expected


def test_a_camera_level_with_the_top_of_a_box_sees_its_side_only():
    _, owners, _ = cast([Box((2.5, 0.0, 0.5), (0.5, 9.0, 0.5))], height=1.0)
    rows = np.nonzero(owners == 0)[0]
    # v = 0 is row 15; the bottom, 1 m lower and 2 m ahead, is v = 0.5, row 23.
    assert rows.min() in {15, 16}
    assert rows.max() == 23


coordinate = st.floats(-4.0, 4.0) | st.integers(-16, 16).map(lambda quarters: quarters / 4)
extent = st.floats(0.02, 2.0) | st.integers(1, 8).map(lambda quarters: quarters / 4)
turn = st.floats(-math.pi, math.pi) | st.sampled_from([0.0, math.pi / 2, math.pi, -math.pi / 2])
boxes_ = st.builds(
    Box,
    st.tuples(coordinate, coordinate, st.floats(0.0, 3.0) | st.integers(0, 12).map(lambda z: z / 4)),
    st.tuples(extent, extent, extent),
    turn,
)


@settings(max_examples=150, deadline=None)
@given(
    st.lists(boxes_, min_size=1, max_size=4),
    turn,
    st.sampled_from([-math.pi / 6, 0.0, math.pi / 6, math.pi / 3]),
)
def test_pictures_agree_with_the_textbook_slab_test(boxes, yaw, pitch):
    boxes = [box for box in boxes if not holds(box, (0.0, 0.0, 1.0), margin=0.05)]
    assume(boxes)
    pose = Pose(0.0, 0.0, yaw, pitch)
    depth, _, _ = cast(boxes, pose)
    camera = camera_at(pose, 1.0, intrinsics(SIZE, SIZE, math.pi / 2))
    eye, turn = camera.world_from_camera[:3, 3], camera.world_from_camera[:3, :3]
    for row in range(0, SIZE, 3):
        for column in range(0, SIZE, 3):
            ray = turn @ np.array([2 * column / SIZE - 1, 2 * (row + 1) / SIZE - 1, 1.0])
            at_least, at_most = depth_bounds(boxes, eye, ray)
            assert at_least * (1 - 1e-4) <= depth[row, column]
            assert depth[row, column] <= at_most * (1 + 1e-4)
