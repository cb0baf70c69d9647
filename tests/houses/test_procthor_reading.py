import gzip
import json
import math

import pytest

from adhoc.core.errors import HouseError
from adhoc.houses.house import FLOOR
from adhoc.houses.procthor import parse_house, read_house, read_houses


def test_rooms_are_in_our_frame(document):
    house = parse_house(document, "tiny")
    assert [(room.id, room.room_type) for room in house.rooms] == [
        ("room|2", "Kitchen"),
        ("room|3", "Bedroom"),
    ]
    assert house.room("room|3").polygon == ((4, 0), (4, 3), (8, 3), (8, 0))


def test_positions_swap_y_and_z_and_yaw_changes_its_sign(document):
    fridge = parse_house(document, "tiny").object("f")
    assert fridge.position == (0.45, 1.5, 0.8463)
    assert fridge.yaw == pytest.approx(-math.pi / 2)
    assert fridge.size == pytest.approx((0.8535, 0.7064, 1.6926))


def test_the_category_comes_from_the_asset_never_from_the_id(document):
    document["objects"][0]["id"] = "Apple|2|0"
    assert parse_house(document, "tiny").object("Apple|2|0").category == "Fridge"


def test_parents_are_those_of_the_file_or_the_floor(document):
    parents = {thing.id: thing.parent for thing in parse_house(document, "tiny").objects}
    assert parents == {"f": None, "e": "f", "b": FLOOR, "t": None}


def test_the_room_of_a_thing_is_below_it_or_the_nearest(document):
    document["objects"][1]["position"]["x"] = 9.0
    rooms = {thing.id: thing.room for thing in parse_house(document, "tiny").objects}
    assert rooms == {"f": "room|2", "e": "room|2", "b": "room|3", "t": "room|3"}


def test_shared_walls_are_merged_and_exterior_walls_have_one_room(document):
    walls = {(wall.start, wall.end): wall for wall in parse_house(document, "tiny").walls}
    assert len(walls) == 7
    assert set(walls[(4, 0), (4, 3)].rooms) == {"room|2", "room|3"}
    assert walls[(0, 0), (0, 3)].rooms == ("room|2",)
    assert all(wall.height == 2.5 for wall in walls.values())


def test_a_hole_runs_from_the_first_ground_point_of_its_first_wall(document):
    door = next(o for o in parse_house(document, "tiny").openings if o.id == "door|2|3")
    assert (door.start, door.end) == ((4, 1.5), (4, 2.5))
    assert (door.bottom, door.top, door.passable, door.kind) == (0.0, 2.0, True, "door")


def test_a_door_to_the_outside_is_closed(document):
    door = next(o for o in parse_house(document, "tiny").openings if o.id == "door|1|3")
    assert (door.start, door.end, door.passable) == ((6, 0), (7, 0), False)


def test_windows_are_in_their_walls(document):
    house = parse_house(document, "tiny")
    wall = next(wall for wall in house.walls if wall.start == (0, 0) and wall.end == (0, 3))
    (window,) = wall.openings
    assert (window.kind, window.start, window.end) == ("window", (0, 1), (0, 2.5))
    assert (window.bottom, window.top, window.passable) == (0.8, 1.7, False)


def test_a_wall_left_out_is_an_open_passage(document):
    document["doors"] = []
    for wall in document["walls"]:
        if wall["id"].endswith("|4|0|4|3"):
            wall["empty"] = True
    house = parse_house(document, "tiny")
    (passage,) = (opening for opening in house.openings if opening.kind == "open")
    assert (passage.start, passage.end, passage.top, passage.passable) == ((4, 0), (4, 3), 2.5, True)
    assert set(passage.rooms) == {"room|2", "room|3"}
    assert not any(wall.start == (4, 0) and wall.end == (4, 3) for wall in house.walls)


def test_tilts_are_rounded_to_quarter_turns(document):
    document["objects"][0]["children"][0] |= {"assetId": "BaseballBat_1"}
    document["objects"][0]["children"][0]["rotation"] |= {"x": 85.0}
    size = parse_house(document, "tiny").object("e").size
    assert size == pytest.approx((0.08, 0.96, 0.09), abs=0.01)


def test_both_vintages_give_the_same_house(document):
    older = parse_house(document, "tiny")
    for part in ("rooms", "walls", "objects"):
        for entry in document[part]:
            entry |= {"layer": "Procedural2", "material": None, "color": {"r": 0.1}}
    document["metadata"]["agentPoses"] = {"arm": {}}
    for wall in document["walls"]:
        if "exterior" in wall["id"]:
            wall["roomId"] = "room|2" if "|0|0|0|3" in wall["id"] else "room|3"
    assert parse_house(document, "tiny") == older


@pytest.mark.parametrize("extension", [".json", ".json.gz"])
def test_a_file_with_one_house(tmp_path, document, extension):
    path = tmp_path / f"tiny{extension}"
    write(path, json.dumps(document))
    (house,) = read_houses(path)
    assert (house.id, house.source) == ("tiny", str(path))


@pytest.mark.parametrize("extension", [".jsonl", ".jsonl.gz"])
def test_a_file_with_a_house_per_line(tmp_path, document, extension):
    path = tmp_path / f"tiny{extension}"
    write(path, json.dumps(document) + "\n\n" + json.dumps(document) + "\n")
    assert [house.id for house in read_houses(path)] == ["tiny:0", "tiny:1"]
    assert read_house(path, 1).source == f"{path} line 3"


def test_houses_are_read_lazily_and_unasked_lines_are_not_parsed(tmp_path, document):
    path = tmp_path / "tiny.jsonl"
    write(path, json.dumps(document) + "\nbroken\n")
    assert next(iter(read_houses(path))).id == "tiny:0"
    write(path, "broken\n" + json.dumps(document) + "\n")
    assert read_house(path, 1).id == "tiny:1"


@pytest.mark.parametrize("index", [2, -1])
def test_an_index_that_is_not_there(tmp_path, document, index):
    path = tmp_path / "tiny.jsonl"
    write(path, json.dumps(document) + "\n")
    with pytest.raises(HouseError, match=str(index)):
        read_house(path, index)


def write(path, text):
    if path.suffix == ".gz":
        path.write_bytes(gzip.compress(text.encode()))
    else:
        path.write_text(text)
