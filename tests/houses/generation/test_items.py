from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from adhoc.houses.facts import asset, assets_of
from adhoc.houses.generation.items import ItemLaying, draw_house_bias
from adhoc.houses.generation.pieces import Piece, rotated
from adhoc.houses.generation.room_furnishing import Placed
from adhoc.houses.generation.turned_boxes import are_apart, bounding_row, rows_of

CELLS = np.array([[x / 4, y / 4] for x in range(-8, 9) for y in range(3, 9)])
"""Places of robots in front (+y) of a piece at the origin."""


def stand(name, x=0.0, y=0.0, turn=0):
    entry = asset(name)
    return Placed(Piece(entry, x, y, 0.0, turn, entry.size), None)


def lay(placed, seed, room_type="Kitchen", bias=0.1, cells=CELLS, hung=()):
    placed = list(placed)
    ItemLaying(room_type, placed, hung, cells, np.random.default_rng(seed)).run(bias)
    return placed


def laid(placed):
    return [entry for entry in placed if entry.on is not None]


def test_a_fridge_holds_food_inside_and_nothing_on_top():
    found = Counter()
    for seed in range(20):
        placed = lay([stand("Fridge_12")], seed)
        for entry in laid(placed):
            found[entry.piece.facts.category] += 1
            assert entry.piece.bounds[5] < placed[0].piece.size[2]
    assert {"Egg", "Lettuce"} <= set(found) <= {"Egg", "Lettuce", "Tomato", "Apple", "Potato", "WineBottle"}
    assert found["Egg"] == max(found.values())


def test_the_side_that_opens_decides_what_robots_see():
    behind = CELLS * (1, -1)
    assert any(laid(lay([stand("Fridge_12")], seed)) for seed in range(3))
    assert not any(laid(lay([stand("Fridge_12")], seed, cells=behind)) for seed in range(3))


def test_items_stay_apart_on_their_table():
    for seed in range(10):
        items = [entry.piece.bounds for entry in laid(lay([stand("Dining_Table_203_1")], seed, bias=0.5))]
        assert len(items) > 5
        for i, a in enumerate(items):
            for b in items[i + 1 :]:
                assert max(max(a[k] - b[k + 3], b[k] - a[k + 3]) for k in (0, 1)) > 0.004


def test_types_of_which_one_is_enough_come_once_in_a_room():
    tables = [stand("Dining_Table_203_1"), stand("Dining_Table_203_1", x=2.0)]
    cells = np.array([[x / 4, y / 4] for x in range(-8, 17) for y in range(3, 7)])
    for seed in range(10):
        found = Counter(
            entry.piece.facts.category for entry in laid(lay(tables, seed, cells=cells, bias=0.5))
        )
        assert found["Bowl"] <= 1
        assert found["Apple"] <= 1


def test_a_chair_below_its_table_is_not_laid_on_where_the_table_covers_it():
    table, chair = stand("Dining_Table_203_1"), stand("Chair_002_1", y=0.55, turn=2)
    edge = table.piece.rectangle[3]
    assert chair.piece.rectangle[1] < edge < chair.piece.rectangle[3]
    for seed in range(60):
        for entry in laid(lay([table, chair], seed, "LivingRoom", bias=0.6)):
            if entry.on == 1:
                assert entry.piece.rectangle[1] > edge


def test_items_on_a_high_desk_keep_off_the_shelf_along_its_back():
    desk = next(stand(name) for name in assets_of("Desk") if asset(name).size[2] > 0.95)
    for seed in range(40):
        placed = lay([desk], seed, "Bedroom", bias=0.5)
        for entry in laid(placed):
            x0, y0, z0, x1, y1, z1 = entry.piece.bounds
            for ax0, ay0, az0, ax1, ay1, az1 in desk.piece.boxes():
                meet = min(x1, ax1) > max(x0, ax0) and min(y1, ay1) > max(y0, ay0)
                assert not (meet and min(z1, az1) > max(z0, az0))


def test_items_on_a_piece_that_is_askew_are_turned_with_it():
    chair = stand(assets_of("ArmChair")[0])
    holder = replace(chair.piece, askew=25.0)
    found = 0
    for seed in range(40):
        for entry in laid(lay([Placed(holder, None)], seed, "LivingRoom", bias=0.6)):
            found += 1
            assert entry.piece.askew == 25.0
            # Turned back with the chair, it lies on a surface of the straight chair.
            x, y = rotated(entry.piece.x, entry.piece.y, -25.0)
            x0, y0, x1, y1 = replace(entry.piece, x=x, y=y, askew=0.0).rectangle
            assert any(
                part.x0 < x0 and part.y0 < y0 and x1 < part.x1 and y1 < part.y1
                for part in chair.piece.supports()
                if entry.piece.bottom == pytest.approx(part.z + 0.001)
            )
            assert is_clear_of(entry.piece, holder)
    assert found > 5


def is_clear_of(item, holder):
    return are_apart(bounding_row(item), rows_of(holder), 0.0005)


def test_a_fuller_house_holds_more():
    counts = [
        sum(len(laid(lay([stand("Countertop_I_6x2")], seed, bias=bias))) for seed in range(10))
        for bias in (-0.3, 0.0, 0.1)
    ]
    assert counts == sorted(counts)
    assert counts[0] < counts[2] / 2


def test_items_that_come_to_be_hidden_are_taken_away_and_the_others_keep_their_receptacle():
    pillow = asset("RoboTHOR_pillow_dvala_v")
    fridge, bed = stand("Fridge_12", x=-1.5), stand("Bed_2", x=1.0, y=-6.0)
    top = max(part.z for part in bed.piece.supports()) + 0.001
    far = Placed(Piece(pillow, 1.0, -6.0, top, 0, pillow.size), 0)
    for seed in range(5):
        placed = lay([bed, far, fridge], seed)
        assert all(entry.piece.facts.category != "Pillow" for entry in placed)
        assert all(placed[entry.on].piece.facts.category == "Fridge" for entry in laid(placed))


def test_house_biases_are_within_their_limits_and_mostly_negative():
    generator = np.random.default_rng(0)
    biases = [draw_house_bias(generator) for _ in range(400)]
    assert min(biases) >= -0.3
    assert max(biases) <= 0.1
    assert np.mean(biases) == pytest.approx(-0.3 + 0.4 * 3.5 / 5.4, abs=0.01)
