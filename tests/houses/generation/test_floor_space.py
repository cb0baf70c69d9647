from adhoc.houses.generation.floor_space import FloorSpace

SQUARE = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0))
L_SHAPE = ((0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 2.0), (2.0, 4.0), (0.0, 4.0))


def rectangles(space):
    return {tuple(row) for row in space.free_rectangles().tolist()}


def test_an_empty_square_is_one_rectangle():
    assert rectangles(FloorSpace(SQUARE)) == {(0, 0, 4, 4)}


def test_an_l_has_its_three_cells_and_its_two_arms():
    found = rectangles(FloorSpace(L_SHAPE))
    assert found == {(0, 0, 2, 2), (2, 0, 4, 2), (0, 2, 2, 4), (0, 0, 4, 2), (0, 0, 2, 4)}


def test_what_was_taken_is_no_longer_free():
    space = FloorSpace(SQUARE)
    space.take((3.0, -1.0, 5.0, 5.0))
    assert rectangles(space) == {(0, 0, 3, 4)}
    space.take((0.0, 0.0, 3.0, 4.0))
    assert rectangles(space) == set()


def test_a_hole_in_the_middle_leaves_a_ring():
    space = FloorSpace(SQUARE)
    space.take((1.0, 1.0, 3.0, 3.0))
    found = rectangles(space)
    assert {(0, 0, 4, 1), (0, 3, 4, 4), (0, 0, 1, 4), (3, 0, 4, 4)} <= found
    assert (0, 0, 4, 4) not in found
    assert all(x1 <= 1 or x0 >= 3 or y1 <= 1 or y0 >= 3 for x0, y0, x1, y1 in found)


def test_many_lines_need_more_room_than_first_reserved():
    space = FloorSpace(((0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)))
    for k in range(8):
        space.take((k + 0.45, k + 0.45, k + 0.55, k + 0.55))
    found = space.free_rectangles()
    assert len(found) > 2000
    assert len({tuple(row) for row in found.tolist()}) == len(found)


def test_a_rectangle_is_free_on_several_parts_of_the_floor_but_not_beyond_nor_where_something_stands():
    space = FloorSpace(L_SHAPE)
    assert space.is_free((1.0, 0.0, 3.0, 2.0))
    assert not space.is_free((1.0, 0.5, 3.0, 2.1))
    space.take((0.0, 0.0, 1.0, 1.0))
    assert space.is_free((1.0, 0.0, 3.0, 2.0))
    assert not space.is_free((0.9, 0.0, 3.0, 2.0))
