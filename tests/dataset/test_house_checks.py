import math
from dataclasses import replace

import pytest
from checked_houses import changed, real_houses, with_block

from adhoc.dataset.checks.gravity import check_gravity
from adhoc.dataset.checks.house_checks import CHECKS, Inspection, Violation, check_house, sound_house
from adhoc.dataset.checks.house_format import read_back
from adhoc.houses.facts import asset
from adhoc.houses.house import House, Opening
from adhoc.houses.procthor_writing import raise_walls
from adhoc.houses.samples import sample_house, sample_names


def found(house: House, check: str) -> list[Violation]:
    return list(CHECKS[check](Inspection(house)))


def subjects(violations: list[Violation]) -> set[str]:
    return {violation.subject for violation in violations}


@pytest.mark.parametrize("name", sample_names())
def test_nothing_is_wrong_with_the_sample_houses(name):
    house = sample_house(name)
    assert check_house(house) == []
    assert sound_house(house) == read_back(house)
    assert check_gravity(house) == []


def test_a_violation_reads_like_a_sentence():
    assert str(Violation("rooms", "room|2", "is cut off")) == "rooms: room|2: is cut off"


def test_a_box_in_the_doorway_cuts_the_room_off():
    size = asset("Dresser_205_1").size
    house = changed(
        with_block((9.25, 2.5, size[2] / 2), size),
        "block",
        asset="Dresser_205_1",
        category="Dresser",
        yaw=math.pi / 2,
        room="room|4",
        mass=1.0,
        is_receptacle=True,
    )
    (violation,) = found(house, "rooms")
    assert (violation.check, violation.subject) == ("rooms", "room|4")
    assert "Kitchen is cut off" in violation.detail
    assert check_house(house)[0] == violation
    assert sound_house(house) == violation
    assert found(with_block((9.6, 2.5, 0.4), (0.4, 1.0, 0.8)), "rooms") == []


def test_a_room_without_room_for_a_robot_is_named():
    (violation,) = found(with_block((7.0, 2.5, 0.4), (4.0, 1.4, 0.8)), "rooms")[1:]
    assert violation.subject == "room|4"
    first = found(with_block((7.0, 2.5, 0.4), (4.0, 1.4, 0.8)), "rooms")[0]
    assert first.subject == "room|3"
    assert "no cell" in first.detail


def test_a_house_full_of_furniture_has_no_room_at_all():
    house = with_block((7.0, 2.5, 0.4), (14.0, 5.0, 0.8))
    assert [violation.subject for violation in found(house, "rooms")] == [house.id]
    assert found(house, "sight") != []


def test_an_item_three_millimetres_inside_a_table_is_found():
    house = sample_house("corridor")
    x, y, z = house.object("Bowl|2|0").position
    sunk = changed(house, "Bowl|2|0", position=(x, y, z - 0.004))
    (violation,) = found(sunk, "penetration")
    assert {violation.subject, *violation.detail.split()} >= {"Bowl|2|0", "CoffeeTable|2|0,"}
    assert "3.0 mm" in violation.detail
    assert violation in check_house(sunk)
    assert found(changed(house, "Bowl|2|0", position=(x, y, z - 0.0029)), "penetration") == []


def test_rooms_must_not_overlap():
    house = sample_house("corridor")
    living, *others = house.rooms
    wide = replace(living, polygon=((0.0, 0.0), (5.1, 0.0), (5.1, 5.0), (0.0, 5.0)))
    assert "room|3" in subjects(found(replace(house, rooms=(wide, *others)), "penetration"))


def test_an_item_that_hovers_falls():
    house = sample_house("corridor")
    x, y, z = house.object("Bowl|2|0").position
    assert subjects(check_gravity(changed(house, "Bowl|2|0", position=(x, y, z + 0.1)))) == {"Bowl|2|0"}
    assert check_gravity(changed(house, "Bowl|2|0", position=(x, y, z + 0.015))) == []


def test_gravity_does_the_same_every_time():
    house = sample_house("one_room")
    x, y, z = house.object("Bowl|2|0").position
    hovering = changed(house, "Bowl|2|0", position=(x + 0.2, y, z + 0.4))
    first = check_gravity(hovering)
    assert first != []
    check_gravity(sample_house("corridor"))
    assert check_gravity(hovering) == first


def test_a_misplaced_item_is_found():
    house = sample_house("corridor")
    soap = changed(house, "Newspaper|2|0", category="SoapBar")
    (violation,) = found(soap, "placement")
    assert violation.subject == "Newspaper|2|0"
    assert "SoapBar does not belong on a CoffeeTable in a LivingRoom" in violation.detail
    on_floor = changed(house, "Bowl|2|0", parent="Floor")
    assert subjects(found(on_floor, "placement")) == {"Bowl|2|0"}


def test_an_item_in_a_closed_box_is_not_seen():
    house = sample_house("corridor")
    hidden = changed(house, "Bowl|2|0", position=(8.0, 2.0, 0.2))
    box = with_block((8.0, 2.0, 0.2), (0.3, 0.3, 0.4)).objects[-1]
    closed = replace(hidden, objects=(*hidden.objects, box))
    assert found(hidden, "sight") == []
    assert subjects(found(closed, "sight")) == {"Bowl|2|0"}


