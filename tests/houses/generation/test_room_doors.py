from collections import Counter

import numpy as np
import pytest

from adhoc.houses.generation.floor_judging import OUTSIDE
from adhoc.houses.generation.room_doors import Passages, plan_passages
from adhoc.houses.generation.room_outlines import find_contacts
from adhoc.houses.generation.room_specs import RoomGroup, RoomShare

KITCHEN, LIVING = RoomShare("Kitchen"), RoomShare("LivingRoom")
BEDROOM, BATHROOM = RoomShare("Bedroom"), RoomShare("Bathroom")


def plan(rooms: RoomGroup, floor: list[list[int]], seed: int = 0) -> Passages | None:
    contacts = find_contacts(np.array(floor, dtype=np.int8), 2.0)
    return plan_passages(rooms, contacts, 1.2, np.random.default_rng(seed))


def pairs(passages: Passages | None) -> set[tuple[int, int]]:
    assert passages is not None
    return {*passages.doors, *passages.frames, *passages.left_out}


@pytest.mark.parametrize("seed", range(10))
def test_a_bathroom_is_entered_from_its_group_and_leads_nowhere(seed):
    """Bathroom 1 lies between its bedroom 0 and the kitchen 2, which also touches the bedroom."""
    rooms = RoomGroup((RoomGroup((BEDROOM, BATHROOM)), KITCHEN))
    assert pairs(plan(rooms, [[0, 1], [0, 2], [0, 2]], seed)) == {(0, 1), (0, 2)}


@pytest.mark.parametrize("seed", range(10))
def test_a_bathroom_among_several_rooms_has_one_door(seed):
    rooms = RoomGroup((KITCHEN, BATHROOM, LIVING))
    planned = pairs(plan(rooms, [[0, 0, 2], [0, 1, 2]], seed))
    assert (0, 2) in planned
    assert len(planned & {(0, 1), (1, 2)}) == 1


def test_a_house_that_only_a_bathroom_holds_together_is_refused():
    rooms = RoomGroup((RoomGroup((BEDROOM, BATHROOM)), KITCHEN))
    assert plan(rooms, [[0, 1, 2]]) is None


def test_a_bathroom_away_from_its_group_is_refused():
    rooms = RoomGroup((RoomGroup((BEDROOM, BATHROOM)), KITCHEN))
    assert plan(rooms, [[0, 2, 1]]) is None


@pytest.mark.parametrize("seed", range(10))
def test_members_in_a_row_are_joined_along_it(seed):
    rooms = RoomGroup((BEDROOM, KITCHEN, BEDROOM, BEDROOM))
    assert pairs(plan(rooms, [[0, 1, 2, 3]], seed)) == {(0, 1), (1, 2), (2, 3)}


@pytest.mark.parametrize("seed", range(20))
def test_doors_within_two_pairs_do_not_leave_the_pairs_apart(seed):
    """In a square of four, a door between 0 and 1 and one between 2 and 3 would do for 'a door each'."""
    rooms = RoomGroup((BEDROOM, KITCHEN, BEDROOM, BEDROOM))
    planned = pairs(plan(rooms, [[0, 1], [2, 3]], seed))
    assert len(planned) >= 3


def test_kitchens_and_living_rooms_are_often_open_to_each_other():
    rooms = RoomGroup((KITCHEN, LIVING))
    kinds = Counter()
    for seed in range(400):
        passages = plan(rooms, [[0, 0, 1, 1]], seed)
        kinds[len(passages.doors), len(passages.frames), len(passages.left_out)] += 1
    assert kinds[1, 0, 0] / 400 == pytest.approx(0.25, abs=0.06)
    assert kinds[0, 1, 0] / 400 == pytest.approx(0.375, abs=0.06)
    assert kinds[0, 0, 1] / 400 == pytest.approx(0.375, abs=0.06)


def test_bedrooms_are_never_open():
    passages = [plan(RoomGroup((KITCHEN, BEDROOM)), [[0, 0, 1, 1]], seed) for seed in range(30)]
    assert all(passage.doors == ((0, 1),) for passage in passages)


@pytest.mark.parametrize(
    ("rooms", "owner"),
    [(RoomGroup((BEDROOM, KITCHEN)), 1), (RoomGroup((BEDROOM, BATHROOM)), 0)],
)
def test_the_entrance_leads_into_a_kitchen_or_living_room_and_last_into_a_bathroom(rooms, owner):
    for seed in range(20):
        assert plan(rooms, [[0, 0, 1, 1]], seed).exterior.rooms == (OUTSIDE, owner)
