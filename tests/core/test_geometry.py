"""Frames and angles, by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from adhoc.core.geometry import intrinsics, planar_distance, world_from_camera, wrap_angle
from adhoc.core.values import Pose


@pytest.mark.parametrize(
    ("angle", "wrapped"), [(0, 0), (math.pi, math.pi), (-math.pi, math.pi), (3 * math.pi / 2, -math.pi / 2)]
)
def test_wrap_angle(angle, wrapped):
    assert wrap_angle(angle) == pytest.approx(wrapped)


def test_planar_distance_ignores_height():
    assert planar_distance((0.0, 0.0, 9.0), Pose(3.0, 4.0)) == 5.0


def test_a_camera_that_faces_x_sees_forward_along_x():
    transform = world_from_camera(Pose(1.0, 2.0), 1.6)
    np.testing.assert_allclose(transform @ [0, 0, 3, 1], [4, 2, 1.6, 1])
    np.testing.assert_allclose(transform @ [1, 0, 0, 1], [1, 1, 1.6, 1])
    np.testing.assert_allclose(transform @ [0, 1, 0, 1], [1, 2, 0.6, 1])


def test_a_tilted_camera_sees_the_floor():
    transform = world_from_camera(Pose(0.0, 0.0, math.pi / 2, math.pi / 6), 0.9)
    seen = transform @ [0, 0, 1.8, 1]
    np.testing.assert_allclose(seen, [0, 1.8 * math.cos(math.pi / 6), 0, 1], atol=1e-12)
    assert np.linalg.det(transform[:3, :3]) == pytest.approx(1.0)


def test_the_field_of_view_spans_the_picture():
    matrix = intrinsics(128, 128, math.pi / 2)
    assert matrix[0, 0] == pytest.approx(64)
    assert (matrix[0, 2], matrix[1, 2]) == (64, 63)
