"""Doors and windows keep their assets."""

import json
from dataclasses import replace

import pytest

from adhoc.houses.house import House
from adhoc.houses.procthor import parse_house
from adhoc.houses.procthor_writing import house_document


def test_assets_are_read(document):
    house = parse_house(document, "tiny")
    assert {hole.id: hole.asset for hole in house.openings} == {
        "door|2|3": "Doorway_1",
        "door|1|3": "Doorway_4",
        "window|2|0": "Window_Fixed_60x36",
    }


def test_assets_are_written(document):
    house = parse_house(document, "tiny")
    written = house_document(house)
    assert {hole["id"]: hole["assetId"] for hole in (*written["doors"], *written["windows"])} == {
        hole.id: hole.asset for hole in house.openings
    }


def test_an_opening_without_an_asset_gets_a_usual_one(document):
    house = parse_house(document, "tiny")
    walls = tuple(
        replace(wall, openings=tuple(replace(hole, asset="") for hole in wall.openings))
        for wall in house.walls
    )
    written = house_document(replace(house, walls=walls))
    assert {door["assetId"] for door in written["doors"]} == {"Doorway_1"}
    assert {window["assetId"] for window in written["windows"]} == {"Window_Fixed_60x36"}


@pytest.mark.real_houses
def test_the_openings_of_real_houses_keep_their_assets_and_places(real_houses):
    for house in real_houses[::50]:
        again = parse_house(json.loads(json.dumps(house_document(house))), house.source, house.id)
        assert assets(again) == assets(house)


def assets(house: House) -> dict[str, str]:
    return {hole.id: hole.asset for hole in house.openings}
