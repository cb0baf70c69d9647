from hypothesis import given
from hypothesis import strategies as st

from adhoc.houses.wall_merging import WallSide, merge_walls


def side(room, start, end, empty=False, height=2.5):
    return WallSide(f"{room}{start}{end}", room, start, end, height, empty)


def test_two_sides_of_one_wall_become_one():
    (stretch,) = merge_walls([side("a", (4, 0), (4, 3)), side("b", (4, 3), (4, 0))])
    assert (stretch.start, stretch.end, stretch.rooms, stretch.empty) == ((4, 0), (4, 3), ("a", "b"), False)


def test_a_wall_that_two_rooms_share_is_cut_between_them():
    stretches = merge_walls([side("a", (0, 2), (6, 2)), side("b", (0, 2), (2, 2)), side("c", (2, 2), (6, 2))])
    assert [(s.low, s.high, set(s.rooms)) for s in stretches] == [(0, 2, {"a", "b"}), (2, 6, {"a", "c"})]


def test_pieces_of_one_wall_are_joined():
    stretches = merge_walls(
        [side("a", (0, 2), (3, 2)), side("a", (3, 2), (6, 2)), side(None, (6, 2), (0, 2))]
    )
    assert [(s.low, s.high, s.rooms) for s in stretches] == [(0, 6, ("a",))]


def test_a_wall_left_out_on_both_sides_is_empty():
    (stretch,) = merge_walls([side("a", (4, 0), (4, 3), True), side("b", (4, 0), (4, 3), True)])
    assert stretch.empty


def test_a_wall_on_one_side_is_a_wall_and_so_is_one_to_the_outside():
    assert not merge_walls([side("a", (4, 0), (4, 3), True), side("b", (4, 0), (4, 3))])[0].empty
    assert not merge_walls([side("a", (4, 0), (4, 3), True), side(None, (4, 0), (4, 3), True)])[0].empty


def test_walls_on_parallel_lines_stay_apart():
    assert len(merge_walls([side("a", (0, 0), (3, 0)), side("b", (0, 0.5), (3, 0.5))])) == 2


grid = st.integers(0, 6)
sides = st.builds(
    lambda room, axis, offset, low, length, flip: side(
        room,
        *(((low, offset), (low + length, offset)) if axis == 0 else ((offset, low), (offset, low + length)))[
            :: -1 if flip else 1
        ],
    ),
    st.sampled_from(["a", "b", "c", None]),
    st.sampled_from([0, 1]),
    grid,
    grid,
    st.integers(1, 4),
    st.booleans(),
)


@given(st.lists(sides, max_size=12))
def test_no_two_stretches_coincide_and_nothing_is_lost(given_sides):
    stretches = merge_walls(given_sides)
    for index, first in enumerate(stretches):
        for second in stretches[:index]:
            same_line = first.axis == second.axis and first.offset == second.offset
            assert not same_line or first.high <= second.low or second.high <= first.low
    for axis in (0, 1):
        for offset in range(7):
            wanted = {
                unit
                for s in given_sides
                if s.axis == axis and s.offset == offset
                for unit in range(int(s.low), int(s.high))
            }
            got = {
                unit
                for s in stretches
                if s.axis == axis and s.offset == offset
                for unit in range(int(s.low), int(s.high))
            }
            assert got == wanted
