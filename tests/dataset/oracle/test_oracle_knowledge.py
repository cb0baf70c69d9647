"""What the oracle knows of a house, against the world itself."""

from __future__ import annotations

import numpy as np
import pytest
from oracle_houses import StillWorld, counter, idle, kitchen, on_floor, robot, scenario, two_rooms

from adhoc.core.values import Action, ActionName, Capability
from adhoc.dataset.checks.box_arrays import box_arrays
from adhoc.dataset.oracle.drops import Drops
from adhoc.dataset.oracle.execution import situation_now
from adhoc.dataset.oracle.knowledge import PYBULLET, HouseKnowledge
from adhoc.dataset.oracle.reach import Walls, within_reach
from adhoc.dataset.oracle.stances import AIMS, Deed, action_of, aim_of, pose_of
from adhoc.dataset.oracle.vacancy import fits_at, has_room
from adhoc.evaluation.sampling import sample_scenario
from adhoc.evaluation.scenario import prepare
from adhoc.houses.samples import sample_house
from adhoc.houses.solids import Box, Surface
from adhoc.worlds.pybullet_world import PyBulletWorld


@pytest.fixture
def world():
    world = StillWorld()
    yield world
    world.close()


def situation_of(world, task):
    prepare(world, task)
    house = HouseKnowledge(task.house)
    return situation_now(world, house, task.team, [it.object_id for it in task.misplaced], PYBULLET)


@pytest.mark.parametrize("deed", [deed for deed in Deed if deed < Deed.WAIT])
@pytest.mark.parametrize("heading", range(4))
def test_deeds_are_the_actions_that_do_them(world, deed, heading):
    world.reset(kitchen(), 0)
    aim = 4 * heading + 1
    world.add_agent("robot", Capability(), pose_of((2.0, 2.0), aim))
    action = action_of(deed, heading)
    assert action is not None
    world.step({"robot": action})
    pose = world.agents()["robot"].pose
    moved = {Deed.EAST: (2.25, 2.0), Deed.WEST: (1.75, 2.0), Deed.NORTH: (2.0, 2.25), Deed.SOUTH: (2.0, 1.75)}
    turned = {
        Deed.TURN_LEFT: 4 * ((heading + 1) % 4) + 1,
        Deed.TURN_RIGHT: 4 * ((heading - 1) % 4) + 1,
        Deed.LOOK_DOWN: aim + 1,
        Deed.LOOK_UP: aim - 1,
    }
    assert (pose.x, pose.y) == moved.get(deed, (2.0, 2.0))
    assert aim_of(pose) == turned.get(deed, aim)


def test_an_object_is_picked_up_from_the_stances_that_see_it_and_from_no_others(world):
    house = kitchen(on_floor("apple", 2.25, 1.0), counter(2.0, 3.7))
    task = scenario(house, ["apple"], [robot("worker", 1.0, 1.0)], idle("newcomer", 0.5, 3.5))
    situation = situation_of(world, task)
    seen = situation.picks("apple", 1.6)
    cell = situation.lattice.cell_at(1.0, 1.0)
    assert cell is not None
    assert not seen[cell, 1], "level, the floor is out of the picture"
    assert seen[cell, 2], "tilted down, it is in it"
    assert not seen[cell, 4 + 2 + 4], "looking the other way"
    world.step({"worker": Action(ActionName.PICK_UP, "apple")})
    assert world.agents()["worker"].held is None
    world.step({"worker": Action(ActionName.LOOK_DOWN)})
    world.step({"worker": Action(ActionName.PICK_UP, "apple")})
    assert world.agents()["worker"].held == "apple"


@pytest.mark.parametrize("name", ["one_room", "corridor"])
def test_nearly_all_stances_are_right_in_a_furnished_house(name):
    world = PyBulletWorld()
    task = sample_scenario(world, sample_house(name), 3)
    situation = situation_of(world, task)
    for object_id in situation.objects:
        stances = np.flatnonzero(situation.picks(object_id, 1.6)).tolist()[::7]
        wrong = [stance for stance in stances if not situation.is_seen(object_id, 1.6, stance)]
        assert len(wrong) <= 0.1 * len(stances)
    world.close()


def test_a_stance_that_shows_nothing_is_struck_out(world):
    house = kitchen(on_floor("apple", 2.25, 1.0), counter(2.0, 3.7))
    task = scenario(house, ["apple"], [robot("worker", 1.0, 1.0)], idle("newcomer", 0.5, 3.5))
    situation = situation_of(world, task)
    cell = situation.lattice.cell_at(1.0, 1.0)
    assert cell is not None
    situation.picks("apple", 1.6)[cell, 1] = True
    assert not situation.is_seen("apple", 1.6, AIMS * cell + 1)
    assert not situation.picks("apple", 1.6)[cell, 1]
    assert situation.version == 1


