import math

import numpy as np
import pytest
from tiny_scene import TinyScene, walled_room

from adhoc.core.errors import ConfigurationError
from adhoc.core.values import Pose
from adhoc.perception.perception import Perception, PerceptionSettings
from adhoc.perception.semantic_map import SemanticMap
from adhoc.perception.top_down import FREE, OCCUPIED, UNKNOWN

DOWN = math.radians(30)


def spin(perception: Perception, scene: TinyScene, x: float, y: float, step: int = 0) -> int:
    for quarter in range(4):
        perception.observe(scene.look(Pose(x, y, quarter * math.pi / 2, DOWN), step))
        step += 1
    return step


def state_at(grid: SemanticMap, x: float, y: float) -> int:
    picture = grid.top_down()
    ix = int((x - picture.origin[0]) / picture.cell)
    iy = int((y - picture.origin[1]) / picture.cell)
    inside = 0 <= ix < picture.state.shape[0] and 0 <= iy < picture.state.shape[1]
    return int(picture.state[ix, iy]) if inside else UNKNOWN


@pytest.fixture
def scene() -> TinyScene:
    scene = walled_room("room|2", -2, -2, 3, 2)
    scene.boxes["Table|1"] = ("DiningTable", 1.0, -0.5, 0.0, 1.6, 0.5, 1.0)
    return scene


def test_floor_is_free_furniture_occupied_and_what_it_hides_unknown(scene):
    perception = Perception()
    perception.observe(scene.look(Pose(0, 0, 0, DOWN), 0, height=0.9))
    assert state_at(perception.map, 0.8, 0.1) == FREE
    assert state_at(perception.map, 1.02, 0.1) == OCCUPIED
    assert state_at(perception.map, 2.5, 0.0) == UNKNOWN, "the table hides the floor behind it"
    assert state_at(perception.map, -1.0, 0.0) == UNKNOWN, "behind the robot's back"
    assert perception.map.is_known(0.8, 0.1)
    assert not perception.map.is_known(2.5, 0.0)


def test_a_robot_fits_where_its_disc_touches_nothing(scene):
    perception = Perception()
    spin(perception, scene, 0, 0)
    assert perception.map.is_traversable(0.7, 0.0)
    assert not perception.map.is_traversable(0.88, 0.0), "0.12 m from the table's edge"
    assert not perception.map.is_traversable(-1.9, 0.0), "0.1 m from the wall"
    assert not perception.map.is_traversable(1000.0, 0.0), "off the map"


def test_floor_is_not_guessed_behind_an_edge():
    for edge in np.arange(1.6, 2.3, 0.1):
        scene = walled_room("room|2", -2, -2, 4, 2)
        scene.boxes["Table|1"] = ("DiningTable", edge, -1.5, 0.0, edge + 1, 1.5, 1.0)
        perception = Perception()
        perception.observe(scene.look(Pose(0, 0, 0, math.radians(10)), 0, height=0.9, size=32))
        seen = [x for x in np.arange(1.2, edge + 1, 0.05) if perception.map.room_at(x, 0.0) == "room|2"]
        assert edge - 0.4 < max(seen) < edge + 0.06


def test_what_hangs_above_robots_is_no_obstacle():
    scene = walled_room("room|2", -2, -2, 3, 2)
    scene.boxes["lamp"] = ("Painting", 1.0, -0.3, 1.8, 1.6, 0.3, 2.0)
    perception = Perception()
    spin(perception, scene, -1, 0)
    assert "lamp" in perception.objects
    assert perception.map.is_traversable(1.2, 0.0)


def test_room_of_a_point_comes_from_floor_labels():
    scene = TinyScene({"room|2": (-2, -2, 1, 2), "room|3": (1, -2, 3, 2)})
    perception = Perception()
    perception.observe(scene.look(Pose(0, 0, 0, DOWN), 0))
    assert perception.map.room_at(0.8, 0.0) == "room|2"
    assert perception.map.room_at(1.2, 0.0) == "room|3"
    assert perception.map.room_at(0.0, 0.0) == "room|2", "under the robot: the nearest floor seen"
    assert perception.map.room_at(-1.5, 0.0) is None


