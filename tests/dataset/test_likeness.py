from __future__ import annotations

import io
import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from rich.console import Console

from adhoc.dataset.likeness import likeness_statistics as statistics
from adhoc.dataset.likeness.comparison import compare
from adhoc.dataset.likeness.likeness_figure import draw_likeness
from adhoc.dataset.likeness.likeness_statistics import WHOLE_HOUSE, house_statistics
from adhoc.dataset.likeness.likeness_table import likeness_markdown, likeness_table
from adhoc.houses.facts import asset, category_facts
from adhoc.houses.house import FLOOR, House, HouseObject, Opening, Room, Wall
from adhoc.houses.procthor import read_house, read_houses
from adhoc.houses.samples import sample_house

REAL_FOLDER = Path(__file__).parents[2].parent / "shared" / "data"
SINGLE_ROOMS = REAL_FOLDER / "procthor-single-room-500.jsonl.gz"
TEN_ROOMS = REAL_FOLDER / "procthor-train-1-ten-rooms.json.gz"


def thing(object_id, asset_id, x, y, bottom, parent=None, yaw=0.0):
    facts = asset(asset_id)
    return HouseObject(
        id=object_id,
        asset=asset_id,
        category=facts.category,
        position=(x, y, bottom + facts.size[2] / 2),
        yaw=yaw,
        size=facts.size,
        room="room|2",
        parent=parent,
        pickupable=facts.pickupable,
        mass=facts.mass,
        is_receptacle=category_facts(facts.category).is_receptacle,
    )


@pytest.fixture
def kitchen():
    """4 m by 3 m, 2.5 m high: a fridge with one egg in it and one on it, a table, a picture, a toaster."""
    room = Room("room|2", "Kitchen", ((0, 0), (4, 0), (4, 3), (0, 3)))
    corners = [*room.polygon, room.polygon[0]]
    door = Opening("d", "door", (room.id, room.id), (1, 0), (2, 0), 0, 2, passable=False)
    window = Opening("w", "window", (room.id, room.id), (0, 1), (0, 2), 0.8, 1.7, passable=False)
    walls = tuple(
        Wall(f"wall{number}", start, end, 2.5, (room.id,))
        for number, (start, end) in enumerate(pairwise(corners))
    )
    table = asset("Dining_Table_203_1").size
    fridge = asset("Fridge_5").size
    objects = (
        thing("fridge", "Fridge_5", fridge[0] / 2 + 0.02, 2.4, 0.0),
        thing("egg", "Egg_1", 0.45, 2.4, 1.0, "fridge"),
        thing("egg2", "Egg_1", 0.45, 2.4, fridge[2], "fridge"),
        thing("table", "Dining_Table_203_1", 2.2, 1.5, 0.0, yaw=math.radians(10)),
        thing("toaster", "Toaster_1", 2.2, 1.5, table[2], "table"),
        thing("ball", "Basketball_1", 3.5, 0.5, 0.0, FLOOR),
        thing("picture", "Wall_Decor_Painting_1", 2.0, 2.98, 1.2),
    )
    return House("tiny", (room,), walls, (door, window), objects)


