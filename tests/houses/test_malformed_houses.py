"""Whatever is wrong with a file becomes one error that names file, field and value."""

import gzip
import json

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from adhoc.core.errors import AdhocError, AssetError, HouseError
from adhoc.houses.build import build_solids
from adhoc.houses.procthor import parse_house, read_house, read_houses

GONE = object()
"""Stands for 'delete the field'."""


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        (("rooms",), GONE, "rooms is missing"),
        (("rooms",), [], "rooms is a list of 0"),
        (("rooms",), {}, "rooms is an object"),
        (("rooms", 0, "roomType"), "Garage", r"rooms\[0\].roomType is 'Garage'"),
        (("rooms", 0, "id"), 2, r"rooms\[0\].id is 2"),
        (("rooms", 1, "id"), "room|2", "room|2"),
        (("rooms", 0, "floorPolygon"), [], "floorPolygon"),
        (("rooms", 0, "floorPolygon", 1), {"x": 0, "y": 0}, r"floorPolygon\[1\].z is missing"),
        (("rooms", 0, "floorPolygon", 1, "x"), "0", r"floorPolygon\[1\].x is '0'"),
        (("rooms", 0, "floorPolygon", 1, "x"), float("nan"), r"floorPolygon\[1\].x is nan"),
        (("rooms", 0, "floorPolygon", 1, "x"), float("inf"), r"floorPolygon\[1\].x is inf"),
        (("rooms", 0, "floorPolygon", 1, "x"), 10**400, "more than 200 bits"),
        (("rooms", 0, "floorPolygon", 1, "x"), True, r"floorPolygon\[1\].x is True"),
        (("rooms", 0, "floorPolygon", 1, "x"), 1.0, "oblique"),
        (("walls",), [], "has no wall from"),
        (("walls", 0, "roomId"), "room|9", r"walls\[0\].roomId is 'room\|9'"),
        (("walls", 0, "polygon"), [], r"walls\[0\].polygon"),
        (("walls", 0, "polygon", 0, "x"), 1.0, r"walls\[0\].polygon"),
        (("walls", 0, "polygon", 0, "y"), 2.5, r"walls\[0\].polygon"),
        (("walls", 0, "empty"), "yes", r"walls\[0\].empty is 'yes'"),
        (("doors", 0, "wall0"), "wall|9", r"doors\[0\].wall0 is 'wall\|9'"),
        (("doors", 0, "room1"), "room|9", r"doors\[0\].room1 is 'room\|9'"),
        (("doors", 0, "id"), "room|2", "used 2 times"),
        (("doors", 0, "holePolygon"), [], r"doors\[0\].holePolygon"),
        (("doors", 0, "holePolygon", 1, "x"), 3.5, "3 m long"),
        (("doors", 0, "holePolygon", 1, "x"), 0.5, "its lowest and its highest corner"),
        (("doors", 0, "holePolygon", 1, "y"), 2.6, "2.5 m high"),
        (("windows",), None, "windows is None"),
        (("objects",), GONE, "objects is missing"),
        (("objects", 0, "position", "y"), None, r"objects\[0\].position.y is None"),
        (("objects", 0, "rotation"), GONE, r"objects\[0\].rotation is missing"),
        (("objects", 0, "children", 0, "position"), [], r"objects\[0\].children\[0\].position"),
        (("objects", 0, "children"), "Egg", r"objects\[0\].children is 'Egg'"),
        (("objects", 1, "id"), "f", "'f' is used 2 times"),
        (("objects", 1, "id"), "", r"objects\[1\].id is ''"),
    ],
)
def test_what_is_wrong_is_named(document, path, value, words):
    change(document, path, value)
    with pytest.raises(HouseError, match=words) as caught:
        parse_house(document, "tiny.json line 7")
    assert str(caught.value).startswith("tiny.json line 7: ")


@pytest.mark.parametrize("path", [("objects", 0, "assetId"), ("windows", 0, "assetId")])
def test_an_unknown_asset_is_named_with_its_place(document, path):
    change(document, path, "Spaceship_1")
    with pytest.raises(AssetError, match="Spaceship_1") as caught:
        parse_house(document, "tiny.json line 7")
    assert str(caught.value).startswith("tiny.json line 7: ")
    assert f"{path[0]}[0].assetId" in str(caught.value)