def test_an_item_out_of_reach_is_not_seen():
    house = sample_house("corridor")
    far = changed(house, "Bowl|2|0", position=(8.0, 2.0, 8.0))
    assert subjects(found(far, "sight")) == {"Bowl|2|0"}


@pytest.mark.parametrize(
    ("object_id", "changes", "part"),
    [
        ("Bowl|2|0", {"id": "Mug|4|0"}, "used 2 times"),
        ("Bowl|2|0", {"asset": "Bowl_9999"}, "Bowl_9999"),
        ("Bowl|2|0", {"size": (0.1, 0.1, 0.1)}, "size"),
        ("Bowl|2|0", {"room": "room|4"}, "room"),
        ("Bowl|2|0", {"mass": 7.0}, "mass"),
        ("Bowl|2|0", {"parent": "Nothing|2|0"}, "lost"),
        ("Bowl|2|0", {"yaw": math.nan}, "rotation"),
        ("Bowl|2|0", {"position": (math.inf, 0.0, 0.0)}, "position"),
    ],
)
def test_a_broken_document_is_found(object_id, changes, part):
    broken = changed(sample_house("corridor"), object_id, **changes)
    violations = check_house(broken)
    assert sound_house(broken) == violations[0]
    assert {violation.check for violation in violations} == {"schema"}
    assert part in str(violations[0])


def test_an_opening_that_its_document_cannot_say_is_found():
    house = sample_house("corridor")
    hole = Opening(
        "door|9", "door", ("room|2", "room|3"), (5.0, 2.0), (5.0, 3.0), 0.0, 2.0, True, "Doorway_1"
    )
    walls, openings = raise_walls(house.rooms, 2.6, [hole])
    lacking = replace(house, walls=walls, openings=(*openings, replace(hole, id="door|10")))
    assert "door|10" in subjects(check_house(lacking))


def test_order_of_parts_and_rounding_to_five_decimals_are_no_difference():
    house = sample_house("corridor")
    x, y, z = house.object("Bowl|2|0").position
    shifted = changed(house, "Bowl|2|0", position=(x + 1e-6, y, z))
    assert found(replace(shifted, objects=tuple(reversed(shifted.objects))), "schema") == []


@pytest.mark.real_houses
def test_real_houses_keep_their_format_and_their_rooms_can_be_reached():
    """They are not clean otherwise: pictures are 5 mm inside our walls, things stand in each other."""
    for house in real_houses(every=50):
        inspection = Inspection(house)
        for check in ("schema", "placement", "rooms"):
            assert list(CHECKS[check](inspection)) == []


def raised(object_id: str, by: float) -> House:
    house = sample_house("corridor")
    x, y, z = house.object(object_id).position
    return changed(house, object_id, position=(x, y, z + by))


class TestSupport:
    @pytest.mark.parametrize("by", [0.1, 0.5, -0.1])
    def test_items_lie_on_a_surface_of_their_receptacle(self, by):
        (violation,) = found(raised("Bowl|2|0", by), "support")
        assert violation.subject == "Bowl|2|0"
        assert "lies on no surface of CoffeeTable|2|0" in violation.detail

    def test_a_gap_that_a_fall_may_close_is_none(self):
        assert found(raised("Bowl|2|0", 0.015), "support") == []

    def test_a_receptacle_in_name_only_bears_nothing(self):
        house = sample_house("corridor")
        bowl = house.object("Bowl|2|0")
        x, y, _ = bowl.position
        beside = changed(house, bowl.id, position=(x, y - 1.0, bowl.size[2] / 2))
        assert subjects(found(beside, "support")) == {"Bowl|2|0"}

    @pytest.mark.parametrize("object_id", ["GarbageCan|2|0", "FloorLamp|2|0", "Chair|4|0"])
    def test_furniture_stands_on_the_floor(self, object_id):
        assert object_id in subjects(found(raised(object_id, 0.3), "support"))

    def test_pictures_hang_on_walls_and_nowhere_else(self):
        hung = changed(with_block((2.0, 0.03, 1.5), (0.5, 0.03, 0.4)), "block", category="Painting")
        assert found(hung, "support") == []
        off = changed(hung, "block", position=(2.0, 1.0, 1.5))
        (violation,) = found(off, "support")
        assert (violation.subject, "hangs on no wall" in violation.detail) == ("block", True)

    def test_what_is_fixed_to_a_piece_is_on_it(self):
        house = sample_house("corridor")
        table = house.object("CoffeeTable|2|0")
        faucet = replace(house.object("Bowl|2|0"), id="faucet", pickupable=False, parent=table.id)
        assert found(replace(house, objects=(*house.objects, faucet)), "support") == []
        aside = replace(faucet, position=(0.5, 4.5, 1.0))
        assert subjects(found(replace(house, objects=(*house.objects, aside)), "support")) == {"faucet"}
