import json
import math
import subprocess
import sys
from itertools import combinations

import numpy as np
import pytest

from adhoc.core.errors import HouseError
from adhoc.houses import floor_plan
from adhoc.houses.facts import asset, wall_hole
from adhoc.houses.generation.room_specs import room_counts
from adhoc.houses.generation.shell import Shell, draw_shell
from adhoc.houses.house import House, Opening
from adhoc.houses.procthor import parse_house
from adhoc.houses.procthor_writing import house_document

SEEDS = 12
ROBOT, LATTICE, HALF_WALL = 0.2, 0.25, 0.01


def shells(rooms: int) -> list[Shell]:
    return [draw_shell(rooms, np.random.default_rng([rooms, seed])) for seed in range(SEEDS)]


@pytest.fixture(scope="module", params=room_counts())
def drawn(request) -> list[Shell]:
    return shells(request.param)


def passages(shell: Shell) -> list[Opening]:
    return [hole for hole in shell.openings if hole.passable]


def reached(shell: Shell, ways: list[Opening]) -> set[str]:
    found, waiting = {shell.rooms[0].id}, [shell.rooms[0].id]
    while waiting:
        here = waiting.pop()
        for hole in ways:
            if here in hole.rooms:
                fresh = set(hole.rooms) - found
                found |= fresh
                waiting.extend(fresh)
    return found


def test_a_shell_is_read_back_exactly_as_written(drawn):
    for shell in drawn:
        house = House("h", shell.rooms, shell.walls, shell.openings, (), "s")
        assert parse_house(json.loads(json.dumps(house_document(house))), "s", "h") == house


def test_rooms_tile_the_floor(drawn):
    for shell in drawn:
        for one, other in combinations(shell.rooms, 2):
            first, second = (floor_plan.rectangles(room.polygon) for room in (one, other))
            assert floor_plan.overlap(first, second) == 0
        outer = sum(math.dist(wall.start, wall.end) for wall in shell.walls if len(wall.rooms) == 1)
        edges = [edge for room in shell.rooms for edge in floor_plan.edges(room.polygon)]
        left_out = [hole for hole in shell.openings if hole.kind == "open"]
        inner = sum(math.dist(wall.start, wall.end) for wall in shell.walls if len(wall.rooms) == 2)
        inner += sum(math.dist(hole.start, hole.end) for hole in left_out)
        assert sum(math.dist(*edge) for edge in edges) == pytest.approx(outer + 2 * inner)


def test_every_room_can_be_reached(drawn):
    for shell in drawn:
        assert reached(shell, passages(shell)) == {room.id for room in shell.rooms}


def test_no_bathroom_is_a_passage(drawn):
    for shell in drawn:
        bathrooms = {room.id for room in shell.rooms if room.room_type == "Bathroom"}
        for bathroom in bathrooms:
            doors = [hole for hole in passages(shell) if bathroom in hole.rooms]
            assert len(doors) == 1
            assert set(doors[0].rooms) - bathrooms


def test_one_closed_door_leads_outside(drawn):
    for shell in drawn:
        (closed,) = (hole for hole in shell.openings if hole.kind == "door" and not hole.passable)
        assert closed.rooms[0] == closed.rooms[1]
        (wall,) = (wall for wall in shell.walls if closed in wall.openings)
        assert wall.rooms == closed.rooms[:1]
        assert not any(hole.kind == "window" for hole in wall.openings)


def test_openings_lie_inside_their_walls_and_between_their_rooms(drawn):
    for shell in drawn:
        cut = [(wall, hole) for wall in shell.walls for hole in wall.openings]
        assert {hole for _, hole in cut} == {hole for hole in shell.openings if hole.kind != "open"}
        for wall, hole in cut:
            axis = 0 if wall.start[1] == wall.end[1] else 1
            assert wall.start[1 - axis] == hole.start[1 - axis] == hole.end[1 - axis]
            assert wall.start[axis] + 0.04 < hole.start[axis] < hole.end[axis] < wall.end[axis] - 0.04
            assert set(wall.rooms) == set(hole.rooms)
            assert 0 <= hole.bottom < hole.top < wall.height == shell.height