def test_objects_on_the_floor_close_moves_until_they_are_picked_up(world):
    house = two_rooms(on_floor("egg", 4.0, 1.375, "Egg", room="passage"), counter(1.5, 2.65, room="west"))
    task = scenario(house, ["egg"], [robot("worker", 1.5, 1.25)], idle("newcomer", 0.5, 0.5))
    lattice = situation_of(world, task).lattice
    cell = lattice.cell_at(3.75, 1.25)
    assert cell is not None
    assert lattice.obstacles == {"egg"}
    assert lattice.moves(["egg"])[cell, Deed.EAST] == -1
    assert lattice.moves([])[cell, Deed.EAST] == lattice.cell_at(4.0, 1.25)


def test_walls_hide_what_is_behind_them_but_not_what_is_seen_through_a_passage():
    house = HouseKnowledge(two_rooms())
    walls = Walls(house.solids)
    target = [Box((5.5, 1.375, 0.1), (0.05, 0.05, 0.1))]
    points = np.array([[4.5, 1.25], [4.5, 0.5], [5.5, 0.5]])
    assert walls.hide(target, points).tolist() == [False, True, False]


def test_what_is_near_behind_a_wall_is_not_within_reach(world):
    house = two_rooms(on_floor("apple", 5.25, 2.5, room="east"), counter(1.5, 2.65, room="west"))
    task = scenario(house, ["apple"], [robot("worker", 1.5, 1.25)], idle("newcomer", 0.5, 0.5))
    situation = situation_of(world, task)
    near, cell = situation.near("apple"), situation.lattice.cell_at
    assert near[cell(5.25, 1.25)]
    assert not near[cell(4.75, 1.5)], "the passage, 1.12 m away behind the corner"


def test_reach_is_measured_to_the_nearest_point_of_the_outline():
    box = [Box((0.0, 0.0, 0.5), (1.0, 0.5, 0.5), np.pi / 2)]
    points = np.array([[0.5 + 1.49, 0.0], [0.5 + 1.51, 0.0], [0.0, 1.0 + 1.49], [0.0, 1.0 + 1.51]])
    assert within_reach(box, points, 1.5).tolist() == [True, False, True, False]


def test_a_surface_has_room_until_it_is_full():
    surface = Surface((0.0, 0.0, 1.0), (0.2, 0.1), 0.0, 0.3)
    half = (0.1, 0.1, 0.1)

    def room(*boxes):
        return has_room(half, [surface], box_arrays([boxes]))

    assert room()
    assert room(Box((0.15, 0.0, 1.05), (0.05, 0.1, 0.05)))
    assert not room(Box((0.0, 0.0, 1.05), (0.05, 0.1, 0.05)))
    assert room(Box((0.0, 0.0, 1.5), (0.2, 0.1, 0.05))), "above the object"
    assert not has_room((0.1, 0.1, 0.16), [surface], box_arrays([])), "too tall"
    assert has_room((0.1, 0.2, 0.1), [surface], box_arrays([])), "turned"
    assert not has_room((0.21, 0.21, 0.1), [surface], box_arrays([])), "too large"


def test_a_box_fits_where_nothing_overlaps_it_at_its_height():
    others = box_arrays([[Box((1.0, 0.0, 0.5), (0.2, 0.2, 0.5))]])
    assert fits_at((0.0, 0.0), (0.3, 0.3), (0.0, 0.4), others)
    assert not fits_at((0.6, 0.0), (0.3, 0.3), (0.0, 0.4), others)
    assert fits_at((0.6, 0.0), (0.3, 0.3), (1.1, 1.4), others)


def test_nothing_is_dropped_in_the_passage(world):
    house = two_rooms(on_floor("box", 1.0, 2.0, "Box", room="west"))
    task = scenario(house, ["box"], [robot("worker", 1.5, 1.25)], idle("newcomer", 0.5, 0.5))
    situation = situation_of(world, task)
    lattice = situation.lattice
    half = situation.house.shape("box")[0].half
    drops = Drops(lattice, house.rooms, box_arrays([]), half)
    eastward = 2
    before_the_passage, in_the_room = lattice.cell_at(2.5, 1.25), lattice.cell_at(1.5, 0.5)
    assert before_the_passage is not None
    assert in_the_room is not None
    assert not drops.are_harmless(AIMS * before_the_passage + eastward)
    assert drops.are_harmless(AIMS * in_the_room + eastward)
