import math

import numpy as np
import pytest
from box_geometry import penetration

from adhoc.houses.build import build_solids
from adhoc.houses.facts import assets_of
from adhoc.houses.facts_furniture import EDGE
from adhoc.houses.generation import room_furnishing
from adhoc.houses.generation.bedside import bedside_places
from adhoc.houses.generation.furnishing import BEFORE_DOORS, furnish
from adhoc.houses.generation.furniture_groups import single
from adhoc.houses.generation.room_furnishing import RoomFurnishing
from adhoc.houses.generation.shell import draw_shell
from adhoc.houses.generation.walkways import Walkways
from adhoc.houses.house import House, Room
from adhoc.houses.procthor_writing import raise_walls

BED, TABLE = single(assets_of("Bed")[0]), single(assets_of("SideTable")[0])
BACK = 0.025
SIDE = 6.0
SQUARE = ((0.0, 0.0), (SIDE, 0.0), (SIDE, SIDE), (0.0, SIDE))
BEDROOMS = 150


def distance_beside(table, bed):
    """Metres between a table and a bed along the bed's wall; None if their backs are not at one wall."""
    cosine, sine = math.cos(bed.yaw), math.sin(bed.yaw)
    dx, dy = (table.position[axis] - bed.position[axis] for axis in (0, 1))
    behind_bed, behind_table = bed.size[1] / 2, table.size[1] / 2 - (cosine * dy - sine * dx)
    if abs(math.remainder(table.yaw - bed.yaw, 2 * math.pi)) > 1e-9 or abs(behind_bed - behind_table) > 2e-5:
        return None
    return abs(cosine * dx + sine * dy) - table.size[0] / 2 - bed.size[0] / 2


def is_beside(table, bed):
    distance = distance_beside(table, bed)
    return distance is not None and 0.02 <= distance <= 0.05


def of(house, category):
    return [thing for thing in house.objects if thing.category == category]


def reaches_before(table, door):
    """Whether a table reaches into what is kept free before a door."""
    turned = round(table.yaw / (math.pi / 2)) % 2
    extent = table.size[1::-1] if turned else table.size[:2]
    wall = 0 if door.start[1] == door.end[1] else 1
    overlaps = []
    for axis in (0, 1):
        low, high = sorted((door.start[axis], door.end[axis]))
        more = extent[axis] / 2 + (0.0 if axis == wall else BEFORE_DOORS) - 1e-4
        overlaps.append(low - more < table.position[axis] < high + more)
    return all(overlaps)


def bedrooms() -> list[House]:
    found = []
    for seed in range(20 * BEDROOMS):
        generator = np.random.default_rng([seed, 8])
        shell = draw_shell(1, generator)
        if shell.rooms[0].room_type == "Bedroom":
            objects = furnish(shell, generator)
            found.append(House(str(seed), shell.rooms, shell.walls, shell.openings, objects))
        if len(found) == BEDROOMS:
            return found
    raise AssertionError("too few bedrooms")


@pytest.fixture(scope="module")
def with_bedsides() -> list[House]:
    return bedrooms()


@pytest.fixture(scope="module")
def without_bedsides() -> list[House]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(room_furnishing, "bedside_places", lambda *_: [])
        return bedrooms()


def tables_with_beds(houses):
    return [(house, table) for house in houses if of(house, "Bed") for table in of(house, "SideTable")]


def share_beside(houses):
    found = tables_with_beds(houses)
    return sum(any(is_beside(table, bed) for bed in of(house, "Bed")) for house, table in found) / len(found)


def test_most_side_tables_stand_beside_a_bed(with_bedsides, without_bedsides):
    assert share_beside(with_bedsides) > 0.6
    assert share_beside(without_bedsides) < 0.05


@pytest.mark.parametrize("category", ["Bed", "SideTable", "Dresser", "Desk", "Pillow"])
def test_nothing_becomes_more_or_less_frequent(with_bedsides, without_bedsides, category):
    numbers = [
        np.array([len(of(house, category)) for house in houses])
        for houses in (with_bedsides, without_bedsides)
    ]
    noise = math.sqrt(sum(number.var() for number in numbers) / BEDROOMS)
    assert abs(numbers[0].mean() - numbers[1].mean()) <= 2 * noise


