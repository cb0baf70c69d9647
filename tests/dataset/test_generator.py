import subprocess
import sys
from dataclasses import replace

import pytest

from adhoc.core.errors import HouseError
from adhoc.dataset import generator
from adhoc.dataset.checks.gravity import check_gravity
from adhoc.dataset.checks.house_checks import check_house
from adhoc.dataset.checks.house_format import read_back
from adhoc.dataset.generator import MOST_ATTEMPTS, ROOM_COUNTS, draw_candidate, generate_house
from adhoc.houses.house import House


@pytest.mark.parametrize("rooms", ROOM_COUNTS)
def test_generated_houses_are_sound(rooms):
    for seed in (100, 101):
        generated = generate_house(rooms, seed)
        assert len(generated.house.rooms) == rooms
        assert check_house(generated.house) == []
        assert check_gravity(generated.house) == []


def test_the_same_seed_gives_the_same_house_in_another_process():
    house = generate_house(3, 7, "again").house
    code = (
        "from adhoc.dataset.generator import generate_house; print(repr(generate_house(3, 7, 'again').house))"
    )
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert other.stdout.strip() == repr(house)
    assert generate_house(3, 8, "again").house.objects != house.objects


def test_a_house_is_exactly_what_its_document_says():
    house = generate_house(4, 5).house
    again = read_back(house)
    assert again == house


def test_a_house_says_where_it_comes_from():
    generated = generate_house(2, 3, "test-02-03")
    assert generated.house.id == "test-02-03"
    assert generated.house.source == f"generated, 2 rooms, seed 3, attempt {len(generated.rejected)}"


def test_unsound_attempts_are_rejected_with_their_reason(monkeypatch):
    monkeypatch.setattr(generator, "draw_candidate", spoiled(attempts=range(2)))
    generated = generate_house(1, 5)
    assert len(generated.rejected) >= 2
    assert all(reason.startswith("penetration: ") for reason in generated.rejected[:2])
    assert generated.house.source.endswith(f"attempt {len(generated.rejected)}")


def test_an_attempt_that_cannot_be_written_is_rejected(monkeypatch):
    def unwritable(rooms: int, seed: int, attempt: int, name: str) -> House:
        house = draw_candidate(rooms, seed, attempt, name)
        return replace(house, rooms=house.rooms * 2) if attempt == 0 else house

    monkeypatch.setattr(generator, "draw_candidate", unwritable)
    assert generate_house(1, 5, "twice").rejected[0].startswith("schema: twice: ")


def test_after_a_hundred_unsound_attempts_the_seed_is_given_up(monkeypatch):
    monkeypatch.setattr(generator, "draw_candidate", spoiled(attempts=range(MOST_ATTEMPTS)))
    with pytest.raises(HouseError, match=r"none of 100 attempts .* 1 rooms from seed 5 .* penetration"):
        generate_house(1, 5)


@pytest.mark.parametrize("rooms", [0, 9, 11, -1])
def test_other_numbers_of_rooms_are_refused(rooms):
    with pytest.raises(HouseError, match=f"1, 2, 3, 4, 5, 6, 7, 8, 10, not {rooms}"):
        generate_house(rooms, 0)


def spoiled(attempts):
    """Draws houses, of which those attempts have two things in one place."""

    def draw(rooms: int, seed: int, attempt: int, name: str) -> House:
        house = draw_candidate(rooms, seed, attempt, name)
        if attempt not in attempts:
            return house
        first = house.objects[0]
        return replace(house, objects=(*house.objects, replace(first, id=f"{first.id} again")))

    return draw
