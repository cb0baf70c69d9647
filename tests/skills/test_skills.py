import math

import pytest
from tiny_scene import TinyScene, walled_room
from tiny_world import TinyWorld, Walker

from adhoc.core.calls import Call
from adhoc.core.values import Action, ActionName, Capability, Failure, ObjectRecord, Pose
from adhoc.skills.approach import visible_distance
from adhoc.skills.explore import NOTHING_LEFT, Explore
from adhoc.skills.go_to import GoToPoint
from adhoc.skills.library import standard_skills


@pytest.fixture
def scene() -> TinyScene:
    scene = walled_room("room|2", -2.5, -2.5, 3.5, 2.5)
    scene.boxes["Table|1"] = ("DiningTable", 2.2, -0.6, 0, 3.0, 0.6, 0.75)
    scene.boxes["Apple|1"] = ("Apple", 2.4, 0.1, 0.75, 2.5, 0.2, 0.85)
    return scene


@pytest.fixture
def walker(scene: TinyScene) -> Walker:
    walker = Walker(TinyWorld(scene, Pose(0, 0)))
    walker.spin()
    return walker


def two_rooms() -> TinyScene:
    """room|2 west of a wall with a door at y in (-0.5, 0.5), room|3 east of it."""
    scene = TinyScene({"room|2": (-2, -2, 2, 2), "room|3": (2, -2, 5, 2)})
    scene.boxes = {
        "wall-s": ("Wall", -2, -2.1, 0, 5, -2, 2.5),
        "wall-n": ("Wall", -2, 2, 0, 5, 2.1, 2.5),
        "wall-w": ("Wall", -2.1, -2, 0, -2, 2, 2.5),
        "wall-e": ("Wall", 5, -2, 0, 5.1, 2, 2.5),
        "wall-1": ("Wall", 1.95, -2, 0, 2.05, -0.5, 2.5),
        "wall-2": ("Wall", 1.95, 0.5, 0, 2.05, 2, 2.5),
    }
    return scene


def test_the_library_has_the_seven_sub_skills():
    assert list(standard_skills()) == [
        "GoToObject",
        "GoToPoint",
        "GoToRoom",
        "PickupObject",
        "PutObject",
        "Explore",
        "Stop",
    ]


class TestGoToObject:
    def test_ends_within_reach_and_in_view(self, walker):
        assert walker.run("GoToObject", "Apple|1") is None
        assert visible_distance(walker.observation, "Apple|1") <= 1.45

    def test_low_things_are_looked_down_at(self, scene):
        scene.boxes["Mug|1"] = ("Mug", 1.2, -1.6, 0.0, 1.28, -1.52, 0.1)
        walker = Walker(TinyWorld(scene, Pose(0, 0)))
        walker.spin()
        assert walker.run("GoToObject", "Mug|1") is None
        assert visible_distance(walker.observation, "Mug|1") <= 1.45

    def test_fails_for_what_is_not_known(self, walker):
        assert walker.run("GoToObject", "Apple|7") == "Apple|7 is not known"

    def test_fails_when_it_is_not_there(self, walker):
        del walker.world.scene.boxes["Apple|1"]
        assert walker.run("GoToObject", "Apple|1") == "the object Apple|1 is not there"

    def test_fails_when_a_teammate_was_wrong(self, walker):
        record = ObjectRecord("Mug|1", "Mug", (-1.5, 1.5, 0.05), "room|2", is_pickupable=True, last_seen=15)
        walker.perception.tell_object(record)
        assert walker.run("GoToObject", "Mug|1") == "the object Mug|1 is not there"
        assert len(walker.world.taken) < 60

    def test_fails_where_no_way_leads(self, walker):
        record = ObjectRecord("Mug|1", "Mug", (40.0, 40.0, 0.05), None, last_seen=99)
        walker.perception.tell_object(record)
        assert walker.run("GoToObject", "Mug|1") == "there is no way to Mug|1"