def test_holes_have_the_sizes_of_their_assets(drawn):
    for hole in (hole for shell in drawn for hole in shell.openings if hole.kind != "open"):
        size = wall_hole(hole.asset) if hole.kind == "window" else asset(hole.asset).size[::2]
        assert math.dist(hole.start, hole.end) == pytest.approx(size[0], abs=1e-3)
        assert hole.top - hole.bottom == pytest.approx(size[1], abs=1e-3)


def test_windows_are_one_on_a_wall_and_centred(drawn):
    for shell in drawn:
        types = {room.id: room.room_type for room in shell.rooms}
        for wall in shell.walls:
            windows = [hole for hole in wall.openings if hole.kind == "window"]
            assert len(windows) <= 1
            for window in windows:
                assert types[window.rooms[0]] != "Bathroom"
                assert window.bottom + window.top == pytest.approx(min(3.0, shell.height), abs=2e-3)


def test_a_robot_on_the_lattice_fits_through_every_passage(drawn):
    for hole in (hole for shell in drawn for hole in passages(shell)):
        axis = 0 if hole.start[1] == hole.end[1] else 1
        low = hole.start[axis] + ROBOT + HALF_WALL
        high = hole.end[axis] - ROBOT - HALF_WALL
        assert math.floor(high / LATTICE) * LATTICE >= low


def test_lengths_are_whole_millimetres(drawn):
    for shell in drawn:
        corners = [corner for room in shell.rooms for corner in room.polygon]
        corners += [end for hole in shell.openings for end in (hole.start, hole.end)]
        heights = [shell.height, *(end for hole in shell.openings for end in (hole.bottom, hole.top))]
        for length in (*heights, *(value for corner in corners for value in corner)):
            assert length == round(length, 3)


def test_ceilings_are_as_high_as_in_procthor():
    heights = [draw_shell(1, np.random.default_rng(seed)).height for seed in range(300)]
    assert min(heights) >= 2.5
    assert max(heights) <= 7.0
    # 2.5 + 4.5 * 1.25 / 6.75
    assert np.mean(heights) == pytest.approx(3.33, abs=0.15)


def test_rooms_are_about_as_large_as_their_shares():
    """Four rooms: bedroom 1/3, bathroom 1/6, kitchen 3/10, living room 1/5 of the floor."""
    wanted = {"Bedroom": 1 / 3, "Bathroom": 1 / 6, "Kitchen": 0.3, "LivingRoom": 0.2}
    errors = []
    for shell in shells(4) + shells(4):
        areas = {room.room_type: floor_plan.area(room.polygon) for room in shell.rooms}
        errors.append(max(abs(areas[kind] / sum(areas.values()) - share) for kind, share in wanted.items()))
    assert np.median(errors) < 0.06
    assert max(errors) < 0.2


def test_an_impossible_number_of_rooms_is_refused():
    with pytest.raises(HouseError, match="9 rooms"):
        draw_shell(9, np.random.default_rng(0))


def test_a_shell_that_cannot_be_drawn_is_refused_after_a_while(monkeypatch):
    monkeypatch.setattr("adhoc.houses.generation.shell.plan_passages", lambda *_: None)
    with pytest.raises(HouseError, match="no floor for 4 rooms"):
        draw_shell(4, np.random.default_rng(0))


def test_another_process_draws_the_same_shells():
    program = (
        "import numpy as np; from adhoc.houses.generation.shell import draw_shell;"
        "print([draw_shell(n, np.random.default_rng(5)) for n in (1, 4, 10)])"
    )
    there = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    here = [draw_shell(rooms, np.random.default_rng(5)) for rooms in (1, 4, 10)]
    assert there.strip() == str(here)


@pytest.mark.real_houses
def test_single_rooms_are_as_large_as_real_ones(real_houses):
    drawn = [draw_shell(1, np.random.default_rng([9, seed])).rooms[0] for seed in range(1500)]
    real = [house.rooms[0] for house in real_houses if len(house.rooms) == 1]
    for room_type in ("Kitchen", "LivingRoom", "Bedroom"):
        mine, theirs = (
            np.sort([floor_plan.area(room.polygon) for room in rooms if room.room_type == room_type])
            for rooms in (drawn, real)
        )
        points = np.concatenate([mine, theirs])
        shares = [np.searchsorted(areas, points, side="right") / len(areas) for areas in (mine, theirs)]
        assert np.abs(shares[0] - shares[1]).max() < 0.1
