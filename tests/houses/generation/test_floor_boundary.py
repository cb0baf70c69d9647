import numpy as np
import pytest

from adhoc.core.errors import HouseError
from adhoc.houses.generation.floor_boundary import _is_sound, draw_boundary


def inside(*rows: str) -> np.ndarray:
    return np.array([[cell == "#" for cell in row] for row in rows])


@pytest.mark.parametrize(("rooms", "shortest", "longest"), [(1, 2, 4), (2, 2, 5), (4, 4, 7), (10, 7, 10)])
def test_sides_follow_the_number_of_rooms(rooms, shortest, longest):
    generator = np.random.default_rng(0)
    sides = {side for _ in range(300) for side in draw_boundary(rooms, generator).shape}
    assert (min(sides), max(sides)) == (shortest, longest)


def test_sides_of_a_spec_win():
    generator = np.random.default_rng(0)
    shapes = {draw_boundary(8, generator, ((5, 8), (13, 16))).shape for _ in range(200)}
    assert shapes == {(depth, length) for depth in range(5, 9) for length in range(13, 17)}


def test_outlines_have_corners_cut_off_and_hold_together():
    generator = np.random.default_rng(0)
    outlines = [draw_boundary(10, generator) for _ in range(100)]
    assert all(_is_sound(outline) for outline in outlines)
    cut = [outline.size - outline.sum() for outline in outlines]
    assert max(cut) > 6
    assert min(cut) < 3


@pytest.mark.parametrize(
    ("outline", "sound"),
    [
        (inside("###", "#.."), True),
        (inside("#.", ".#"), False),
        (inside("##.", "##.", "..#"), False),
        (inside("#.#", "#.#"), False),
        (inside(".#.", "###", ".#."), True),
    ],
)
def test_outlines_that_fall_apart_are_told(outline, sound):
    assert _is_sound(outline) is sound


def test_an_outline_that_cannot_be_large_enough_is_refused():
    with pytest.raises(HouseError, match="no outline for 1 rooms"):
        draw_boundary(1, np.random.default_rng(0), fewest_cells=17)