class TestGoToPoint:
    def test_ends_near_the_point(self, walker):
        walker.do(Action(ActionName.MOVE_BACK))
        assert walker.run("GoToPoint", -1.0, 1.25) is None
        pose = walker.world.pose
        assert math.dist((pose.x, pose.y), (-1.25, 1.25)) <= 0.5

    def test_the_robot_frame_turns_with_the_robot(self, walker):
        walker.skills["GoToPoint"] = GoToPoint(robot_frame=True, tolerance=0.2)
        walker.do(Action(ActionName.ROTATE_LEFT))
        assert walker.run("GoToPoint", 1.0, 0.0) is None
        assert (walker.world.pose.x, walker.world.pose.y) == pytest.approx((0.0, 1.0), abs=0.2)

    @pytest.mark.parametrize("dx", [50.0, math.nan, math.inf])
    def test_fails_beyond_the_distance_constraint(self, walker, dx):
        assert "more than 6 m" in walker.run("GoToPoint", dx, 0.0)
        assert len(walker.world.taken) == 15, "nothing was done after looking around"

    def test_fails_inside_furniture(self, walker):
        walker.skills["GoToPoint"] = GoToPoint(tolerance=0.2)
        assert "no robot can stand" in walker.run("GoToPoint", 2.6, 0.0)


class TestGoToRoom:
    def test_ends_inside(self):
        walker = Walker(TinyWorld(two_rooms(), Pose(0, 0)))
        walker.spin()
        assert walker.run("GoToRoom", "room|3") is None
        assert walker.world.pose.x > 2.0
        assert walker.perception.map.room_at(walker.world.pose.x, walker.world.pose.y) == "room|3"

    def test_nothing_to_do_when_already_there(self, walker):
        before = len(walker.world.taken)
        assert walker.run("GoToRoom", "room|2") is None
        assert len(walker.world.taken) == before

    def test_fails_for_an_unknown_room(self, walker):
        assert walker.run("GoToRoom", "room|9") == "room|9 is not known"


class TestPickupObject:
    def test_takes_what_is_near(self, walker):
        walker.run("GoToObject", "Apple|1")
        assert walker.run("PickupObject", "Apple|1") is None
        assert walker.world.held == "Apple|1"

    def test_comes_nearer_by_itself(self, walker):
        assert walker.run("PickupObject", "Apple|1") is None
        assert walker.world.held == "Apple|1"

    def test_reports_the_worlds_refusal(self, scene):
        walker = Walker(TinyWorld(scene, Pose(0, 0), Capability(payload=0.01)))
        walker.spin()
        assert walker.run("PickupObject", "Apple|1") == f"{Failure.TOO_HEAVY.value} (so it is)"

    def test_fails_without_a_hand_and_with_a_full_one(self, scene, walker):
        armless = Walker(TinyWorld(scene, Pose(0, 0), Capability(can_manipulate=False)))
        assert armless.run("PickupObject", "Apple|1") == Failure.NO_MANIPULATION.value
        assert walker.run("PickupObject", "Apple|1") is None
        assert Failure.HAND_FULL.value in walker.run("PickupObject", "Table|1")

    def test_fails_when_it_is_not_there(self, walker):
        del walker.world.scene.boxes["Apple|1"]
        assert walker.run("PickupObject", "Apple|1") == "the object Apple|1 is not there"


class TestPutObject:
    def holding(self, scene: TinyScene) -> Walker:
        scene.boxes["Mug|1"] = ("Mug", -1.4, 1.0, 0, -1.3, 1.1, 0.1)
        walker = Walker(TinyWorld(scene, Pose(0, 0)))
        walker.spin()
        assert walker.run("PickupObject", "Mug|1") is None
        return walker

    def test_puts_it_onto_the_receptacle(self, scene):
        walker = self.holding(scene)
        assert walker.run("PutObject", "Mug|1", "Table|1", "room|2") is None
        assert walker.world.held is None
        assert walker.perception.objects["Mug|1"].receptacle == "Table|1"

    def test_floor_means_dropping_it(self, scene):
        walker = self.holding(scene)
        assert walker.run("PutObject", "Mug|1", "Floor", "room|2") is None
        assert walker.world.taken[-1].name is ActionName.DROP

    def test_tries_another_place_before_giving_up(self, scene):
        walker = self.holding(scene)
        walker.world.refusals = [Failure.NO_FREE_PLACE]
        assert walker.run("PutObject", "Mug|1", "Table|1", "room|2") is None
        walker = self.holding(scene)
        walker.world.refusals = [Failure.NO_FREE_PLACE] * 9
        assert (
            walker.run("PutObject", "Mug|1", "Table|1", "room|2")
            == "there is no free place for the object (so it is)"
        )
        assert len(walker.world.put_from) == len(set(walker.world.put_from)) == 2

    def test_fails_at_once_for_a_reason_that_stays(self, scene):
        walker = self.holding(scene)
        walker.world.refusals = [Failure.NOT_A_RECEPTACLE] * 9
        assert "not a receptacle" in walker.run("PutObject", "Mug|1", "Table|1", "room|2")
        assert sum(action.name is ActionName.PUT_DOWN for action in walker.world.taken) == 1

    def test_fails_with_empty_hands_and_unknown_receptacles(self, scene, walker):
        assert walker.run("PutObject", "Apple|1", "Table|1", "room|2") == "the robot does not hold Apple|1"
        assert "not known" in self.holding(scene).run("PutObject", "Mug|1", "Shelf|1", "room|2")


