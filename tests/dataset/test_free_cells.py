import math

import numpy as np
import pytest
from checked_houses import real_houses
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.values import Pose
from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.houses.build import build_solids
from adhoc.houses.house import House, Room
from adhoc.houses.lattice_parts import MOVES
from adhoc.houses.samples import sample_house, sample_names
from adhoc.houses.solids import Box, Solid, SolidKind
from adhoc.worlds.pybullet_world import PyBulletWorld

ROOM = Room("room|2", "Kitchen", ((0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)))
WALLS = Solid(
    "walls",
    "Wall",
    SolidKind.WALL,
    (
        Box((1.0, -0.05, 1.0), (1.1, 0.05, 1.0)),
        Box((1.0, 1.05, 1.0), (1.1, 0.05, 1.0)),
        Box((-0.05, 0.5, 1.0), (0.05, 0.6, 1.0)),
        Box((2.05, 0.5, 1.0), (0.05, 0.6, 1.0)),
    ),
)


def block(*boxes: Box, kind: SolidKind = SolidKind.FURNITURE) -> Solid:
    return Solid("block", "Table", kind, boxes)


def picture(cells: FreeCells) -> list[str]:
    """Rows from above, `#` where no robot fits, `.` where one does, `o` where the largest part is."""
    marks = np.where(cells.connected, "o", np.where(cells.free, ".", "#"))
    return ["".join(row) for row in marks.T[::-1]]


def test_an_empty_room_has_a_margin_of_a_robots_radius():
    cells = FreeCells([ROOM], [WALLS])
    assert picture(cells) == ["#########", "#ooooooo#", "#ooooooo#", "#ooooooo#", "#########"]
    assert cells.origin == (0, 0)
    assert cells.point(3, 2) == (0.75, 0.5)
    assert cells.index(0.8, 0.45) == (3, 2)


def test_a_block_across_the_room_leaves_the_larger_part():
    cells = FreeCells([ROOM], [WALLS, block(Box((0.75, 0.5, 0.2), (0.04, 0.5, 0.2)))])
    assert picture(cells) == ["#########", "#..#oooo#", "#..#oooo#", "#..#oooo#", "#########"]


def test_of_equally_large_parts_the_one_with_the_smallest_cell_counts():
    cells = FreeCells([ROOM], [WALLS, block(Box((1.0, 0.5, 0.2), (0.04, 0.5, 0.2)))])
    assert picture(cells) == ["#########", "#ooo#...#", "#ooo#...#", "#ooo#...#", "#########"]


@pytest.mark.parametrize(
    ("kind", "box", "fits"),
    [
        (SolidKind.FURNITURE, Box((1.0, 0.5, 0.5), (0.1, 0.1, 0.1)), False),
        (SolidKind.ITEM, Box((1.0, 0.5, 0.01), (0.1, 0.1, 0.01)), False),
        (SolidKind.FLOOR, Box((1.0, 0.5, 0.01), (0.1, 0.1, 0.01)), True),
        (SolidKind.FURNITURE, Box((1.0, 0.5, 1.9), (0.1, 0.1, 0.1)), True),
        (SolidKind.FURNITURE, Box((1.0, 0.5, 1.75), (0.1, 0.1, 0.1)), False),
        (SolidKind.FURNITURE, Box((1.0, 0.5, -0.1), (0.1, 0.1, 0.1)), True),
    ],
)
def test_only_what_stands_within_a_robots_height_is_in_its_way(kind, box, fits):
    cells = FreeCells([ROOM], [WALLS, block(box, kind=kind)])
    assert cells.free[4, 2] == fits
    assert cells.fits(1.0, 0.5) == fits


def test_a_turned_box_blocks_what_it_covers_and_no_more():
    bar = block(Box((1.0, 0.5, 0.5), (0.8, 0.01, 0.5), math.pi / 4))
    cells = FreeCells([ROOM], [WALLS, bar], radius=0.05)
    assert not cells.fits(1.25, 0.75)
    assert cells.fits(1.25, 0.25)
    assert cells.fits(1.25, 0.75 + math.sqrt(2) * 0.0601)
    assert not cells.fits(1.25, 0.75 + math.sqrt(2) * 0.0599)


