import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tiny_scene import TinyScene, walled_room

from adhoc.core.values import ObjectRecord, Pose
from adhoc.perception.perception import Perception

DOWN = math.radians(30)
TABLE = ("DiningTable", 1.0, -0.5, 0.0, 1.6, 0.5, 0.75)
AHEAD = Pose(0, 0, 0, DOWN)
BACK = Pose(0, 0, math.pi, DOWN)


def apple_at(x: float, y: float, z: float) -> tuple[str, float, float, float, float, float, float]:
    return ("Apple", x - 0.05, y - 0.05, z, x + 0.05, y + 0.05, z + 0.1)


@pytest.fixture
def scene() -> TinyScene:
    scene = walled_room("room|2", -3, -3, 3, 3)
    scene.boxes["Table|1"] = TABLE
    return scene


def seen(scene: TinyScene, pose: Pose = AHEAD) -> Perception:
    perception = Perception()
    perception.observe(scene.look(pose, 0))
    return perception


class TestObjects:
    def test_what_is_seen_becomes_a_record(self, scene):
        scene.boxes["Apple|1"] = apple_at(1.2, 0.0, 0.75)
        perception = Perception()
        sighting = perception.observe(scene.look(AHEAD, 7))
        assert set(sighting.visible) == set(sighting.new) == {"Table|1", "Apple|1"}
        apple = perception.objects["Apple|1"]
        assert apple.position == pytest.approx((1.2, 0.0, 0.8), abs=0.05)
        assert (apple.category, apple.room, apple.last_seen, apple.source) == ("Apple", "room|2", 7, "me")
        assert apple.is_pickupable
        assert apple.misplaced is None
        assert perception.objects["Table|1"].is_receptacle

    def test_the_second_look_is_not_news(self, scene):
        perception = seen(scene)
        sighting = perception.observe(scene.look(AHEAD, 1))
        assert sighting.visible == ("Table|1",)
        assert sighting.new == sighting.moved == sighting.gone == ()
        assert perception.objects["Table|1"].last_seen == 1

    def test_extents_grow_over_frames(self, scene):
        perception = seen(scene, Pose(0, 0, math.radians(65), DOWN))
        before = perception.map.extent_of("Table|1")
        perception.observe(scene.look(AHEAD, 1))
        after = perception.map.extent_of("Table|1")
        assert before[0][1] > -0.4, "the first frame cuts the table"
        assert after[0][1] == pytest.approx(-0.5, abs=0.05)


class TestReceptacles:
    @pytest.mark.parametrize(
        ("x", "z", "receptacle"),
        [(1.2, 0.75, "Table|1"), (0.6, 0.0, "Floor")],
    )
    def test_on_a_table_and_on_the_floor(self, scene, x, z, receptacle):
        scene.boxes["Apple|1"] = apple_at(x, 0.0, z)
        assert seen(scene).objects["Apple|1"].receptacle == receptacle

    def test_categories_come_along(self, scene):
        scene.boxes["Apple|1"] = apple_at(1.2, 0.0, 0.75)
        scene.boxes["Apple|2"] = apple_at(0.6, 0.0, 0.0)
        objects = seen(scene).objects
        assert objects["Apple|1"].receptacle_category == "DiningTable"
        assert objects["Apple|2"].receptacle_category == "Floor"

    def test_in_a_bowl_on_a_table_means_in_the_bowl(self, scene):
        scene.boxes["Bowl|1"] = ("Bowl", 1.1, -0.15, 0.75, 1.4, 0.15, 0.79)
        scene.boxes["Apple|1"] = apple_at(1.25, 0.0, 0.79)
        objects = seen(scene).objects
        assert objects["Apple|1"].receptacle == "Bowl|1"
        assert objects["Bowl|1"].receptacle == "Table|1"

    def test_below_a_table_is_on_the_floor(self, scene):
        scene.boxes["Table|1"] = ("DiningTable", 1.0, -0.5, 0.7, 1.6, 0.5, 0.75)
        scene.boxes["Apple|1"] = apple_at(1.2, 0.0, 0.0)
        perception = Perception()
        perception.observe(scene.look(Pose(-1.2, 0, 0, 0), 0, height=0.9))
        assert perception.objects["Apple|1"].receptacle == "Floor"

    def test_undecided_while_nothing_holds_it(self, scene):
        del scene.boxes["Table|1"]
        scene.boxes["Apple|1"] = apple_at(1.2, 0.0, 0.75)
        assert seen(scene).objects["Apple|1"].receptacle is None

    def test_decided_when_its_receptacle_comes_into_view(self, scene):
        scene.boxes["Apple|1"] = apple_at(1.2, 0.0, 0.75)
        scene.unlabelled.add("Table|1")
        perception = seen(scene)
        assert perception.objects["Apple|1"].receptacle is None
        scene.unlabelled.clear()
        perception.observe(scene.look(Pose(0, -1.3, 0, DOWN), 1))
        assert perception.objects["Apple|1"].receptacle == "Table|1"