def test_what_stands_beside_a_bed_is_clear_of_doors_and_of_everything_else(with_bedsides):
    checked = 0
    for house, table in tables_with_beds(with_bedsides):
        if not any(is_beside(table, bed) for bed in of(house, "Bed")):
            continue
        checked += 1
        solids = {solid.id: solid for solid in build_solids(house)}
        items = {thing.id for thing in house.objects if thing.parent == table.id}
        for other in set(solids) - items - {table.id}:
            for one in solids[table.id].boxes:
                assert all(penetration(one, box) < 0.0005 for box in solids[other].boxes), (house.id, other)
        for door in house.openings:
            if door.kind == "door":
                assert not reaches_before(table, door), (house.id, door.id)
    assert checked > 15


@pytest.mark.parametrize("turn", range(4))
def test_the_places_are_left_and_right_of_the_head_at_its_wall(turn):
    width, depth, _ = BED.pieces[0].size
    middle = [(3.0, BACK + depth / 2), (SIDE - BACK - depth / 2, 3.0)]
    middle += [(SIDE - along, SIDE - across) for along, across in middle]
    (bed,) = BED.placed(*middle[turn], turn)
    places = bedside_places(TABLE, [bed], SQUARE)
    assert len(places) == 2
    along, wall = (1, 0) if turn % 2 else (0, 1)
    for rectangle, anchor, table_turn in places:
        assert table_turn == turn
        assert anchor.kind == EDGE
        x, y = anchor.middle(rectangle, TABLE.extent(turn), np.random.default_rng(0))
        (table,) = TABLE.placed(x, y, turn)
        distance = abs((table.x, table.y)[along] - 3.0) - (TABLE.width + width) / 2
        assert 0.02 <= distance <= 0.05
        to_wall = (table.x, table.y)[wall] - TABLE.depth / 2
        if turn in (1, 2):
            to_wall = SIDE - (table.x, table.y)[wall] - TABLE.depth / 2
        assert to_wall == pytest.approx(BACK, abs=1e-5)
    low, high = sorted(rectangle[along] for rectangle, _, _ in places)
    assert low < 3.0 < high


def test_only_a_single_side_table_has_places_and_only_at_beds_at_walls():
    depth = BED.depth
    (bed,) = BED.placed(3.0, BACK + depth / 2, 0)
    assert bedside_places(BED, [bed], SQUARE) == []
    assert bedside_places(TABLE, TABLE.placed(3.0, BACK + TABLE.depth / 2, 0), SQUARE) == []
    assert bedside_places(TABLE, BED.placed(3.0, 3.0, 0), SQUARE) == []


def test_there_is_no_place_where_the_wall_ends():
    right = 3.0 + BED.width / 2 + 0.3
    outline = ((0.0, 0.0), (right, 0.0), (right, -2.0), (SIDE, -2.0), (SIDE, SIDE), (0.0, SIDE))
    (bed,) = BED.placed(3.0, BACK + BED.depth / 2, 0)
    ((rectangle, _, _),) = bedside_places(TABLE, [bed], outline)
    assert rectangle[2] < 3.0


class Offer:
    """Offers a bed and then three side tables, at walls only."""

    def __init__(self, *_):
        self.left = [BED, TABLE, TABLE, TABLE]

    def draw(self, rectangle, anchor):
        fits = self.left and anchor.kind == EDGE and anchor.turns(1.0, 1.0, rectangle)
        return (self.left[0], None) if fits else None

    def forget(self, *_):
        self.left.pop(0)


def test_a_second_table_takes_the_other_side_and_a_third_one_stands_elsewhere(monkeypatch):
    monkeypatch.setattr(room_furnishing, "FurnitureChoice", Offer)
    corners = [(x, y, x + 1.0, y + 1.0) for x in (0.0, 5.0) for y in (0.0, 5.0)]
    room = Room("room|2", "Bedroom", SQUARE)
    walls, _ = raise_walls([room], 2.7)
    numbers = []
    for seed in range(10):
        furnishing = RoomFurnishing(room, Walkways([room], walls), corners, np.random.default_rng(seed))
        furnishing.run(60)
        things = [entry.piece.house_object("", room.id, None) for entry in furnishing.placed]
        numbers.append((len(things), sum(is_beside(table, things[0]) for table in things[1:])))
    assert {number for number, _ in numbers} == {4}
    assert sum(beside == 2 for _, beside in numbers) >= 5
    assert max(beside for _, beside in numbers) == 2