def test_a_polygon_that_crosses_itself(document):
    corners = [(0, 0), (0, 3), (4, 3), (4, 1), (-1, 1), (-1, 0)]
    document["rooms"][0]["floorPolygon"] = [{"x": x, "y": 0, "z": z} for x, z in corners]
    with pytest.raises(HouseError, match="meet"):
        parse_house(document, "tiny")


def test_rooms_that_overlap(document):
    for corner in document["rooms"][1]["floorPolygon"]:
        corner["x"] -= 1
    with pytest.raises(HouseError, match=r"'room\|2' and 'room\|3' overlap"):
        parse_house(document, "tiny")


def test_openings_that_overlap(document):
    document["windows"].append({**document["windows"][0], "id": "again"})
    with pytest.raises(HouseError, match="overlap"):
        parse_house(document, "tiny")


def test_a_door_where_the_wall_is_left_out(document):
    for wall in document["walls"]:
        if wall["id"].endswith("|4|0|4|3"):
            wall["empty"] = True
    with pytest.raises(HouseError, match=r"door\|2\|3"):
        parse_house(document, "tiny")


@pytest.mark.parametrize("value", [None, 3, "house", [], [1]])
def test_a_document_that_is_no_object(value):
    with pytest.raises(HouseError, match="should be an object"):
        parse_house(value, "tiny")


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.json", b"", "empty"),
        ("a.jsonl", b"\n\n", "empty"),
        ("a.json", b'{"rooms": [', "cut off"),
        ("a.json", b'{"rooms": NaN}', "NaN"),
        ("a.json", b"[" * 100_000, "nested too deeply"),
        ("a.json", b'{"x": ' + b"9" * 5000 + b"}", "a.json"),
        ("a.json", b"\xff\xfe", "cannot be read"),
        ("a.json.gz", b"{}", "cannot be read"),
        ("a.json.gz", gzip.compress(b'{"rooms": []}' * 99, mtime=0)[:-12], "cannot be read"),
        ("a.json.gz", gzip.compress(b"{}", mtime=0)[:10] + b"\x07garbage", "cannot be read"),
        ("a.jsonl.gz", gzip.compress(b"{}\n" * 9, mtime=0)[:-4], "a.jsonl.gz"),
        ("a.yaml", b"{}", "ends with one of"),
        ("a.gz", b"{}", "ends with one of"),
    ],
)
def test_files_that_are_no_house_files(tmp_path, name, content, words):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(HouseError, match=words) as caught:
        list(read_houses(path))
    assert str(path) in str(caught.value)


def test_a_missing_file_and_a_folder(tmp_path):
    (tmp_path / "folder.json").mkdir()
    for name in ("missing.json", "missing.jsonl.gz", "folder.json"):
        with pytest.raises(HouseError, match=name):
            read_house(tmp_path / name)


def test_a_broken_line_is_numbered(tmp_path, document):
    path = tmp_path / "tiny.jsonl"
    path.write_text(json.dumps(document) + '\n{"rooms":\n')
    with pytest.raises(HouseError, match=r"tiny\.jsonl line 2"):
        list(read_houses(path))


json_values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.sampled_from(["room|2", "room|3", "exterior", "Egg_1", "wall|2|4|0|4|3"])
    | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=6,
)


@settings(max_examples=400, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_a_mutated_house_is_built_or_refused(fresh_document, data):
    house = fresh_document()
    for _ in range(data.draw(st.integers(1, 3))):
        path = data.draw(st.sampled_from(list(paths_of(house))))
        change(house, path, data.draw(st.just(GONE) | json_values))
        if not house:
            break
    message = refusal(lambda: build_solids(parse_house(house, "mutated")))
    assert message is None or message.startswith("mutated: ")


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_mutated_bytes_are_read_or_refused(tmp_path, document, data):
    content = bytearray(gzip.compress(json.dumps(document).encode(), mtime=0))
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path / "mutated.json.gz"
    path.write_bytes(content[: data.draw(st.integers(0, len(content)))])
    message = refusal(lambda: list(read_houses(path)))
    assert message is None or str(path) in message


def refusal(attempt):
    """What the library says against it, None if nothing; any other kind of error is a failure."""
    try:
        attempt()
    except AdhocError as error:
        return str(error)
    return None


def change(document, path, value):
    *way, last = path
    for step in way:
        document = document[step]
    if value is GONE:
        del document[last]
    else:
        document[last] = value


def paths_of(value, path=()):
    children = (
        value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    )
    for key, child in children:
        yield (*path, key)
        yield from paths_of(child, (*path, key))
