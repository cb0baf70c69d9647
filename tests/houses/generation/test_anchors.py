import numpy as np
import pytest

from adhoc.houses.facts_furniture import CORNER, EDGE, MIDDLE
from adhoc.houses.generation.anchors import Anchor, draw_anchor

L_SHAPE = ((0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 2.0), (2.0, 4.0), (0.0, 4.0))


def anchors(rectangle, count=60):
    generator = np.random.default_rng(0)
    return [draw_anchor(L_SHAPE, rectangle, generator) for _ in range(count)]


def test_corners_of_the_room_come_first():
    found = anchors((0.0, 0.0, 4.0, 2.0))
    assert {anchor.kind for anchor in found} == {CORNER}
    # The corner at (2, 2) is reflex and no corner to stand in.
    assert {anchor.sides for anchor in found} == {
        ((-1, 0), (0, -1)),
        ((1, 0), (0, -1)),
        ((1, 0), (0, 1)),
    }


def test_without_a_corner_it_is_an_edge_or_the_middle():
    found = anchors((1.0, 0.0, 3.0, 1.0))
    assert {(anchor.kind, anchor.sides) for anchor in found} == {(EDGE, ((0, -1),)), (MIDDLE, ())}
    assert sum(anchor.kind == EDGE for anchor in found) > 30


def test_away_from_walls_it_is_the_middle():
    assert {anchor.kind for anchor in anchors((0.5, 0.5, 1.5, 1.5))} == {MIDDLE}


@pytest.mark.parametrize(
    ("side", "turn", "point"),
    [
        ((0, -1), 0, (None, 0.325)),
        ((0, 1), 2, (None, 3.675)),
        ((-1, 0), 3, (0.325, None)),
        ((1, 0), 1, (3.675, None)),
    ],
)
def test_a_piece_at_an_edge_has_its_back_25_mm_off_the_wall(side, turn, point):
    anchor = Anchor(EDGE, (side,))
    assert anchor.turns(1.0, 0.6, (0.0, 0.0, 4.0, 4.0)) == [turn]
    extent = (0.6, 1.0) if turn % 2 else (1.0, 0.6)
    middle = anchor.middle((0.0, 0.0, 4.0, 4.0), extent, np.random.default_rng(1))
    for got, expected in zip(middle, point):
        assert expected is None or got == pytest.approx(expected)
        assert 0.3 < got < 3.7


@pytest.mark.parametrize(
    ("turn", "taken"),
    [
        (0, (0.985, 0.95, 2.015, 2.5)),
        (1, (0.5, 0.985, 2.05, 2.015)),
        (2, (0.985, 0.5, 2.015, 2.05)),
        (3, (0.95, 0.985, 2.5, 2.015)),
    ],
)
def test_half_a_metre_stays_free_in_front(turn, taken):
    anchor = Anchor(EDGE, ((0, -1),))
    assert anchor.with_margin((1.0, 1.0, 2.0, 2.0), turn) == pytest.approx(taken)


def test_only_turns_that_keep_off_the_walls_are_left():
    corner, middle = Anchor(CORNER, ((-1, 0), (0, -1))), Anchor(MIDDLE, ())
    assert sorted(corner.turns(1.9, 0.9, (0.0, 0.0, 2.0, 2.0))) == [0, 3]
    assert corner.turns(1.9, 0.9, (0.0, 0.0, 2.0, 1.0)) == [0]
    assert corner.turns(1.9, 0.9, (0.0, 0.0, 1.0, 2.0)) == [3]
    assert corner.turns(1.96, 0.9, (0.0, 0.0, 2.0, 2.0)) == []
    assert middle.turns(1.9, 0.9, (0.0, 0.0, 1.0, 2.0)) == [1, 3]


def test_what_is_too_large_with_its_margins_is_not_admitted():
    sizes = np.array([[1.0, 0.6], [1.99, 0.6], [1.0, 1.6]])
    room = (0.0, 0.0, 2.0, 2.0)
    assert Anchor(EDGE, ((0, -1),)).admits(sizes, room).tolist() == [True, False, False]
    assert Anchor(MIDDLE, ()).admits(sizes, room).tolist() == [True, False, False]
    # At a side wall it stands turned: its width along y.
    narrow = (0.0, 0.0, 1.2, 2.0)
    assert Anchor(EDGE, ((-1, 0),)).admits(sizes, narrow).tolist() == [True, False, False]
    assert Anchor(EDGE, ((0, -1),)).admits(sizes, narrow).tolist() == [True, False, False]
