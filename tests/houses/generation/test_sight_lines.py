import numpy as np

from adhoc.houses.generation.sight_lines import is_in_view
from adhoc.houses.generation.turned_boxes import turned_rows

NOTHING = turned_rows([])
HERE = np.array([[0.0, 0.0]])


def box(x, y, z, half=0.05):
    return np.array([x - half, y - half, z - half, x + half, y + half, z + half])


def test_something_in_the_open_is_seen():
    assert is_in_view(box(1.0, 0.0, 0.8), HERE, NOTHING)


def test_something_far_away_is_not_reached():
    assert not is_in_view(box(1.5, 0.0, 0.8), HERE, NOTHING)


def test_a_wall_hides_it():
    assert not is_in_view(box(1.0, 0.0, 0.8), HERE, turned_rows([(0.5, -2.0, 0.0, 0.52, 2.0, 2.5)]))


def test_a_low_wall_hides_it_from_nobody_or_only_from_low_robots():
    parapet = turned_rows([(0.5, -2.0, 0.0, 0.52, 2.0, 1.0)])
    assert is_in_view(box(1.0, 0.0, 0.8), HERE, parapet)
    assert not is_in_view(box(0.6, 0.0, 0.2), HERE, parapet)


def test_a_slanting_wall_hides_what_is_behind_it_only():
    # A wall through (0.6, 0) at 45 degrees: it ends left of the way to the one thing and not of the other's.
    wall = turned_rows([(0.55, -0.2, 0.0, 0.65, 0.2, 2.5)], (0.6, 0.0), 45.0)
    assert not is_in_view(box(1.0, 0.0, 0.8), HERE, wall)
    assert is_in_view(box(0.9, 0.4, 0.8), HERE, wall)
    assert not is_in_view(box(0.9, 0.4, 0.8), HERE, turned_rows([(0.55, -0.2, 0, 0.65, 0.4, 2.5)]))


def test_what_is_straight_below_the_camera_is_out_of_its_picture():
    assert not is_in_view(box(0.1, 0.0, 0.1), HERE, NOTHING)


def test_a_speck_is_too_small_to_be_noticed():
    assert not is_in_view(box(1.3, 0.0, 0.8, half=0.001), HERE, NOTHING)
