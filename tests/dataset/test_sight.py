import math

import pytest
from checked_houses import real_houses

from adhoc.core.values import Capability, Pose
from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.dataset.checks.sight import Look, Sight
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


def test_a_cube_in_the_open_is_seen_from_all_around_and_no_further_than_the_reach():
    sight = sight_of(CUBE)
    assert sight.is_seen("cube")
    cells = sight.viewpoints("cube", 0.9)
    distances = [math.hypot(0.25 * i - 2.0, 0.25 * j - 2.0) for i, j in cells]
    assert cells[0] in {(7, 8), (9, 8), (8, 7), (8, 9)}
    assert (8, 8) not in cells
    assert max(distances) < 1.5 + 0.05 * math.sqrt(2)
    every = [(i, j) for i in range(17) for j in range(17) if 0.3 < math.hypot(i - 8, j - 8) * 0.25 < 1.44]
    assert set(every) <= set(cells)


def test_viewpoints_are_given_nearest_first():
    sight = sight_of(thing("bar", (2.0, 2.0, 0.5), (1.0, 0.05, 0.05)))
    gaps = [math.hypot(max(0, abs(i / 4 - 2) - 1), j / 4 - 2) for i, j in sight.viewpoints("bar", 1.2)]
    assert gaps == pytest.approx(sorted(gaps), abs=0.05)


def test_a_screen_hides_what_is_behind_it():
    screen = thing("screen", (2.5, 2.0, 1.0), (0.01, 2.0, 1.0))
    cells = sight_of(CUBE, screen).viewpoints("cube", 1.2)
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
    sight = sight_of(speck)
    solids = [speck, Solid("room|2", "Floor", SolidKind.FLOOR, (Box((2.0, 2.0, -0.05), (2.0, 2.0, 0.05)),))]
    world = PyBulletWorld(solids_of=lambda house: solids)
    world.reset(House("speck", (ROOM,), (), (), ()), 0)
    for cell in sight.viewpoints("speck", 1.3):
        assert_seen(world, "speck", 1.3, sight._cells.point(*cell), sight.look("speck", 1.3, cell))
    assert len(sight.viewpoints("speck", 1.3)) < len(sight_of(CUBE).viewpoints("cube", 1.3)) / 2


def test_what_hangs_over_a_robots_head_is_out_of_its_pictures():
    lamp = thing("lamp", (2.0, 2.0, 4.0), (0.05, 0.05, 0.05))
    cells = sight_of(lamp).viewpoints("lamp", 0.9)
    elevations = [math.degrees(math.atan2(3.1, math.hypot(i / 4 - 2, j / 4 - 2))) for i, j in cells]
    assert cells
    assert max(elevations) < 76
    assert not sight_of(thing("lamp", (2.0, 2.0, 8.0), (0.05, 0.05, 0.05))).is_seen("lamp")


def test_a_look_says_where_to_turn():
    look = sight_of(CUBE).look("cube", 0.55, (4, 8))
    assert look is not None
    assert look.yaw == 0.0
    assert look.azimuth == pytest.approx(0.0, abs=0.06)
    assert look.elevation == pytest.approx(-0.05, abs=0.06)
    assert look.distance == pytest.approx(0.95, abs=0.01)
    assert sight_of(CUBE).aim("cube", 0.55, (4, 8)) == (look.azimuth, look.elevation)
    assert sight_of(CUBE).look("cube", 0.55, (1, 8)) is None


def test_a_moved_thing_is_seen_where_it_is_now():
    screen = thing("screen", (2.5, 2.0, 1.0), (0.01, 1.2, 1.0))
    before = sight_of(CUBE, screen)
    after = before.with_moved(thing("cube", (3.5, 2.0, 0.5), (0.05, 0.05, 0.05)))
    assert (8, 7) in before.viewpoints("cube", 1.2)
    assert (8, 7) not in after.viewpoints("cube", 1.2)
    assert (12, 8) in after.viewpoints("cube", 1.2)
    assert after.viewpoints("screen", 1.2) != []
    with pytest.raises(KeyError):
        before.with_moved(thing("ball", (3.5, 2.0, 0.5), (0.05, 0.05, 0.05)))


@pytest.mark.parametrize("name", sample_names())
def test_the_simulators_camera_agrees_on_sample_houses(name):
    house = sample_house(name)
    assert assert_agrees(house) == len(house.objects) * 3


@pytest.mark.real_houses
def test_the_simulators_camera_agrees_on_real_houses():
    assert sum(assert_agrees(house) for house in real_houses(every=60)) > 700


def assert_agrees(house: House) -> int:
    """At the first viewpoint of every object at three heights, a robot has it in its picture and its reach;
    returns how many viewpoints there are."""
    solids = build_solids(house)
    sight = Sight(solids, FreeCells(house.rooms, solids))
    world = PyBulletWorld()
    world.reset(house, 0)
    asked = 0
    for listed in house.objects:
        for height in (0.9, 1.25, 1.6):
            for cell in sight.viewpoints(listed.id, height)[:1]:
                look = sight.look(listed.id, height, cell)
                assert_seen(world, listed.id, height, sight._cells.point(*cell), look)
                asked += 1
    world.close()
    return asked


def assert_seen(
    world: PyBulletWorld, name: str, height: float, point: tuple[float, float], look: Look | None
) -> None:
    assert look is not None
    pose = Pose(*point, look.yaw, look.pitch)
    live = world._house()
    if "viewer" not in live.robots:
        world.add_agent("viewer", Capability(), pose)
    robot = live.robot("viewer")
    robot.capability = Capability(camera_height=height)
    live.motion._body.move(live.scene, robot, pose)
    observation = world.observe("viewer")
    instance = next((key for key, label in observation.labels.items() if label.id == name), None)
    assert instance is not None, f"{name} is not in the picture"
    _, nearest = survey(live.look(robot), len(live.scene.labels))
    assert nearest[instance] <= min(1.5, look.distance + 1e-3)
