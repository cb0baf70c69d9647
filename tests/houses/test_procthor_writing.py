import json

import pytest

from adhoc.core.errors import HouseError
from adhoc.houses.house import House, Opening, Room
from adhoc.houses.procthor import parse_house
from adhoc.houses.procthor_writing import house_document, raise_walls
from adhoc.houses.samples import sample_house, sample_names

ROOMS = (
    Room("room|2", "Kitchen", ((0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0))),
    Room("room|3", "Bedroom", ((4.0, 0.0), (8.0, 0.0), (8.0, 3.0), (4.0, 3.0))),
)


def again(house: House) -> House:
    return parse_house(json.loads(json.dumps(house_document(house))), house.source, house.id)


def test_a_tiny_house_is_read_back_as_it_was(document):
    house = parse_house(document, "tiny")
    assert_same(again(house), house)


@pytest.mark.parametrize("name", sample_names())
def test_samples_are_read_back_as_they_were(name):
    house = sample_house(name)
    assert_same(again(house), house)


@pytest.mark.real_houses
def test_real_houses_are_read_back_as_they_were(real_houses):
    for house in real_houses[::25]:
        assert_same(again(house), house)


def test_walls_are_raised_on_every_edge():
    walls, openings = raise_walls(ROOMS, 2.5)
    assert len(walls) == 7
    assert openings == ()
    assert {
        frozenset(wall.rooms) for wall in walls if wall.start == (4.0, 0.0) and wall.end == (4.0, 3.0)
    } == {frozenset({"room|2", "room|3"})}


def test_an_open_plan_leaves_the_wall_out():
    walls, (passage,) = raise_walls(ROOMS, 2.5, open_between=[frozenset({"room|2", "room|3"})])
    assert len(walls) == 6
    assert (passage.kind, passage.start, passage.end) == ("open", (4.0, 0.0), (4.0, 3.0))


def test_a_door_in_the_middle_of_a_room_is_refused():
    door = Opening("door|2", "door", ("room|2", "room|3"), (2.0, 1.0), (2.0, 2.0), 0.0, 2.0, True)
    with pytest.raises(HouseError, match=r"door\|2"):
        raise_walls(ROOMS, 2.5, [door])


def assert_same(first: House, second: House) -> None:
    assert first.rooms == second.rooms
    assert [thing.id for thing in first.objects] == sorted_by_parent(second)
    for mine, theirs in ((first, second), (second, first)):
        things = {thing.id: thing for thing in theirs.objects}
        for thing in mine.objects:
            other = things[thing.id]
            assert thing.position == pytest.approx(other.position, abs=2e-5)
            assert thing.yaw == pytest.approx(other.yaw, abs=1e-6)
            assert (thing.asset, thing.size, thing.room, thing.parent) == (
                other.asset,
                other.size,
                other.room,
                other.parent,
            )
    assert sorted(wall.id for wall in first.walls) == sorted(wall.id for wall in second.walls)
    holes = {hole.id: hole for hole in second.openings}
    assert {hole.id for hole in first.openings} == set(holes)
    for hole in first.openings:
        other = holes[hole.id]
        assert (*hole.start, *hole.end, hole.bottom, hole.top) == pytest.approx(
            (*other.start, *other.end, other.bottom, other.top), abs=2e-5
        )
        assert (hole.kind, hole.passable, set(hole.rooms)) == (other.kind, other.passable, set(other.rooms))


def sorted_by_parent(house: House) -> list[str]:
    """Ids in the order of a file: every child right after its parent."""
    things = {thing.id for thing in house.objects}
    order: list[str] = []
    for thing in house.objects:
        if thing.parent not in things:
            order += [thing.id, *(child.id for child in house.objects if child.parent == thing.id)]
    return order