class TestExplore:
    def test_explores_two_rooms_completely_and_then_fails(self):
        walker = Walker(TinyWorld(two_rooms(), Pose(0, 0)))
        for _ in range(30):
            failure = walker.run("Explore")
            if failure is not None:
                break
        assert failure == NOTHING_LEFT
        for _ in range(5):
            walker.do(Action(ActionName.ROTATE_LEFT))
        assert {name: room.explored for name, room in walker.perception.rooms.items()} == {
            "room|2": True,
            "room|3": True,
        }
        assert len(walker.world.taken) < 70

    def test_stays_in_the_focus_room(self):
        walker = Walker(TinyWorld(two_rooms(), Pose(0, 0)))
        for _ in range(30):
            failure = walker.run("Explore", focus_room="room|2")
            if failure is not None:
                break
        assert failure == f"{NOTHING_LEFT} in room|2"
        assert walker.world.pose.x < 2.3
        assert walker.perception.map.frontiers("room|3"), "room|3 was left alone"

    def test_keeps_away_from_teammates(self):
        scene = TinyScene({"room|2": (-8, -1, 8, 1)})
        scene.boxes["wall-s"] = ("Wall", -8, -1.1, 0, 8, -1, 2.5)
        scene.boxes["wall-n"] = ("Wall", -8, 1, 0, 8, 1.1, 2.5)
        for other, side in (((2.5, 0.0), -1), ((-2.5, 0.0), 1)):
            walker = Walker(TinyWorld(scene, Pose(0, 0)))
            walker.spin()
            skill = Explore()
            skill.start(Call("Explore"), walker.view(others=(other,)))
            for _ in range(80):
                action = skill.step(walker.view(others=(other,)))
                if action is None:
                    break
                walker.do(action)
            assert walker.world.pose.x * side > 0

    def test_what_teammates_inspected_comes_last(self):
        scene = walled_room("room|2", -2.5, -2.5, 3.5, 2.5)
        walker = Walker(TinyWorld(scene, Pose(0, 0)))
        walker.perception.tell_covered([(x, y) for x in range(-4, 5) for y in range(-4, 5)])
        walker.skills["Explore"] = Explore(revisit=False)
        assert walker.run("Explore") == NOTHING_LEFT
        walker.skills["Explore"] = Explore()
        assert walker.run("Explore") is None


class TestBounds:
    def test_every_skill_gives_up(self, walker):
        skill = Explore(most_actions=3)
        skill.start(Call("Explore"), walker.view())
        actions = [skill.step(walker.view()) for _ in range(5)]
        assert actions[3:] == [None, None] or skill.failure is None
        assert sum(action is not None for action in actions) <= 3

    def test_hopeless_refusals_end_a_skill(self, walker):
        skill = walker.skills["GoToObject"]
        skill.start(Call("GoToObject", ("Apple|1",)), walker.view())
        assert skill.step(walker.view()) is not None
        walker.world._perform = lambda action: Failure.OUT_OF_BATTERY
        walker.do(Action(ActionName.MOVE_AHEAD))
        assert skill.step(walker.view()) is None
        assert skill.failure == "the battery is empty (so it is)"

    def test_stop_is_one_action(self, walker):
        assert walker.run("Stop") is None
        assert walker.world.taken[-1] == Action(ActionName.STOP)
