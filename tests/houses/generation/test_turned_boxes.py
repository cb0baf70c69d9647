import math

import numpy as np
import pytest
from box_geometry import penetration

from adhoc.houses.build import object_solid
from adhoc.houses.facts import asset, assets_of
from adhoc.houses.generation.pieces import Piece
from adhoc.houses.generation.turned_boxes import (
    are_apart,
    bounding_row,
    rows_of,
    stacked_rows,
    turned_rows,
)
from adhoc.houses.solids import Box

NAMES = [assets_of(category)[0] for category in ("Chair", "ArmChair", "DiningTable", "FloorLamp")]


def piece(name, x, y, turn, askew):
    entry = asset(name)
    return Piece(entry, x, y, 0.0, turn, entry.size, askew)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("turn", "askew"), [(0, 0.0), (1, 0.0), (0, 20.0), (3, -41.3)])
def test_rows_are_the_boxes_of_the_finished_house(name, turn, askew):
    standing = piece(name, 2.3, -1.7, turn, askew)
    boxes = object_solid(standing.house_object("it", "room", None)).boxes
    rows = rows_of(standing)
    assert len(rows) == len(boxes)
    for row, box in zip(rows, boxes):
        x, y = (row[0] + row[3]) / 2, (row[1] + row[4]) / 2
        middle = row[6] * x - row[7] * y, row[7] * x + row[6] * y, (row[2] + row[5]) / 2
        assert middle == pytest.approx(box.center, abs=1e-6)
        half = (row[3] - row[0]) / 2, (row[4] - row[1]) / 2
        assert half == pytest.approx((box.half[1], box.half[0]) if turn % 2 else box.half[:2], abs=1e-6)
        assert row[6:] == pytest.approx((math.cos(math.radians(askew)), math.sin(math.radians(askew))))


def test_the_rectangle_of_a_piece_that_is_askew_is_the_least_around_it():
    standing = piece(NAMES[0], 1.0, 2.0, 1, 30.0)
    thing = standing.house_object("it", "room", None)
    half_x, half_y = thing.size[0] / 2, thing.size[1] / 2
    corners = [
        (
            1.0 + math.cos(thing.yaw) * dx - math.sin(thing.yaw) * dy,
            2.0 + math.sin(thing.yaw) * dx + math.cos(thing.yaw) * dy,
        )
        for dx in (-half_x, half_x)
        for dy in (-half_y, half_y)
    ]
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    assert standing.rectangle == pytest.approx((*low, *high))


def test_boxes_are_apart_just_where_they_do_not_penetrate():
    generator = np.random.default_rng(0)
    outcomes = set()
    for _ in range(400):
        boxes, rows = [], []
        for _ in range(2):
            x, y, z = generator.uniform(-1, 1, 3)
            half = generator.uniform(0.1, 0.8, 3)
            degrees = float(generator.choice([0.0, generator.uniform(-90, 90)]))
            bounds = (x - half[0], y - half[1], z - half[2], x + half[0], y + half[1], z + half[2])
            boxes.append(Box((x, y, z), tuple(half), math.radians(degrees)))
            rows.append(turned_rows([bounds], (x, y), degrees))
        for gap in (0.0, 0.1):
            apart = are_apart(*rows, gap)
            assert apart is bool(penetration(*boxes) <= -gap)
            outcomes.add((gap, apart))
    assert len(outcomes) == 4


def test_one_box_of_many_that_is_close_is_enough():
    far, near = [(5.0, 0, 0, 6, 1, 1)], [(1.05, 0, 0, 2, 1, 1)]
    own = turned_rows([(0.0, 0, 0, 1, 1, 1)])
    assert are_apart(own, turned_rows(far), 0.1)
    assert not are_apart(own, turned_rows([*far, *near]), 0.1)
    assert are_apart(own, turned_rows([*far, *near]), 0.04)
    assert are_apart(own, stacked_rows([]), 0.1)


def test_the_bounding_row_holds_all_boxes():
    standing = piece(NAMES[1], 3.0, 1.0, 2, 33.0)
    ((x0, y0, z0, x1, y1, z1, *_),) = bounding_row(standing)
    rows = rows_of(standing)
    assert (rows[:, :3] >= np.array([x0, y0, z0]) - 1e-9).all()
    assert (rows[:, 3:6] <= np.array([x1, y1, z1]) + 1e-9).all()