def test_an_object_seen_through_a_door_is_in_the_room_behind_it():
    scene = TinyScene({"room|2": (-2, -2, 1, 2), "room|3": (1, -2, 4, 2)})
    scene.boxes["wall-1"] = ("Wall", 0.95, -2, 0, 1.05, -0.5, 2.5)
    scene.boxes["wall-2"] = ("Wall", 0.95, 0.5, 0, 1.05, 2, 2.5)
    scene.boxes["Table|1"] = ("DiningTable", 2.0, -0.3, 0.0, 2.6, 0.3, 0.75)
    scene.boxes["Apple|1"] = apple_at(2.2, 0.0, 0.75)
    perception = seen(scene)
    assert perception.objects["Apple|1"].room == "room|3"
    assert perception.objects["Table|1"].room == "room|3"


class TestHidden:
    """What no pixel shows is nowhere: not in the objects, not in the graph, not in the map."""

    @pytest.mark.parametrize(
        "hide",
        [
            pytest.param({"Apple|1": apple_at(1.3, 0, 0.3)}, id="inside a closed box"),
            pytest.param({"Apple|1": apple_at(3.5, 0, 0.5)}, id="behind a wall"),
            pytest.param({"Apple|1": apple_at(-1.0, 0, 0.5)}, id="outside the frame"),
            pytest.param({"Apple|1": apple_at(1.9, 0, 0.0)}, id="behind furniture"),
        ],
    )
    def test_nothing_is_known_of_it(self, scene, hide):
        scene.boxes.update(hide)
        scene.boxes["Table|1"] = ("Fridge", 1.0, -0.5, 0.0, 1.6, 0.5, 1.8)
        perception = Perception()
        sighting = perception.observe(scene.look(AHEAD, 0))
        assert "Apple|1" not in sighting.visible
        assert "Apple|1" not in perception.objects
        assert "Apple|1" not in perception.graph
        assert "Apple" not in perception.map.top_down().category_names
        assert "Apple" not in perception.graph.as_text()
        assert "Fridge" in perception.map.top_down().category_names, "the test can see what is not hidden"

    def test_beyond_the_camera_range(self):
        scene = TinyScene({"room|2": (-3, -3, 9, 3)}, {"Fridge|1": ("Fridge", 5, -1, 0, 6, 1, 1.8)})
        perception = seen(scene, Pose(0, 0, 0, 0))
        assert "Fridge|1" not in perception.objects
        assert not perception.map.is_known(5.02, 0)


