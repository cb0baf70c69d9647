import pytest

from adhoc.houses import floor_plan

L_SHAPE = ((0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0))


def test_an_l_shape_is_two_rectangles():
    assert set(floor_plan.rectangles(L_SHAPE)) == {(0.0, 0.0, 3.0, 1.0), (0.0, 1.0, 1.0, 2.0)}
    assert floor_plan.area(L_SHAPE) == 4.0


def test_corners_on_straight_edges_make_no_more_rectangles():
    square = ((0.0, 0.0), (0.0, 1.0), (0.0, 2.0), (2.0, 2.0), (2.0, 0.0), (1.0, 0.0))
    assert floor_plan.rectangles(square) == ((0.0, 0.0, 2.0, 2.0),)


def test_a_u_shape_has_two_spans_at_one_level():
    u_shape = ((0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2))
    assert set(floor_plan.rectangles(u_shape)) == {(0, 0, 3, 1), (0, 1, 1, 2), (2, 1, 3, 2)}


@pytest.mark.parametrize(
    ("point", "inside", "away"),
    [((0.5, 1.5), True, 0.0), ((2.0, 1.5), False, 0.5), ((6.0, -4.0), False, 5.0)],
)
def test_containment_and_distance(point, inside, away):
    assert floor_plan.contains(L_SHAPE, point) is inside
    assert floor_plan.distance(L_SHAPE, point) == pytest.approx(away)


def test_overlap_is_the_shared_area():
    assert floor_plan.overlap([(0, 0, 2, 2)], [(1, 1, 3, 3), (5, 5, 6, 6)]) == 1.0
