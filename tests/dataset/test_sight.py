import math

import numpy as np
import pytest
from checked_houses import real_houses

from adhoc.core.values import Capability, Pose
from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.dataset.checks.sight import Sight
from adhoc.dataset.checks.sight_rays import PITCHES
from adhoc.houses.build import build_solids
from adhoc.houses.house import House, Room
from adhoc.houses.samples import sample_house, sample_names
from adhoc.houses.solids import Box, Solid, SolidKind
from adhoc.worlds.pybullet_world import PyBulletWorld
from adhoc.worlds.sensor.visibility import survey

ROOM = Room("room|2", "Kitchen", ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)))


def thing(name: str, center: tuple[float, float, float], half: tuple[float, float, float]) -> Solid:
    return Solid(name, "Thing", SolidKind.ITEM, (Box(center, half),))


def sight_of(*solids: Solid) -> Sight:
    return Sight(solids, FreeCells([ROOM], solids))


CUBE = thing("cube", (2.0, 2.0, 0.5), (0.05, 0.05, 0.05))


def only(cells: FreeCells, i: int, j: int) -> FreeCells:
    """The same cells, but robots stand on one of them."""
    cells.connected = np.zeros_like(cells.free)
    cells.connected[i, j] = True
    return cells


def viewpoints(name: str, height: float, *solids: Solid) -> set[tuple[int, int]]:
    """The cells of the room on which a robot, were it alone there, would see the thing in its reach."""
    places = np.argwhere(FreeCells([ROOM], solids).connected).tolist()
    cells = FreeCells([ROOM], solids)
    return {(i, j) for i, j in places if Sight(solids, only(cells, i, j), (height,)).is_seen(name)}


def test_a_cube_in_the_open_is_seen_from_all_around_and_no_further_than_the_reach():
    assert sight_of(CUBE).is_seen("cube")
    cells = viewpoints("cube", 0.9, CUBE)
    distances = [math.hypot(0.25 * i - 2.0, 0.25 * j - 2.0) for i, j in cells]
    assert (8, 8) not in cells
    assert max(distances) < 1.5 + 0.05 * math.sqrt(2)
    every = {(i, j) for i in range(17) for j in range(17) if 0.3 < math.hypot(i - 8, j - 8) * 0.25 < 1.44}
    assert every <= cells


def test_one_of_the_heights_is_enough():
    parapet = thing("parapet", (2.5, 2.0, 0.6), (0.01, 2.0, 0.6))
    cells = only(FreeCells([ROOM], [CUBE, parapet]), 13, 8)
    seen = [
        Sight([CUBE, parapet], cells, heights).is_seen("cube") for heights in [(0.9,), (3.2,), (0.9, 3.2)]
    ]
    assert seen == [False, True, True]


def test_the_reach_is_measured_from_the_robots_axis():
    cells = only(FreeCells([ROOM], [CUBE]), 4, 8)
    assert Sight([CUBE], cells, reach=0.951).is_seen("cube")
    assert not Sight([CUBE], cells, reach=0.949).is_seen("cube")


def test_a_screen_hides_what_is_behind_it():
    screen = thing("screen", (2.5, 2.0, 1.0), (0.01, 2.0, 1.0))
    cells = viewpoints("cube", 1.2, CUBE, screen)
    assert cells
    assert all(i / 4 < 2.5 for i, _ in cells)


def test_what_is_in_a_closed_box_is_not_seen():
    walls = [
        Box((2.0 + dx, 2.0 + dy, 0.5 + dz), half)
        for dx, dy, dz, half in [
            (0.2, 0, 0, (0.01, 0.21, 0.21)),
            (-0.2, 0, 0, (0.01, 0.21, 0.21)),
            (0, 0.2, 0, (0.21, 0.01, 0.21)),
            (0, -0.2, 0, (0.21, 0.01, 0.21)),
            (0, 0, 0.2, (0.21, 0.21, 0.01)),
            (0, 0, -0.2, (0.21, 0.21, 0.01)),
        ]
    ]
    assert not sight_of(CUBE, Solid("crate", "Box", SolidKind.FURNITURE, tuple(walls))).is_seen("cube")
    open_crate = Solid("crate", "Box", SolidKind.FURNITURE, tuple(walls[:4]))
    assert sight_of(CUBE, open_crate).is_seen("cube")


def test_what_is_smaller_than_a_pixel_may_be_missed_but_is_never_imagined():
    speck = thing("speck", (2.1, 2.07, 0.4), (0.0004, 0.0004, 0.0004))
    solids = [speck, Solid("room|2", "Floor", SolidKind.FLOOR, (Box((2.0, 2.0, -0.05), (2.0, 2.0, 0.05)),))]
    world = PyBulletWorld(solids_of=lambda house: solids)
    world.reset(House("speck", (ROOM,), (), (), ()), 0)
    cells = viewpoints("speck", 1.3, *solids)
    assert cells
    for i, j in cells:
        assert "speck" in seen_in_pictures(world, (i / 4, j / 4), 1.3)
    assert len(cells) < len(viewpoints("cube", 1.3, CUBE)) / 2


