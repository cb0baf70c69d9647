import numpy as np
import pytest

from adhoc.houses.facts import asset, assets_of
from adhoc.houses.generation.pieces import Piece
from adhoc.houses.generation.wall_things import OFF_WALL, TALL, WALL_TELEVISIONS, hang_things
from adhoc.houses.house import Opening, Room

ROOM = Room("room|2", "LivingRoom", ((0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)))
CELLS = np.array([[x / 4, y / 4] for x in range(1, 16) for y in range(1, 12)])


def hang(seed, openings=(), standing=(), room=ROOM, cells=CELLS, used=None):
    used = set() if used is None else used
    return hang_things(room, openings, 2.7, standing, cells, used, np.random.default_rng(seed))


def many(**scene):
    return [piece for seed in range(40) for piece in hang(seed, **scene)]


def test_things_hang_on_the_inside_of_all_four_walls_and_face_the_room():
    walls = set()
    for piece in many():
        x0, y0, x1, y1 = piece.rectangle
        gaps = {(0, 1): y0, (0, -1): 3 - y1, (1, 0): x0, (-1, 0): 4 - x1}
        assert gaps[piece.front] == pytest.approx(OFF_WALL, abs=1e-5)
        assert piece.bottom > 0
        assert piece.bounds[5] <= 2.7
        walls.add(piece.front)
    assert len(walls) == 4


def test_about_four_of_five_living_rooms_get_a_television_and_bathrooms_none():
    with_television = sum(any(p.facts.asset in WALL_TELEVISIONS for p in hang(seed)) for seed in range(60))
    assert 36 <= with_television <= 56
    bathroom = Room(ROOM.id, "Bathroom", ROOM.polygon)
    assert not any(piece.facts.category == "Television" for piece in many(room=bathroom))


def test_a_television_on_a_stand_is_enough():
    entry = asset(assets_of("Television")[0])
    there = Piece(entry, 2.0, 1.5, 0.5, 0, entry.size)
    assert {piece.facts.category for piece in many(standing=[there])} == {"Painting"}


def test_nothing_hangs_before_openings():
    window = Opening("window|1", "window", (ROOM.id, ROOM.id), (0.0, 0.0), (4.0, 0.0), 1.0, 2.0, False)
    left_out = Opening("open|1", "open", (ROOM.id, "room|3"), (4.0, 0.0), (4.0, 3.0), 0.0, 2.7, True)
    fronts = {piece.front for piece in many(openings=[window, left_out])}
    assert fronts == {(0, -1), (1, 0)}


def test_nothing_hangs_above_tall_furniture_and_the_rest_above_low_furniture():
    shelf, bed = asset("Fridge_12"), asset("Bed_2")
    assert shelf.size[2] > TALL > 0
    tall = Piece(shelf, 2.0, 0.025 + shelf.size[1] / 2, 0.0, 0, shelf.size)
    low = Piece(bed, 2.0, 3 - 0.025 - bed.size[1] / 2, 0.0, 2, bed.size)
    for piece in many(standing=[tall, low]):
        x0, _, x1, _ = piece.rectangle
        if piece.front == (0, 1):
            assert x1 < tall.rectangle[0] or x0 > tall.rectangle[2]
        if piece.front == (0, -1) and x1 > low.rectangle[0] and x0 < low.rectangle[2]:
            assert piece.bottom > bed.size[2] or bed.size[2] >= TALL


def test_hanging_things_keep_off_each_other_and_no_painting_hangs_twice_in_a_house():
    for seed in range(20):
        used: set[str] = set()
        things = [*hang(seed, used=used), *hang(seed + 100, used=used)]
        paintings = [piece.facts.asset for piece in things if piece.facts.category == "Painting"]
        assert len(set(paintings)) == len(paintings)
        here = hang(seed)
        for i, first in enumerate(here):
            for second in here[i + 1 :]:
                if first.front == second.front:
                    axis = 0 if first.front[0] == 0 else 1
                    a, b = first.rectangle, second.rectangle
                    assert a[axis + 2] < b[axis] or b[axis + 2] < a[axis]


def test_where_no_robot_comes_nothing_hangs():
    assert many(cells=np.empty((0, 2))) == []