class TestStatistics:
    def test_of_a_tiny_house(self, kitchen):
        (room,) = house_statistics(kitchen)
        fridge, table = asset("Fridge_5").size, asset("Dining_Table_203_1").size
        covered = (fridge[0] * fridge[1] + table[0] * table[1]) / 12
        assert room.group == "Kitchen"
        found = {name: list(values) for name, values in room.numbers.items()}
        assert found.pop(statistics.COVERED)[0] == pytest.approx(covered, abs=0.01)
        assert 0 < found.pop(statistics.FREE)[0] < 1 - covered
        assert found == {
            statistics.AREA: [12],
            statistics.SIDES: [0.75],
            statistics.CEILING: [2.5],
            statistics.WINDOWS: [1],
            statistics.DOORS: [1],
            statistics.FURNITURE: [2],
            statistics.WALL_THINGS: [1],
            statistics.FIXTURES: [1],
            statistics.ITEMS: [3],
            statistics.HOLDING: [1],
            statistics.AT_WALL: [0.5],
            statistics.TURNED: [0.5],
            "items on a Fridge": [1],
            "items in a Fridge": [1],
            "items on a DiningTable": [0],
            "items in a DiningTable": [0],
        }
        assert room.counts == {
            statistics.FURNITURE_TYPES: {"Fridge": 1, "DiningTable": 1},
            statistics.WALL_THING_TYPES: {"Painting": 1},
            statistics.FIXTURE_TYPES: {"Toaster": 1},
            statistics.ITEM_TYPES: {"Egg": 2, "BasketBall": 1},
            statistics.RECEPTACLE_TYPES: {"Fridge": 1, "DiningTable": 1},
            statistics.HOLDER_TYPES: {"Fridge": 2, FLOOR: 1},
        }

    def test_free_space_of_an_empty_room(self, kitchen):
        (room,) = house_statistics(replace(kitchen, objects=()))
        # Robots of radius 0.2 m keep off walls that are 10 mm thick on the inside.
        assert room.numbers[statistics.FREE][0] == pytest.approx((4 - 0.42) * (3 - 0.42) / 12, abs=0.005)
        assert statistics.AT_WALL not in room.numbers

    def test_of_a_house_of_several_rooms(self):
        house = sample_house("four_rooms")
        rooms = house_statistics(house)
        assert sorted(room.group for room in rooms) == sorted(
            ["Bedroom", "Bathroom", "Kitchen", "LivingRoom", WHOLE_HOUSE]
        )
        whole = rooms[-1]
        assert whole.counts[statistics.ROOM_TYPES] == dict.fromkeys(
            ("Bedroom", "Bathroom", "Kitchen", "LivingRoom"), 1
        )
        assert sum(room.numbers[statistics.ITEMS][0] for room in rooms[:-1]) == 23
        assert whole.numbers[statistics.ITEMS] == [23]
        assert whole.numbers[statistics.AREA][0] == pytest.approx(90, abs=0.5)
        assert np.mean([room.numbers[statistics.AREA_RATIO][0] for room in rooms[:-1]]) == pytest.approx(1)
        kitchen = next(room for room in rooms if room.group == "Kitchen")
        assert kitchen.numbers[statistics.OPEN_SIDES] == [1]


class TestCompare:
    def test_equal_houses_are_at_distance_zero(self, kitchen):
        likeness = compare([kitchen] * 20, [kitchen] * 30)
        assert {row.distance for row in likeness.rows} == {0.0}
        row = likeness.row(statistics.ITEMS, "Kitchen")
        assert (row.kind, row.real_mean, row.generated_mean, row.noise) == ("KS", 3, 3, 0)
        assert (row.real_count, row.generated_count) == (20, 30)
        row = likeness.row(statistics.ITEM_TYPES, "Kitchen")
        assert (row.kind, row.real_mean, row.real_count, row.generated_count) == ("TV", 3, 60, 90)
        assert row.real == pytest.approx({"Egg": 2 / 3, "BasketBall": 1 / 3})

    def test_removed_items_show_up(self, kitchen):
        bare = replace(kitchen, objects=tuple(it for it in kitchen.objects if not it.pickupable))
        likeness = compare([kitchen] * 20, [bare] * 4)
        # The ball lay on the floor.
        apart = {row.statistic: row.distance for row in likeness.rows if row.differs}
        names = (
            statistics.ITEMS,
            statistics.HOLDING,
            statistics.FREE,
            statistics.ITEM_TYPES,
            statistics.HOLDER_TYPES,
        )
        assert apart == dict.fromkeys(names, 1.0)

    def test_room_types_are_compared_each_on_its_own(self, kitchen):
        (room,) = kitchen.rooms
        bedroom = replace(kitchen, rooms=(replace(room, room_type="Bedroom"),), objects=())
        likeness = compare([kitchen, bedroom], [bedroom, bedroom])
        assert likeness.groups() == ("Bedroom",)
        assert all(row.distance == 0 for row in likeness.rows)
        assert compare([kitchen], [bedroom]).rows == ()

    def test_the_largest_gap_is_named(self, kitchen):
        bare = replace(kitchen, objects=tuple(it for it in kitchen.objects if it.id != "ball"))
        row = compare([kitchen] * 2, [bare] * 2).row(statistics.ITEM_TYPES, "Kitchen")
        assert row.distance == pytest.approx(1 / 3)
        assert row.remark == "BasketBall 33.3% → 0.0%"

    def test_receptacles_need_to_be_many(self, kitchen):
        few, many = (compare([kitchen] * count, [kitchen] * count) for count in (19, 20))
        assert "items in a Fridge" not in {row.statistic for row in few.rows}
        assert many.row("items in a Fridge", "Kitchen").real_mean == 1
        assert "items in a DiningTable" not in {row.statistic for row in many.rows}

    def test_a_single_real_room_is_placed_among_the_generated(self, kitchen):
        bare = replace(kitchen, objects=())
        row = compare([kitchen], [bare] * 15 + [kitchen] * 5).row(statistics.ITEMS, "Kitchen")
        assert row.noise is None
        assert not row.differs
        assert row.remark == "real mean above 88% of generated"

    def test_few_real_rooms_have_no_noise_floor(self, kitchen):
        bare = replace(kitchen, objects=())
        likeness = compare([kitchen, bare] * 9 + [bare], [kitchen])
        assert {row.noise for row in likeness.rows} == {None}
        assert likeness.summary().startswith("too few real rooms")
        likeness = compare([kitchen, bare] * 10, [kitchen])
        assert likeness.row(statistics.ITEMS, "Kitchen").noise > 0