class TestChange:
    def test_an_object_that_moved(self, scene):
        scene.boxes["Apple|1"] = apple_at(1.2, 0.3, 0.75)
        perception = seen(scene)
        scene.boxes["Apple|1"] = apple_at(0.7, -0.3, 0.0)
        sighting = perception.observe(scene.look(AHEAD, 1))
        assert sighting.moved == ("Apple|1",)
        assert sighting.gone == sighting.new == ()
        apple = perception.objects["Apple|1"]
        assert apple.position == pytest.approx((0.7, -0.3, 0.05), abs=0.05)
        assert apple.receptacle == "Floor"
        assert perception.graph.parent("Apple|1") == "room|2"

    def test_an_object_that_is_gone(self, scene):
        scene.boxes["Apple|1"] = apple_at(0.6, 0.0, 0.0)
        perception = seen(scene)
        assert not perception.map.is_traversable(0.6, 0.0)
        del scene.boxes["Apple|1"]
        assert perception.observe(scene.look(AHEAD, 1)).gone == (), "one look may err"
        sighting = perception.observe(scene.look(AHEAD, 2))
        assert sighting.gone == ("Apple|1",)
        assert "Apple|1" not in perception.objects
        assert "Apple|1" not in perception.graph
        assert perception.map.is_traversable(0.6, 0.0), "its cells are free again"

    def test_seen_again_after_being_gone_is_new(self, scene):
        scene.boxes["Apple|1"] = apple_at(0.6, 0.0, 0.0)
        perception = seen(scene)
        apple = scene.boxes.pop("Apple|1")
        perception.observe(scene.look(AHEAD, 1))
        perception.observe(scene.look(AHEAD, 2))
        scene.boxes["Apple|1"] = apple
        assert perception.observe(scene.look(AHEAD, 3)).new == ("Apple|1",)

    @pytest.mark.parametrize(
        "screen",
        [
            pytest.param({"Box|1": ("Fridge", 0.4, -0.5, 0, 0.6, 0.5, 1.5)}, id="occluded"),
            pytest.param({}, id="out of the frame"),
        ],
    )
    def test_what_cannot_be_seen_is_not_gone(self, scene, screen):
        scene.boxes["Apple|1"] = apple_at(0.8, 0.0, 0.0)
        perception = seen(scene)
        del scene.boxes["Apple|1"]
        scene.boxes.update(screen)
        for step in range(1, 5):
            assert perception.observe(scene.look(AHEAD if screen else BACK, step)).gone == ()
        assert "Apple|1" in perception.objects

    def test_an_object_that_stays_is_never_gone_from_any_side(self, scene):
        scene.boxes["Apple|1"] = apple_at(1.3, 0.0, 0.75)
        scene.boxes["Bowl|1"] = ("Bowl", 1.1, 0.2, 0.75, 1.3, 0.4, 0.79)
        perception = Perception()
        step = 0
        for x, y, quarter in ((0, 0, 0), (1.2, -1.2, 1), (2.5, 0, 2), (1.3, 1.3, 3), (0.2, 0.3, 0)):
            for pitch in (0, 30, 60):
                pose = Pose(x, y, quarter * math.pi / 2, math.radians(pitch))
                sighting = perception.observe(scene.look(pose, step))
                assert sighting.gone == sighting.moved == ()
                step += 1

    def test_what_the_robot_holds_is_nowhere_else(self, scene):
        scene.boxes["Apple|1"] = apple_at(1.2, 0.0, 0.75)
        perception = seen(scene)
        sighting = perception.observe(scene.look(AHEAD, 1, held="Apple|1"))
        assert sighting.gone == ()
        assert "Apple|1" not in perception.objects

    def test_a_robot_is_transient(self, scene):
        scene.boxes["robot-b"] = ("Robot", 0.9, 0.9, 0.0, 1.2, 1.2, 1.7)
        perception = Perception()
        sighting = perception.observe(scene.look(AHEAD, 0))
        assert sighting.robots["robot-b"] == pytest.approx((1.05, 1.05), abs=0.15)
        assert perception.map.robots == sighting.robots
        assert "robot-b" not in sighting.visible
        assert "robot-b" not in perception.objects
        assert perception.map.is_traversable(1.05, 1.05)
        assert perception.observe(scene.look(BACK, 1)).robots == {}


