import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.dataset.checks.penetration import penetrations
from adhoc.houses.solids import Box, Solid, SolidKind

BLOCK = Solid("block", "Table", SolidKind.FURNITURE, (Box((0.0, 0.0, 0.5), (0.5, 0.3, 0.5)),))


def item(center: tuple[float, float, float], half: tuple[float, float, float], yaw: float = 0.0) -> Solid:
    return Solid("item", "Mug", SolidKind.ITEM, (Box(center, half, yaw),))


@pytest.mark.parametrize(
    ("other", "depth"),
    [
        (item((0.0, 0.0, 1.047), (0.1, 0.1, 0.05)), 0.003),
        (item((0.59, 0.0, 0.5), (0.1, 0.1, 0.1)), 0.01),
        (item((0.0, -0.39, 0.5), (0.1, 0.1, 0.1)), 0.01),
        (item((0.6, 0.0, 0.5), (0.1, 0.1, 0.1), math.pi / 4), 0.1 * math.sqrt(2) - 0.1),
        (item((0.0, 0.0, 0.5), (0.1, 0.1, 0.1)), 0.4),
        (item((0.0, 0.0, 1.049), (0.1, 0.1, 0.05)), None),
        (item((0.0, 0.0, 1.051), (0.1, 0.1, 0.05)), None),
        # The outlines overlap by far more than 2 mm along x and y, the turned square stays off the corner.
        (item((0.5 + 0.08, 0.3 + 0.08, 0.5), (0.1, 0.1, 0.1), math.pi / 4), None),
    ],
)
def test_depth_is_the_way_out(other, depth):
    expected = [] if depth is None else [("block", "item", pytest.approx(depth))]
    assert [tuple(found) for found in penetrations([BLOCK, other])] == expected
    assert len(list(penetrations([other, BLOCK]))) == len(expected)


def test_the_deepest_of_several_boxes_counts_once():
    rack = Solid(
        "rack",
        "Shelf",
        SolidKind.FURNITURE,
        (Box((0.55, 0.0, 0.5), (0.06, 0.1, 0.1)), Box((0.55, 0.0, 0.5), (0.07, 0.1, 0.1))),
    )
    assert [tuple(found) for found in penetrations([BLOCK, rack])] == [("block", "rack", pytest.approx(0.02))]


def test_walls_may_meet_and_floors_may_not_overlap():
    wall = Solid("wall", "Wall", SolidKind.WALL, (Box((0.0, 0.0, 1.0), (1.0, 0.01, 1.0)),))
    pane = Solid("pane", "Window", SolidKind.DOOR, (Box((0.0, 0.0, 1.0), (0.2, 0.005, 0.2)),))
    cross = Solid("cross", "Wall", SolidKind.WALL, (Box((0.0, 0.0, 1.0), (0.01, 1.0, 1.0)),))
    assert list(penetrations([wall, cross, pane])) == []
    floors = [
        Solid(name, "Floor", SolidKind.FLOOR, (Box((x, 0.0, -0.05), (0.5, 0.5, 0.05)),))
        for name, x in (("a", 0.0), ("b", 0.99))
    ]
    assert [(found.first, found.second) for found in penetrations(floors)] == [("a", "b")]
    assert [found.second for found in penetrations([wall, BLOCK])] == ["block"]


@given(
    x=st.floats(-1.0, 1.0),
    y=st.floats(-1.0, 1.0),
    yaw=st.floats(-4.0, 4.0),
    half_x=st.floats(0.05, 0.4),
    half_y=st.floats(0.05, 0.4),
)
def test_boxes_that_are_moved_out_by_their_depth_only_just_touch(x, y, yaw, half_x, half_y):
    other = item((x, y, 0.5), (half_x, half_y, 0.5), yaw)
    found = list(penetrations([BLOCK, other], limit=1e-6))
    corners = corners_of(other.boxes[0])
    a_corner_is_inside = any(abs(cx) < 0.5 - 1e-6 and abs(cy) < 0.3 - 1e-6 for cx, cy in corners)
    if a_corner_is_inside:
        assert found
    if found:
        depth = found[0].depth + 1e-6
        directions = [0.0, math.pi / 2, yaw, yaw + math.pi / 2]
        ways_out = [
            item(
                (x + side * depth * math.cos(a), y + side * depth * math.sin(a), 0.5),
                (half_x, half_y, 0.5),
                yaw,
            )
            for a in directions
            for side in (-1, 1)
        ]
        higher = item((x, y, 0.5 + depth), (half_x, half_y, 0.5), yaw)
        assert any(not list(penetrations([BLOCK, moved], limit=1e-6)) for moved in [*ways_out, higher])


def corners_of(box: Box) -> list[tuple[float, float]]:
    turn = complex(math.cos(box.yaw), math.sin(box.yaw))
    signs = [(sx, sy) for sx in (-1, 1) for sy in (-1, 1)]
    points = [turn * complex(sx * box.half[0], sy * box.half[1]) for sx, sy in signs]
    return [(point.real + box.center[0], point.imag + box.center[1]) for point in points]