class TestTables:
    def test_markdown(self, kitchen):
        bare = replace(kitchen, objects=())
        text = likeness_markdown(compare([kitchen] * 20, [bare] * 20))
        lines = text.splitlines()
        assert lines[0].startswith("| room type | statistic | real |")
        assert "| Kitchen | items | 3.00 | 0.00 | KS | **1.000** | 0.000 | 20 | 20 |  |" in lines
        assert {line.count("|") for line in lines[:-2]} == {11}
        assert "above the noise floor; mean KS" in lines[-1]

    def test_terminal(self, kitchen):
        console = Console(width=200, file=io.StringIO())
        console.print(likeness_table(compare([kitchen] * 20, [replace(kitchen, objects=())] * 20)))
        text = console.file.getvalue()
        assert "items" in text
        assert "1.000" in text
        assert "above the noise floor" in text


class TestFigure:
    def test_both_kinds_of_houses_are_drawn(self, kitchen, tmp_path):
        path = tmp_path / "new" / "likeness.png"
        draw_likeness(compare([kitchen] * 3, [replace(kitchen, objects=kitchen.objects[1:])] * 3), path)
        pixels = matplotlib.image.imread(path)[..., :3]
        for colour in ("#3c3f45", "#e07b1f"):
            wanted = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
            assert (np.abs(pixels - wanted).max(axis=-1) < 0.02).sum() > 500, colour

    def test_houses_of_several_rooms_with_nothing_in_them(self, tmp_path):
        house = sample_house("corridor")
        draw_likeness(compare([house], [replace(house, objects=())]), tmp_path / "a.png")
        assert (tmp_path / "a.png").stat().st_size > 20_000


@pytest.fixture(scope="module")
def houses():
    for path in (SINGLE_ROOMS, TEN_ROOMS):
        if not path.is_file():
            pytest.skip(f"the real houses are not beside the checkout: no {path.name}")
    return list(read_houses(SINGLE_ROOMS))


@pytest.mark.real_houses
class TestRealHouses:
    def test_two_halves_are_alike(self, houses):
        likeness = compare(houses[::2], houses[1::2])
        assert likeness.groups() == ("Kitchen", "LivingRoom", "Bedroom")
        assert len(likeness.rows) > 70
        distances = np.array([row.distance for row in likeness.rows])
        noises = np.array([row.noise for row in likeness.rows])
        # Halves of 250 differ less than the halves of a half that the noise is measured by.
        assert distances.mean() < noises.mean()
        assert np.mean([row.differs for row in likeness.rows]) < 0.2
        assert (distances < 3 * noises + 0.02).all()

    def test_robbed_houses_are_not(self, houses):
        robbed = [replace(it, objects=tuple(o for o in it.objects if o.category != "Chair")) for it in houses]
        likeness = compare(houses, robbed)
        for group in likeness.groups():
            assert likeness.row(statistics.FURNITURE_TYPES, group).distance > 0.15
            assert likeness.row(statistics.FURNITURE, group).differs
            assert not likeness.row(statistics.AREA, group).differs
        # Counted from the JSON: 147 kitchens, of which 146 have one fridge.
        assert likeness.row("items in a Fridge", "Kitchen").real_count == 146
        assert likeness.row(statistics.DOORS, "Kitchen").real_mean == 1
        assert likeness.row(statistics.FREE, "LivingRoom").real_mean == pytest.approx(0.55, abs=0.02)

    def test_the_ten_room_house(self, houses):
        rooms = house_statistics(read_house(TEN_ROOMS))
        assert len(rooms) == 11
        assert rooms[-1].numbers[statistics.ITEMS] == [100]
        assert rooms[-1].counts[statistics.ROOM_TYPES] == {
            "Kitchen": 1,
            "LivingRoom": 3,
            "Bedroom": 3,
            "Bathroom": 3,
        }
