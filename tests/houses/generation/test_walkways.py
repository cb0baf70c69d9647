import numpy as np
import pytest

from adhoc.houses.generation.walkways import Walkways
from adhoc.houses.house import Opening, Room
from adhoc.houses.procthor_writing import raise_walls


def two_rooms(door_width: float) -> Walkways:
    """Rooms over x 0..3 and 3..6, y 0..3, with a door around y = 1.5."""
    rooms = (
        Room("room|2", "Kitchen", ((0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0))),
        Room("room|3", "Bedroom", ((3.0, 0.0), (6.0, 0.0), (6.0, 3.0), (3.0, 3.0))),
    )
    low, high = 1.5 - door_width / 2, 1.5 + door_width / 2
    door = Opening("door|1", "door", ("room|2", "room|3"), (3.0, low), (3.0, high), 0.0, 2.0, True)
    walls, _ = raise_walls(rooms, 2.5, [door])
    return Walkways(rooms, walls)


def test_robots_keep_off_walls_and_pass_doors():
    first, second = two_rooms(0.9).cells(2)
    # Lines of the lattice at 0.25 .. 2.75 m are free in both rooms, and x = 3 in the doorway.
    assert len(first) + len(second) == 2 * 11 * 11 + len(
        [y for y in (1.25, 1.5, 1.75) if abs(y - 1.5) < 0.24]
    )
    assert first.min() == 0.25
    assert second[:, 0].max() == 5.75


def test_too_narrow_a_door_leaves_one_room_alone():
    sizes = sorted(len(cells) for cells in two_rooms(0.4).cells(2))
    assert sizes[0] == 0
    assert sizes[1] == 121


def test_blocking_and_unblocking_are_inverse():
    walkways = two_rooms(0.9)
    before = walkways.reached()
    walkways.block((2.0, 0.0, 2.9, 3.0))
    assert walkways.reached().sum() < before.sum()
    walkways.unblock((2.0, 0.0, 2.9, 3.0))
    assert (walkways.reached() == before).all()


def test_a_slanting_obstacle_blocks_what_is_near_its_corners_only():
    # A bar of 1.4 m along the diagonal from (1, 1) to (2, 2), in a room of cells at every 0.25 m.
    walkways = two_rooms(0.9)
    bar = (0.8, 1.49, 2.2, 1.51)
    walkways.block(bar, 45.0)
    first, _ = walkways.cells(2)
    missing = {
        (x, y)
        for x in np.arange(0.25, 3, 0.25)
        for y in np.arange(0.25, 3, 0.25)
        if not (np.abs(first - (x, y)).sum(axis=1) < 1e-9).any()
    }
    diagonal = {(x, x) for x in (1.0, 1.25, 1.5, 1.75, 2.0)}
    beside = {(x + dx, x + 0.25 - dx) for x in (1.0, 1.25, 1.5, 1.75) for dx in (0.0, 0.25)}
    assert missing == diagonal | beside
    walkways.unblock(bar, 45.0)
    assert (walkways.reached() == two_rooms(0.9).reached()).all()


@pytest.mark.parametrize(("across", "sound"), [((1.0, 0.0, 1.5, 3.0), False), ((1.0, 0.0, 1.5, 1.5), True)])
def test_furniture_must_not_cut_a_room_off(across, sound):
    walkways = two_rooms(0.9)
    walkways.block(across)
    walkways.block((5.0, 0.0, 5.2, 0.2))
    assert walkways.are_sound(0.6, np.array([[5.0, 0.0, 5.2, 0.2]]), 0.7) is sound


def test_what_no_robot_comes_near_is_noticed():
    walkways = two_rooms(0.9)
    nook = np.array([[0.0, 0.0, 0.1, 0.1]])
    assert walkways.are_sound(0.1, nook, 0.5)
    walkways.block((0.0, 0.0, 1.0, 1.0))
    assert not walkways.are_sound(0.1, nook, 0.5)


@pytest.mark.parametrize(("low", "sound"), [(0.81, False), (0.75, True)])
def test_moves_between_free_cells_may_be_blocked_halfway(low, sound):
    walkways = two_rooms(0.9)
    # Two thin bars leave a gap around y = 1: robots of 0.42 m fit before and behind it, but in it only if it
    # is broader than they are. Besides 20 cells at the bars, 33 of the first room's 121 lie beyond.
    walkways.block((1.12, 1.22 if sound else 1.19, 1.13, 3.0))
    walkways.block((1.12, 0.0, 1.13, low))
    assert walkways.are_sound(0.7, np.zeros((0, 4)), 0.5) is sound
