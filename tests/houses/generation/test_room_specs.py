from collections import Counter

import numpy as np
import pytest

from adhoc.core.errors import HouseError
from adhoc.houses.generation.room_specs import PRIVATE, RoomGroup, RoomShare, draw_spec, room_counts


def test_houses_have_one_to_eight_or_ten_rooms():
    assert room_counts() == (1, 2, 3, 4, 5, 6, 7, 8, 10)


@pytest.mark.parametrize("rooms", room_counts())
def test_a_spec_has_as_many_rooms_as_were_asked_for(rooms):
    generator = np.random.default_rng(0)
    for _ in range(10):
        assert len(list(draw_spec(rooms, generator).rooms.leaves())) == rooms


@pytest.mark.parametrize("rooms", [0, 9, 11, -1])
def test_other_numbers_of_rooms_are_refused(rooms):
    with pytest.raises(HouseError, match=rf"{rooms} rooms.*1, 2, 3, 4, 5, 6, 7, 8, 10"):
        draw_spec(rooms, np.random.default_rng(0))


def test_single_rooms_come_as_often_as_among_real_houses():
    generator = np.random.default_rng(0)
    drawn = Counter(next(draw_spec(1, generator).rooms.leaves()).room_type for _ in range(2000))
    assert {room_type: round(count / 200) for room_type, count in drawn.items()} == {
        "LivingRoom": 4,
        "Kitchen": 3,
        "Bedroom": 3,
    }


def test_four_rooms_are_a_suite_and_a_kitchen_with_a_living_room():
    rooms = draw_spec(4, np.random.default_rng(0)).rooms
    assert rooms.members == (
        RoomGroup((RoomShare("Bedroom", 2), RoomShare("Bathroom", 1))),
        RoomGroup((RoomShare("Kitchen", 3), RoomShare("LivingRoom", 2))),
    )


@pytest.mark.parametrize("rooms", room_counts())
def test_no_bathroom_is_alone_in_its_group(rooms):
    generator = np.random.default_rng(1)
    groups = [draw_spec(rooms, generator).rooms for _ in range(5)]
    for group in groups:
        types = [member.room_type for member in group.members if isinstance(member, RoomShare)]
        assert PRIVATE not in types or any(room_type != PRIVATE for room_type in types)
        groups += [member for member in group.members if isinstance(member, RoomGroup)]
