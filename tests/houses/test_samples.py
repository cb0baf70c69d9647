from collections import deque
from itertools import combinations

import numpy as np
import pytest
from box_geometry import holds, penetration

from adhoc.core.errors import HouseError
from adhoc.houses.build import build_solids
from adhoc.houses.facts import CORRIDOR, ROOM_TYPES, is_reasonable
from adhoc.houses.floor_plan import area, contains
from adhoc.houses.house import FLOOR
from adhoc.houses.samples import sample_house, sample_names
from adhoc.houses.solids import SolidKind

NAMES = ("corridor", "eight_rooms", "four_rooms", "one_room")
ROBOT_RADIUS = 0.2
CELL = 0.1


def test_the_samples_are_there():
    assert sample_names() == NAMES
    assert [len(sample_house(name).rooms) for name in NAMES] == [3, 8, 4, 1]
    assert [room.room_type for room in sample_house("corridor").rooms].count(CORRIDOR) == 1
    assert {room.room_type for room in sample_house("four_rooms").rooms} == set(ROOM_TYPES)


def test_an_unknown_sample_is_named():
    with pytest.raises(HouseError, match="castle"):
        sample_house("castle")


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_misplaced_and_there_is_enough_to_misplace(name):
    house = sample_house(name)
    items = [thing for thing in house.objects if thing.pickupable]
    assert 10 <= len(items) <= 25
    for item in items:
        receptacle = FLOOR if item.parent == FLOOR else house.object(item.parent).category
        assert is_reasonable(item.category, receptacle, house.room(item.room).room_type), item.id


@pytest.mark.parametrize("name", NAMES)
def test_no_two_things_penetrate(name):
    solids = build_solids(sample_house(name))
    house_itself = {SolidKind.WALL, SolidKind.FLOOR}
    for first, second in combinations(solids, 2):
        if {first.kind, second.kind} <= house_itself:
            continue
        deepest = max(penetration(a, b) for a in first.boxes for b in second.boxes)
        assert deepest <= 0.002, (first.id, second.id, deepest)


@pytest.mark.parametrize("name", NAMES)
def test_items_rest_a_millimetre_above_a_surface_of_their_parent(name):
    house = sample_house(name)
    solids = {solid.id: solid for solid in build_solids(house)}
    for item in (thing for thing in house.objects if thing.pickupable):
        support = solids[item.room if item.parent == FLOOR else item.parent]
        bottom = item.position[2] - item.size[2] / 2
        gaps = [bottom - surface.center[2] for surface in support.surfaces]
        assert any(0 < gap < 0.0021 for gap in gaps), (item.id, gaps)


@pytest.mark.parametrize("name", NAMES)
def test_a_robot_reaches_every_room_and_the_front_of_every_receptacle(name):
    house = sample_house(name)
    free, origin = free_cells(house)
    reached = np.array([origin + np.array(cell) * CELL for cell in flood(free)])
    for room in house.rooms:
        covered = sum(contains(room.polygon, point) for point in reached) * CELL**2
        assert covered > 0.35 * area(room.polygon), (room.id, covered)
    for solid in build_solids(house):
        if solid.kind is SolidKind.FURNITURE and solid.surfaces:
            centers = [surface.center[:2] for surface in solid.surfaces]
            nearest = min(np.hypot(*(reached - center).T).min() for center in centers)
            assert nearest < 1.0, (solid.id, nearest)


def test_some_things_lie_inside_furniture():
    parents = {
        house.object(thing.parent).category
        for house in map(sample_house, NAMES)
        for thing in house.objects
        if thing.parent not in (None, FLOOR)
    }
    assert {"Fridge", "Sofa", "ShelvingUnit", "Bed", "GarbageCan"} <= parents


def free_cells(house):
    """Cells where a robot's disc touches nothing below 1.7 m and is over a floor."""
    solids = build_solids(house)
    obstacles = [
        box
        for solid in solids
        for box in solid.boxes
        if solid.kind is not SolidKind.FLOOR and box.center[2] - box.half[2] < 1.7
    ]
    floors = [box for solid in solids if solid.kind is SolidKind.FLOOR for box in solid.boxes]
    corners = np.array([corner for room in house.rooms for corner in room.polygon])
    origin = corners.min(axis=0) + CELL / 2
    shape = tuple(((corners.max(axis=0) - origin) / CELL).astype(int) + 1)
    points = np.stack(np.meshgrid(*(np.arange(n) for n in shape), indexing="ij"), -1).reshape(-1, 2) * CELL
    points = np.column_stack([points + origin, np.zeros(len(points))])
    free = np.zeros(len(points), bool)
    for box in floors:
        free |= holds(box, points - [0, 0, 0.05])
    for box in obstacles:
        turned = np.abs((points[:, :2] - box.center[:2]) @ rotation(box).T)
        free &= np.hypot(*np.maximum(turned - np.array(box.half[:2]), 0).T) >= ROBOT_RADIUS
    return free.reshape(shape), origin


def rotation(box):
    cos_yaw, sin_yaw = np.cos(box.yaw), np.sin(box.yaw)
    return np.array([[cos_yaw, sin_yaw], [-sin_yaw, cos_yaw]])


def flood(free):
    start = tuple(np.argwhere(free)[len(np.argwhere(free)) // 2])
    seen, queue = {start}, deque([start])
    while queue:
        i, j = queue.popleft()
        for cell in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
            inside = 0 <= cell[0] < free.shape[0] and 0 <= cell[1] < free.shape[1]
            if inside and free[cell] and cell not in seen:
                seen.add(cell)
                queue.append(cell)
    return seen