class TestTold:
    RECORD = ObjectRecord(
        "Mug|9", "Mug", (5.0, 5.0, 0.8), "room|7", "Table|8", "DiningTable", True, 0.3, False, True, 4, "bob"
    )

    def test_a_teammates_word_is_believed(self):
        perception = Perception()
        perception.tell_object(self.RECORD)
        assert perception.objects["Mug|9"] == self.RECORD
        assert "Mug|9" in perception.graph

    def test_own_newer_knowledge_wins(self, scene):
        scene.boxes["Mug|9"] = ("Mug", 1.2, 0, 0.75, 1.3, 0.1, 0.85)
        perception = Perception()
        perception.observe(scene.look(AHEAD, 5))
        perception.tell_object(self.RECORD)
        assert perception.objects["Mug|9"].source == "me"
        perception.tell_object(replace(self.RECORD, last_seen=6))
        assert perception.objects["Mug|9"].position == (5.0, 5.0, 0.8)
        assert perception.observe(scene.look(AHEAD, 7)).new == ("Mug|9",)
        assert perception.objects["Mug|9"].source == "me"

    def test_forgetting(self, scene):
        perception = Perception()
        perception.tell_object(self.RECORD)
        perception.forget("Mug|9")
        perception.forget("never heard of")
        assert dict(perception.objects) == {}

    def test_a_room_explored_by_a_teammate(self, scene):
        perception = seen(scene)
        perception.tell_explored("room|2", "bob")
        room = perception.rooms["room|2"]
        assert (room.explored, room.explored_by) == (True, "bob")

    def test_a_room_known_by_name_only_has_no_place(self):
        perception = Perception()
        perception.tell_explored("room|7", "bob")
        assert "room|7" not in perception.rooms
        perception.tell_object(self.RECORD)
        perception.tell_explored("room|7", "bob")
        assert perception.rooms["room|7"].position == pytest.approx((5.0, 5.0))


class TestRooms:
    def test_type_is_inferred_from_furniture(self, scene):
        scene.boxes["Fridge|1"] = ("Fridge", 1.5, -2.0, 0, 2.2, -1.4, 1.8)
        perception = seen(scene)
        probabilities = perception.room_probabilities("room|2")
        assert sum(probabilities.values()) == pytest.approx(1.0)
        assert max(probabilities, key=probabilities.get) == "Kitchen"
        assert perception.rooms["room|2"].room_type == "Kitchen"

    def test_nothing_known_is_uniform_and_undecided(self):
        perception = seen(walled_room("room|2", -3, -3, 3, 3))
        assert set(perception.room_probabilities("room|2").values()) == {0.25}
        assert set(perception.room_probabilities("room|99").values()) == {0.25}
        assert perception.rooms["room|2"].room_type is None

    def test_explored_when_seen_completely(self):
        scene = walled_room("room|2", -2, -2, 2, 2)
        perception = Perception()
        step = 0
        perception.observe(scene.look(AHEAD, step))
        assert not perception.rooms["room|2"].explored
        for x, y in ((0, 0), (1.2, 1.2), (1.2, -1.2), (-1.2, -1.2), (-1.2, 1.2)):
            for quarter in range(4):
                step += 1
                perception.observe(scene.look(Pose(x, y, quarter * math.pi / 2, DOWN), step))
        room = perception.rooms["room|2"]
        assert (room.explored, room.explored_by) == (True, "me")
        assert room.position == pytest.approx((0, 0), abs=0.1)


@settings(max_examples=20, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    yaw=st.floats(-4, 4),
    pitch=st.floats(-1.5, 1.5),
    bad=st.sampled_from([np.nan, np.inf, -1.0, 0.0, 1e9]),
)
def test_noisy_pictures_never_raise(seed, yaw, pitch, bad):
    rng = np.random.default_rng(seed)
    scene = walled_room("room|2", -3, -3, 3, 3)
    scene.boxes["Apple|1"] = apple_at(1.0, 0.0, 0.0)
    frame = scene.look(Pose(0, 0, yaw, pitch), 0)
    depth = np.where(rng.random(frame.depth.shape) < 0.1, bad, frame.depth).astype(np.float32)
    instances = np.where(rng.random(depth.shape) < 0.1, rng.integers(-5, 9999), frame.instances).astype(
        np.int32
    )
    perception = Perception()
    for step in range(3):
        perception.observe(replace(frame, depth=depth, instances=instances, step=step))
    assert all(np.isfinite(record.position).all() for record in perception.objects.values())
