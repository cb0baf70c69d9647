from __future__ import annotations

from dataclasses import replace

import pytest

from adhoc.dataset.making.findable import Findable
from adhoc.houses.house import FLOOR
from adhoc.houses.samples import sample_house
from adhoc.worlds.world import ObjectTruth


def at(thing, position, receptacle=FLOOR):
    return ObjectTruth(thing.id, thing.category, position, None, receptacle, receptacle)


def with_size(house, thing, size):
    larger = replace(thing, size=size)
    return replace(house, objects=tuple(larger if it.id == thing.id else it for it in house.objects)), larger


@pytest.fixture(scope="module")
def house():
    return sample_house("corridor")


@pytest.fixture(scope="module")
def things(house):
    return [thing for thing in house.objects if thing.pickupable]


def door_of(house):
    hole = next(it for it in house.openings if it.passable)
    return (hole.start[0] + hole.end[0]) / 2, (hole.start[1] + hole.end[1]) / 2


def test_an_object_where_it_was_can_be_found(house, things):
    accept = Findable(house)
    found = [accept(at(thing, thing.position, thing.parent)) for thing in things]
    assert all(found)


def test_an_object_that_is_hidden_cannot(house, things):
    x, y, _ = things[0].position
    assert not Findable(house)(at(things[0], (x, y, -5.0)))


def test_an_object_that_hides_an_accepted_one_cannot_lie_there(house, things):
    x, y = door_of(house)
    first, second = things[:2]
    house, second = with_size(house, second, tuple(2 * extent for extent in first.size))
    accept = Findable(house)
    assert accept(at(first, (x, y, 1.2), "Shelf"))
    assert not accept(at(second, (x, y, 1.2), "Shelf"))
    assert Findable(house)(at(second, (x, y, 1.2), "Shelf"))


def test_an_object_that_cuts_a_room_off_cannot_lie_there(house, things):
    house, thing = with_size(house, things[0], (0.9, 0.9, 0.4))
    x, y = door_of(house)
    assert not Findable(house)(at(thing, (x, y, 0.2)))
    assert Findable(house)(at(thing, (x, y, 2.2), "Shelf"))