def test_a_move_is_tested_at_its_thirds():
    thin = block(Box((1.0 + 0.25 / 3, 0.5, 0.5), (0.01, 0.02, 0.5)))
    cells = FreeCells([ROOM], [WALLS, thin], radius=0.03)
    assert cells.free[4, 2]
    assert cells.free[5, 2]
    assert not cells.steps[4, 2, 0]
    assert not cells.steps[5, 2, 1]
    assert cells.steps[4, 2, 1]
    assert cells.steps[4, 2, 2]


def test_there_are_no_cells_outside_the_rooms():
    left = Room("room|3", "Bedroom", ((-2.0, 0.0), (-1.0, 0.0), (-1.0, 1.0), (-2.0, 1.0)))
    cells = FreeCells([ROOM, left], [])
    assert cells.origin == (-8, 0)
    assert set(cells.room[:4, 1]) == {1}
    assert set(cells.room[5:8, 1]) == {-1}
    assert set(cells.room[9:15, 1]) == {0}
    assert not cells.free[6, 1]
    assert cells.room_at(0.5, 0.5) == 0
    assert cells.room_at(-0.5, 0.5) == -1
    assert not cells.fits(-0.5, 0.5)


def test_a_full_house_has_no_cells():
    cells = FreeCells([ROOM], [block(Box((1.0, 0.5, 0.5), (1.0, 0.5, 0.5)))])
    assert not cells.free.any()
    assert not cells.connected.any()


@given(
    x=st.floats(0.0, 2.0),
    y=st.floats(0.0, 1.0),
    half_x=st.floats(0.01, 0.5),
    half_y=st.floats(0.01, 0.5),
    yaw=st.floats(-4.0, 4.0),
)
def test_a_disc_fits_where_it_is_its_radius_away_from_the_box(x, y, half_x, half_y, yaw):
    box = Box((1.1, 0.45, 0.5), (half_x, half_y, 0.5), yaw)
    gap = distance_to_outline(box, (x, y))
    if abs(gap - 0.2) > 1e-5:
        assert FreeCells([ROOM], [block(box)]).fits(x, y) == (gap > 0.2)


def distance_to_outline(box: Box, point: tuple[float, float]) -> float:
    """By complex numbers: turn the point into the box's frame and clip it to the box."""
    local = complex(point[0] - box.center[0], point[1] - box.center[1]) * complex(
        math.cos(box.yaw), -math.sin(box.yaw)
    )
    nearest = complex(
        np.clip(local.real, -box.half[0], box.half[0]), np.clip(local.imag, -box.half[1], box.half[1])
    )
    return abs(local - nearest)


@pytest.mark.parametrize("name", sample_names())
def test_the_simulator_agrees_on_sample_houses(name):
    assert_agrees(sample_house(name), most_lost=0)


@pytest.mark.real_houses
def test_the_simulator_agrees_on_real_houses():
    for house in real_houses(every=60):
        assert_agrees(house, most_lost=8)


def assert_agrees(house: House, most_lost: int) -> None:
    """What is free here is free in the simulator, and nearly all that is free there is free here."""
    cells = FreeCells(house.rooms, build_solids(house))
    world = PyBulletWorld()
    world.reset(house, 0)
    lost = 0
    for i, j in np.ndindex(*cells.free.shape):
        here = Pose(*cells.point(i, j))
        free_there = world.is_free(here)
        assert free_there or not cells.free[i, j], f"{house.id}: {here}"
        lost += free_there and not cells.free[i, j]
    assert lost <= most_lost
    live = world._house()
    for i, j, move in np.argwhere(cells.steps):
        start, end = (Pose(*cells.point(i + a, j + b)) for a, b in ((0, 0), MOVES[move]))
        assert live.motion.obstacle(start, end) is None
    mine = {(i + cells.origin[0], j + cells.origin[1]) for i, j in np.argwhere(cells.connected).tolist()}
    theirs = set(live.free_space.largest_part(()))
    assert mine <= theirs
    assert len(theirs - mine) <= most_lost
    world.close()
