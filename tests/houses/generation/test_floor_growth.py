import numpy as np
import pytest

from adhoc.houses.generation.floor_growth import _fill, grow_rooms
from adhoc.houses.generation.floor_judging import FEWEST_CELLS, OUTSIDE, is_sound
from adhoc.houses.generation.room_specs import RoomGroup, RoomShare, draw_spec

SUITE = RoomGroup((RoomShare("Bedroom", 2), RoomShare("Bathroom", 1)))
PAIR = RoomGroup((RoomShare("Kitchen", 1), RoomShare("LivingRoom", 1)))


def connected(cells: np.ndarray) -> bool:
    left = {tuple(cell) for cell in np.argwhere(cells)}
    waiting = [left.pop()]
    while waiting:
        row, column = waiting.pop()
        for cell in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
            if cell in left:
                left.remove(cell)
                waiting.append(cell)
    return not left


def test_two_equal_rooms_get_two_equal_halves():
    best = grow_rooms(PAIR, np.ones((2, 4), dtype=bool), np.random.default_rng(0))[0]
    assert sorted(best[0]) == [0, 0, 1, 1]
    assert (best[0] == best[1]).all()
    assert best[0][0] == best[0][1]


def test_rooms_get_their_shares():
    best = grow_rooms(SUITE, np.ones((3, 4), dtype=bool), np.random.default_rng(0))[0]
    assert [(best == room).sum() for room in (0, 1)] == [8, 4]


def test_the_first_floor_is_the_best_of_its_kind():
    inside = np.ones((4, 6), dtype=bool)
    floors = grow_rooms(SUITE, inside, np.random.default_rng(3))
    errors = [abs((floor == 1).sum() - 8) for floor in floors]
    assert len(floors) > 50
    assert errors[0] == min(errors)
    assert errors[0] < max(errors)


def test_a_lonely_room_gets_every_cell():
    inside = np.array([[False, True, True], [True, True, True], [True, True, False]])
    (floor,) = grow_rooms(RoomGroup((RoomShare("Kitchen"),)), inside, np.random.default_rng(0), tries=1)
    assert (floor == np.where(inside, 0, OUTSIDE)).all()


def test_too_few_cells_give_no_floor():
    assert grow_rooms(PAIR, np.ones((1, 2), dtype=bool), np.random.default_rng(0)) == []
    assert grow_rooms(PAIR, np.ones((1, 3), dtype=bool), np.random.default_rng(0)) == []


@pytest.mark.parametrize(
    ("floor", "sound"),
    [
        ([[1, 1, 1], [1, 1, 2], [1, 2, 2]], True),
        ([[1, 1, 1, 1], [1, 2, 2, 1], [1, 1, 1, 1]], False),
        ([[1, 1, -1, -1], [1, 2, 1, -1], [1, 2, 1, -1], [1, 1, 1, -1]], False),
        ([[1, 1, 1], [1, 1, 1], [1, 1, 2]], False),
    ],
    ids=["sound", "around another", "touching at a corner", "one cell"],
)
def test_rooms_that_no_wall_can_go_round_are_told(floor, sound):
    """Node 0 is the house, 1 and 2 are its rooms."""
    assert is_sound(np.array(floor, dtype=np.int8), np.array([2, 0, 0])) is sound


def test_what_is_left_goes_to_the_neighbour_that_surrounds_it_most():
    floor = np.array([[0, 0, 1, 1], [2, 2, 0, 1]], dtype=np.int8)
    assert _fill(floor, 0)
    assert floor.tolist() == [[2, 2, 1, 1], [2, 2, 1, 1]]


def test_cells_far_from_any_room_are_reached_in_the_end():
    floor = np.array([[0, 0, 0, 1]], dtype=np.int8)
    assert _fill(floor, 0)
    assert floor.tolist() == [[1, 1, 1, 1]]


def test_cells_that_no_room_can_reach_are_told():
    assert not _fill(np.array([[0, OUTSIDE, 1]], dtype=np.int8), 0)


@pytest.mark.parametrize("rooms", [2, 4, 5, 7, 8, 10])
def test_rooms_and_groups_are_connected_and_fill_the_house(rooms):
    generator = np.random.default_rng(rooms)
    spec = draw_spec(rooms, generator)
    inside = np.ones((7, 12), dtype=bool)
    inside[:2, :2] = False
    for floor in grow_rooms(spec.rooms, inside, generator)[:20]:
        assert ((floor == OUTSIDE) == ~inside).all()
        first = 0
        for member in spec.rooms.members:
            count = len(list(member.leaves())) if isinstance(member, RoomGroup) else 1
            assert connected((floor >= first) & (floor < first + count))
            first += count
        assert first == rooms
        for room in range(rooms):
            assert (floor == room).sum() >= FEWEST_CELLS
            assert connected(floor == room)


def test_equal_generators_grow_equal_floors():
    inside = np.ones((5, 6), dtype=bool)
    one, two = (grow_rooms(SUITE, inside, np.random.default_rng(7)) for _ in range(2))
    assert len(one) == len(two)
    assert all((first == second).all() for first, second in zip(one, two))