def test_what_lies_all_around_a_robot_is_seen_though_part_of_it_is_behind_the_camera():
    rug = thing("rug", (2.0, 2.0, -0.005), (2.0, 2.0, 0.005))
    assert (8, 8) in viewpoints("rug", 0.9, rug)


def test_what_hangs_over_a_robots_head_is_out_of_its_pictures():
    lamp = thing("lamp", (2.0, 2.0, 4.0), (0.05, 0.05, 0.05))
    cells = viewpoints("lamp", 0.9, lamp)
    elevations = [math.degrees(math.atan2(3.1, math.hypot(i / 4 - 2, j / 4 - 2))) for i, j in cells]
    assert cells
    assert max(elevations) < 76
    assert not sight_of(thing("lamp", (2.0, 2.0, 8.0), (0.05, 0.05, 0.05))).is_seen("lamp")


def test_a_moved_thing_is_seen_where_it_is_now():
    screen = thing("screen", (2.5, 2.0, 1.0), (0.01, 1.2, 1.0))
    moved = thing("cube", (3.5, 2.0, 0.5), (0.05, 0.05, 0.05))
    cells = FreeCells([ROOM], [screen, CUBE])
    for place, seen in {(8, 7): (True, False), (12, 8): (False, True)}.items():
        before = Sight([screen, CUBE], only(cells, *place), (1.2,))
        after = before.with_moved(moved)
        assert (before.is_seen("cube"), after.is_seen("cube")) == seen
        assert after.is_seen("screen")
        assert before.with_moved(moved, only(cells, 12, 8)).is_seen("cube")
    with pytest.raises(KeyError):
        before.with_moved(thing("ball", (3.5, 2.0, 0.5), (0.05, 0.05, 0.05)))


@pytest.mark.parametrize("name", sample_names())
def test_the_simulators_camera_agrees_on_sample_houses(name):
    assert_agrees(sample_house(name), every=5)


@pytest.mark.parametrize("name", sample_names())
@pytest.mark.parametrize("height", [0.9, 1.25, 1.6])
def test_everything_in_a_sample_house_is_seen_from_somewhere(name, height):
    house = sample_house(name)
    solids = build_solids(house)
    sight = Sight(solids, FreeCells(house.rooms, solids), (height,))
    assert [thing.id for thing in house.objects if not sight.is_seen(thing.id)] == []


@pytest.mark.real_houses
def test_the_simulators_camera_agrees_on_real_houses():
    assert sum(assert_agrees(house, every=23) for house in real_houses(every=60)) > 700


def assert_agrees(house: House, every: int) -> int:
    """What a robot on every so many cells, of one of three heights, is said to see is in its pictures, and
    nearly all that is in them is said to be seen; returns how many things that are."""
    solids = build_solids(house)
    cells = FreeCells(house.rooms, solids)
    places = np.argwhere(cells.connected)[::every].tolist()
    things = [thing.id for thing in house.objects]
    world = PyBulletWorld()
    world.reset(house, 0)
    said, missed = 0, 0
    for number, (i, j) in enumerate(places):
        height = (0.9, 1.25, 1.6)[number % 3]
        sight = Sight(solids, only(cells, i, j), (height,))
        mine = {name for name in things if sight.is_seen(name)}
        theirs = seen_in_pictures(world, cells.point(i, j), height)
        assert mine <= theirs, f"{house.id}, cell {i}, {j}: {sorted(mine - theirs)}"
        said += len(mine)
        missed += len(theirs.intersection(things) - mine)
    world.close()
    assert missed <= 2
    return said


def seen_in_pictures(world: PyBulletWorld, point: tuple[float, float], height: float) -> set[str]:
    """What the simulator shows within reach to a robot that turns and tilts its camera as it can."""
    live = world._house()
    if "viewer" not in live.robots:
        world.add_agent("viewer", Capability(), Pose(*point))
    robot = live.robot("viewer")
    robot.capability = Capability(camera_height=height)
    seen = set()
    for pose in (Pose(*point, quarter * math.pi / 2, pitch) for quarter in range(4) for pitch in PITCHES):
        live.motion._body.move(live.scene, robot, pose)
        _, nearest = survey(live.look(robot), len(live.scene.labels))
        seen |= {live.scene.labels[instance].id for instance in np.flatnonzero(nearest <= 1.5)}
    return seen