def test_frontiers_shrink_to_none_in_a_room_seen_completely(scene):
    perception = Perception()
    perception.observe(scene.look(Pose(0, 0, 0, DOWN), 0))
    before = perception.map.frontiers()
    assert before
    assert all(perception.map.is_traversable(*frontier.point) for frontier in before)
    step = 1
    for x, y in ((0, 0), (2.3, 0), (2.3, 1.4), (2.3, -1.4), (-1.5, 0)):
        step = spin(perception, scene, x, y, step)
    assert perception.map.frontiers() == ()
    assert perception.map.frontiers("room|2") == ()


def test_a_doorway_stays_a_frontier():
    scene = walled_room("room|2", -2, -2, 2, 2)
    del scene.boxes["wall-e"]
    scene.boxes["wall-e1"] = ("Wall", 2, -2, 0, 2.1, -0.5, 2.5)
    scene.boxes["wall-e2"] = ("Wall", 2, 0.5, 0, 2.1, 2, 2.5)
    perception = Perception()
    step = 0
    for x, y in ((0, 0), (1.0, 1.2), (1.0, -1.2), (-1.0, 1.2), (-1.0, -1.2)):
        step = spin(perception, scene, x, y, step)
    (frontier,) = perception.map.frontiers()
    assert frontier.room == "room|2"
    assert frontier.point[0] == pytest.approx(2.0, abs=0.15)
    assert frontier.point[1] == pytest.approx(0.0, abs=0.15)
    perception.map.dismiss(*frontier.point)
    assert perception.map.frontiers() == ()


def test_covered_square_metres_are_shared():
    scene = TinyScene({"room|2": (-6, -6, 6, 6)})
    perception, other = Perception(), Perception()
    spin(perception, scene, 0.1, 0.1)
    covered = perception.take_covered()
    assert (0, 0) in covered
    assert (-5, -5) not in covered
    assert perception.take_covered() == (), "each is given once"
    other.tell_covered(covered)
    other.observe(scene.look(Pose(0.1, 0.1, 0, DOWN), 0))
    behind = [it for it in other.map.frontiers() if math.hypot(*it.point) < 0.6]
    assert behind == [], "what lies behind the robot was inspected by a teammate"
    assert [it for it in other.map.frontiers(told=True) if it.told]


def test_the_map_has_no_preferred_origin(scene):
    moved = TinyScene(
        {name: (a - 40, b + 70, c - 40, d + 70) for name, (a, b, c, d) in scene.floors.items()},
        {
            name: (kind, a - 40, b + 70, c, d - 40, e + 70, f)
            for name, (kind, a, b, c, d, e, f) in scene.boxes.items()
        },
    )
    here, there = Perception(), Perception()
    spin(here, scene, 0, 0)
    spin(there, moved, -40, 70)
    assert np.mean(here.map.top_down().state != there.map.top_down().state) < 0.01


def test_line_of_sight_is_blocked_by_furniture(scene):
    perception = Perception()
    spin(perception, scene, 0, 0)
    assert perception.map.line_of_sight((0, 0, 1.6), (0.8, 0.8, 0.1))
    assert not perception.map.line_of_sight((0, 0, 0.5), (2.5, 0.0, 0.5))
    assert perception.map.line_of_sight((0, 0, 0.5), (1.1, 0.0, 0.5), "Table|1"), "nothing hides the table"


@pytest.mark.parametrize("cell", [0.0, -0.05, 0.03])
def test_cells_must_divide_a_metre(cell):
    with pytest.raises(ConfigurationError, match="cell"):
        PerceptionSettings(cell=cell)


def test_an_extent_too_small_for_the_camera_is_refused():
    with pytest.raises(ConfigurationError, match="extent"):
        PerceptionSettings(extent=10.0)
