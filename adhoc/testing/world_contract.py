"""The contract of `adhoc.worlds.world.World` as tests that any adapter can inherit.

To hold your own simulator to it, write a test class of your own::

    from adhoc.testing.world_contract import WorldContract

    class TestMyWorld(WorldContract):
        @pytest.fixture
        def make_world(self):
            return MyWorld

`make_world` returns something that builds an empty world when called without arguments; every world is
closed after its test. The house of the contract is one room of 4 x 4 m with a table, two objects on the
table, and a ball on the floor. The tests suppose moves of 0.25 m, turns of 90 degrees, tilts of 30 degrees
between 30 up and 60 down, a reach of 1.5 m, and robots of 0.2 m radius.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from adhoc.core.errors import WorldError
from adhoc.core.values import Action, ActionName, Capability, Failure, Observation, Point, Pose
from adhoc.houses.house import FLOOR, House, HouseObject, Room, Wall
from adhoc.worlds.world import World

QUARTER = math.pi / 2
DOWN = math.pi / 6
CORNERS = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0))


def contract_house() -> House:
    """One kitchen; the table covers x in [2.5, 3.5], y in [1.5, 2.5] and is 0.7 m high."""
    walls = tuple(
        Wall(f"wall {index}", CORNERS[index], CORNERS[(index + 1) % 4], 2.5, ("room",)) for index in range(4)
    )
    objects = (
        _object("table", "DiningTable", (3.0, 2.0, 0.35), (1.0, 1.0, 0.7), None, 20.0, is_receptacle=True),
        _object("apple", "Apple", (2.7, 2.0, 0.751), (0.1, 0.1, 0.1), "table", 0.2),
        _object("pot", "Pot", (2.7, 2.3, 0.781), (0.16, 0.16, 0.16), "table", 5.0),
        _object("ball", "BasketBall", (1.0, 3.0, 0.121), (0.24, 0.24, 0.24), FLOOR, 0.6),
    )
    return House("contract", (Room("room", "Kitchen", CORNERS),), walls, (), objects)


def _object(
    name: str,
    category: str,
    position: Point,
    size: Point,
    parent: str | None,
    mass: float,
    is_receptacle: bool = False,
) -> HouseObject:
    return HouseObject(
        name,
        f"{category}_1",
        category,
        position,
        0.0,
        size,
        "room",
        parent,
        parent is not None,
        mass,
        is_receptacle,
    )


def act(world: World, name: ActionName, target: str | None = None, robot: str = "robot") -> Observation:
    """One step in which one robot acts."""
    return world.step({robot: Action(name, target)})[robot]


def instance_of(observation: Observation, wanted: str) -> int:
    """The instance number of an id that is in the frame."""
    return next(number for number, label in observation.labels.items() if label.id == wanted)


class WorldContract:
    """Inherit, and provide the fixture `make_world`."""

    @pytest.fixture
    def make_world(self) -> Callable[[], World]:
        raise NotImplementedError("a contract test class must provide the fixture make_world")

    @pytest.fixture
    def empty(self, make_world: Callable[[], World]) -> Iterator[World]:
        """The house of the contract, without robots."""
        world = make_world()
        world.reset(contract_house(), 0)
        yield world
        world.close()

    @pytest.fixture
    def world(self, empty: World) -> World:
        """With `robot` half a metre before the table, looking down at it."""
        empty.add_agent("robot", Capability(), Pose(2.0, 2.0, 0.0, DOWN))
        return empty

    # --- seeing -----------------------------------------------------------------------------------

    def test_the_first_observation_is_complete(self, empty: World) -> None:
        pose = Pose(2.0, 2.0, 0.0, DOWN)
        seen = empty.add_agent("robot", Capability(camera_height=1.4, max_steps=9), pose)
        assert (seen.step, seen.pose, seen.held, seen.steps_left, seen.last_result) == (
            0,
            pose,
            None,
            9,
            None,
        )
        assert seen.depth.dtype == np.float32
        assert seen.instances.dtype == np.int32
        assert seen.depth.shape == seen.instances.shape
        assert seen.rgb is None
        assert seen.camera.intrinsics.shape == (3, 3)
        assert seen.camera.world_from_camera[:3, 3].tolist() == [2.0, 2.0, 1.4]

    def test_labels_are_exactly_the_instances_in_the_frame(self, world: World) -> None:
        seen = world.observe("robot")
        assert set(seen.labels) == set(np.unique(seen.instances).tolist()) - {-1}
        categories = {label.id: label.category for label in seen.labels.values()}
        assert categories["table"] == "DiningTable"
        assert categories["apple"] == "Apple"
        assert "ball" not in categories

    def test_depth_is_infinite_exactly_where_nothing_is_hit(self, world: World) -> None:
        seen = world.observe("robot")
        assert np.array_equal(np.isinf(seen.depth), seen.instances == -1)

    def test_depth_is_measured_along_the_optical_axis(self, empty: World) -> None:
        seen = empty.add_agent("robot", Capability(), Pose(2.0, 2.0, QUARTER))
        wall = instance_of(seen, "wall 2")
        assert seen.depth[seen.instances == wall] == pytest.approx(2.0, abs=0.06)

    def test_points_of_an_object_lie_on_it(self, world: World) -> None:
        seen = world.observe("robot")
        rows, columns = np.nonzero(seen.instances == instance_of(seen, "apple"))
        depth = seen.depth[rows, columns]
        rays = np.linalg.inv(seen.camera.intrinsics) @ np.stack([columns, rows, np.ones_like(rows)])
        points = seen.camera.world_from_camera[:3, :3] @ (rays * depth)
        points += seen.camera.world_from_camera[:3, 3:]
        assert np.abs(points - np.array([[2.7], [2.0], [0.751]])).max() <= 0.052

    def test_a_robot_sees_others_but_not_itself(self, world: World) -> None:
        assert "Robot" not in {label.category for label in world.observe("robot").labels.values()}
        other = world.add_agent("other", Capability(), Pose(1.0, 2.0))
        assert [label.id for label in other.labels.values() if label.category == "Robot"] == ["robot"]
        body = other.instances == instance_of(other, "robot")
        assert other.depth[body].min() == pytest.approx(0.85, abs=0.1)

    def test_colour_comes_only_when_asked_for(self, world: World) -> None:
        seen = world.observe("robot", rgb=True)
        assert seen.rgb is not None
        assert seen.rgb.shape == (*seen.depth.shape, 3)
        assert seen.rgb.dtype == np.uint8
        apple, table = (
            seen.rgb[seen.instances == instance_of(seen, name)].mean(axis=0) for name in ("apple", "table")
        )
        assert np.abs(apple - table).max() > 5

    def test_observing_changes_nothing(self, world: World) -> None:
        before = world.fingerprint()
        first, second = world.observe("robot"), world.observe("robot", rgb=True)
        assert np.array_equal(first.depth, second.depth)
        assert np.array_equal(first.instances, second.instances)
        assert world.fingerprint() == before

    # --- moving -----------------------------------------------------------------------------------

    @pytest.mark.parametrize("quarter", [0, 1, 2, -1])
    @pytest.mark.parametrize(
        ("name", "direction"),
        [
            (ActionName.MOVE_AHEAD, 0),
            (ActionName.MOVE_LEFT, 1),
            (ActionName.MOVE_BACK, 2),
            (ActionName.MOVE_RIGHT, 3),
        ],
    )
    def test_moves_are_relative_to_the_heading(
        self, empty: World, quarter: int, name: ActionName, direction: int
    ) -> None:
        empty.add_agent("robot", Capability(), Pose(1.5, 1.5, quarter * QUARTER))
        seen = act(empty, name)
        angle = (quarter + direction) * QUARTER
        assert seen.last_result is not None
        assert seen.last_result.ok
        assert seen.pose.x == pytest.approx(1.5 + 0.25 * math.cos(angle), abs=1e-6)
        assert seen.pose.y == pytest.approx(1.5 + 0.25 * math.sin(angle), abs=1e-6)
        assert seen.pose.yaw == pytest.approx(quarter * QUARTER)

    def test_furniture_blocks_at_the_exact_cell(self, world: World) -> None:
        assert act(world, ActionName.MOVE_AHEAD).pose.x == 2.25
        blocked = act(world, ActionName.MOVE_AHEAD)
        assert blocked.last_result is not None
        assert blocked.last_result.failure is Failure.BLOCKED
        assert "table" in blocked.last_result.detail
        assert blocked.pose.x == 2.25

    def test_an_object_on_the_floor_blocks(self, empty: World) -> None:
        empty.add_agent("robot", Capability(), Pose(1.0, 2.5, QUARTER))
        blocked = act(empty, ActionName.MOVE_AHEAD)
        assert blocked.last_result is not None
        assert blocked.last_result.failure is Failure.BLOCKED

    def test_walls_keep_a_robot_inside(self, empty: World) -> None:
        empty.add_agent("robot", Capability(), Pose(1.0, 1.0, math.pi))
        xs = [act(empty, ActionName.MOVE_AHEAD).pose.x for _ in range(5)]
        assert xs == [0.75, 0.5, 0.25, 0.25, 0.25]

    def test_robots_block_each_other(self, empty: World) -> None:
        empty.add_agent("a", Capability(), Pose(0.5, 1.0, 0.0))
        empty.add_agent("b", Capability(), Pose(1.25, 1.0, math.pi))
        seen = empty.step({"a": Action(ActionName.MOVE_AHEAD), "b": Action(ActionName.MOVE_AHEAD)})
        assert seen["a"].pose.x == 0.75
        assert seen["b"].last_result is not None
        assert seen["b"].last_result.failure is Failure.BLOCKED
        assert seen["b"].pose.x == 1.25

    def test_four_turns_are_none(self, world: World) -> None:
        start = world.observe("robot").pose
        for name in (ActionName.ROTATE_LEFT, ActionName.ROTATE_RIGHT):
            yaws = [act(world, name).pose.yaw for _ in range(4)]
            sign = 1 if name is ActionName.ROTATE_LEFT else -1
            assert yaws[0] == pytest.approx(sign * QUARTER)
            assert world.observe("robot").pose == start

    def test_the_camera_tilts_within_its_limits(self, empty: World) -> None:
        empty.add_agent("robot", Capability(), Pose(2.0, 2.0))
        up = [act(empty, ActionName.LOOK_UP) for _ in range(2)]
        assert [round(math.degrees(seen.pose.pitch)) for seen in up] == [-30, -30]
        assert up[1].last_result is not None
        assert up[1].last_result.failure is Failure.LOOK_LIMIT
        down = [act(empty, ActionName.LOOK_DOWN) for _ in range(4)]
        assert [round(math.degrees(seen.pose.pitch)) for seen in down] == [0, 30, 60, 60]
        assert down[3].last_result is not None
        assert down[3].last_result.failure is Failure.LOOK_LIMIT

    # --- manipulating -----------------------------------------------------------------------------

    def test_a_picked_up_object_leaves_the_scene(self, world: World) -> None:
        seen = act(world, ActionName.PICK_UP, "apple")
        assert seen.last_result is not None
        assert seen.last_result.ok
        assert seen.held == "apple"
        assert "apple" not in {label.id for label in seen.labels.values()}
        truth = world.truth()["apple"]
        assert (truth.holder, truth.receptacle, truth.room) == ("robot", None, None)
        assert world.agents()["robot"].held == "apple"

    def test_a_held_object_is_carried_along(self, world: World) -> None:
        act(world, ActionName.PICK_UP, "apple")
        seen = act(world, ActionName.MOVE_BACK)
        assert seen.held == "apple"
        assert world.truth()["apple"].position[:2] == (1.75, 2.0)

    @pytest.mark.parametrize(
        ("capability", "pose", "name", "target", "failure"),
        [
            (Capability(can_manipulate=False), None, "PickUp", "apple", Failure.NO_MANIPULATION),
            (Capability(can_manipulate=False), None, "Drop", None, Failure.NO_MANIPULATION),
            (Capability(can_navigate=False), None, "MoveBack", None, Failure.NO_NAVIGATION),
            (Capability(can_navigate=False), None, "LookUp", None, Failure.NO_NAVIGATION),
            (Capability(payload=4.9), None, "PickUp", "pot", Failure.TOO_HEAVY),
            (Capability(), Pose(0.5, 2.0, 0.0, DOWN), "PickUp", "apple", Failure.TOO_FAR),
            (Capability(), Pose(2.0, 2.0, math.pi, DOWN), "PickUp", "apple", Failure.NOT_VISIBLE),
            (Capability(), None, "PickUp", "no such thing", Failure.NOT_VISIBLE),
            (Capability(), None, "PickUp", "table", Failure.NOT_PICKUPABLE),
            (Capability(), None, "PickUp", None, Failure.NO_TARGET),
            (Capability(), None, "PutDown", "table", Failure.HAND_EMPTY),
            (Capability(), None, "PutDown", None, Failure.NO_TARGET),
            (Capability(), None, "Drop", None, Failure.HAND_EMPTY),
        ],
    )
    def test_each_failure_has_its_reason(
        self,
        empty: World,
        capability: Capability,
        pose: Pose | None,
        name: str,
        target: str | None,
        failure: Failure,
    ) -> None:
        empty.add_agent("robot", capability, pose or Pose(2.0, 2.0, 0.0, DOWN))
        truth = empty.truth()
        seen = act(empty, ActionName(name), target)
        assert seen.last_result is not None
        assert seen.last_result.failure is failure
        assert seen.last_result.action == Action(ActionName(name), target)
        assert seen.steps_left == 499
        assert empty.truth() == truth

    def test_a_full_hand_picks_up_nothing(self, world: World) -> None:
        act(world, ActionName.PICK_UP, "apple")
        seen = act(world, ActionName.PICK_UP, "pot")
        assert seen.last_result is not None
        assert seen.last_result.failure is Failure.HAND_FULL
        assert seen.held == "apple"

    def test_putting_down_where_it_was_taken(self, world: World) -> None:
        act(world, ActionName.PICK_UP, "apple")
        seen = act(world, ActionName.PUT_DOWN, "table")
        assert seen.last_result is not None
        assert seen.last_result.ok
        assert seen.held is None
        assert "apple" in {label.id for label in seen.labels.values()}
        truth = world.truth()["apple"]
        assert (truth.receptacle, truth.receptacle_category, truth.room) == ("table", "DiningTable", "room")
        x, y, z = truth.position
        assert 2.55 <= x <= 3.45
        assert 1.55 <= y <= 2.45
        assert z == pytest.approx(0.75, abs=0.02)

    def test_only_a_receptacle_is_put_down_onto(self, world: World) -> None:
        act(world, ActionName.PICK_UP, "apple")
        result = act(world, ActionName.PUT_DOWN, "pot").last_result
        assert result is not None
        assert result.failure is Failure.NOT_A_RECEPTACLE

    def test_a_far_receptacle_is_not_put_down_onto(self, world: World) -> None:
        act(world, ActionName.PICK_UP, "apple")
        seen = [act(world, ActionName.MOVE_BACK) for _ in range(5)][-1]
        assert seen.pose.x == 0.75
        result = act(world, ActionName.PUT_DOWN, "table").last_result
        assert result is not None
        assert result.failure is Failure.TOO_FAR
        assert world.observe("robot").held == "apple"

    def test_an_unseen_receptacle_is_not_put_down_onto(self, world: World) -> None:
        act(world, ActionName.PICK_UP, "apple")
        for _ in range(2):
            act(world, ActionName.ROTATE_LEFT)
        result = act(world, ActionName.PUT_DOWN, "table").last_result
        assert result is not None
        assert result.failure is Failure.NOT_VISIBLE

    def test_a_dropped_object_lies_on_the_floor_in_front(self, world: World) -> None:
        act(world, ActionName.PICK_UP, "apple")
        act(world, ActionName.ROTATE_LEFT)
        seen = act(world, ActionName.DROP)
        assert seen.last_result is not None
        assert seen.last_result.ok
        assert seen.held is None
        truth = world.truth()["apple"]
        assert (truth.receptacle, truth.receptacle_category, truth.room) == (FLOOR, FLOOR, "room")
        assert truth.position[2] == pytest.approx(0.05, abs=0.02)
        assert truth.position[0] == pytest.approx(2.0, abs=0.1)
        assert 2.2 < truth.position[1] < 2.5

    def test_of_two_robots_the_first_in_order_gets_the_object(self, world: World) -> None:
        world.add_agent("other", Capability(), Pose(2.0, 2.5, 0.0, DOWN))
        take = Action(ActionName.PICK_UP, "apple")
        seen = world.step({"other": take, "robot": take})
        assert seen["other"].held == "apple"
        assert seen["robot"].held is None
        assert seen["robot"].last_result is not None
        assert seen["robot"].last_result.failure is Failure.NOT_VISIBLE

    # --- time, battery, joining -------------------------------------------------------------------

    def test_every_action_costs_a_step_until_the_battery_is_empty(self, empty: World) -> None:
        empty.add_agent("robot", Capability(max_steps=2), Pose(1.0, 1.0))
        left = [act(empty, name).steps_left for name in (ActionName.ROTATE_LEFT, ActionName.DROP)]
        assert left == [1, 0]
        seen = act(empty, ActionName.ROTATE_LEFT)
        assert seen.last_result is not None
        assert seen.last_result.failure is Failure.OUT_OF_BATTERY
        assert seen.pose.yaw == pytest.approx(QUARTER)
        assert empty.agents()["robot"].steps_used == 2

    def test_resting_is_free(self, world: World) -> None:
        seen = world.step({})
        assert (seen["robot"].step, seen["robot"].steps_left) == (1, 500)

    def test_stop_is_free_and_final(self, world: World) -> None:
        seen = act(world, ActionName.STOP)
        assert seen.last_result is not None
        assert seen.last_result.ok
        assert seen.steps_left == 500
        assert world.agents()["robot"].stopped
        after = act(world, ActionName.ROTATE_LEFT)
        assert after.last_result is not None
        assert after.last_result.failure is Failure.STOPPED
        assert after.pose == seen.pose
        assert not world.is_free(Pose(2.0, 2.0))

    def test_a_robot_can_join_at_step_seven(self, world: World) -> None:
        for _ in range(7):
            act(world, ActionName.ROTATE_LEFT)
        before = world.observe("robot")
        joined = world.add_agent("late", Capability(), Pose(0.5, 0.5))
        assert (joined.step, joined.steps_left) == (7, 500)
        after = world.observe("robot")
        assert (after.pose, after.steps_left, after.step) == (before.pose, before.steps_left, 7)
        assert set(world.step({})) == {"robot", "late"}

    # --- leaving ----------------------------------------------------------------------------------

    def test_a_robot_that_left_is_neither_seen_nor_in_the_way(self, world: World) -> None:
        watcher = Pose(2.0, 1.0, QUARTER)
        seen = world.add_agent("other", Capability(), watcher)
        assert "robot" in {label.id for label in seen.labels.values()}
        world.remove_agent("robot")
        assert set(world.agents()) == {"other"}
        assert "robot" not in {label.id for label in world.observe("other").labels.values()}
        assert world.is_free(Pose(2.0, 2.0))
        for _ in range(4):
            after = world.step({"other": Action(ActionName.MOVE_AHEAD)})
        assert set(after) == {"other"}
        assert (after["other"].pose.x, after["other"].pose.y) == pytest.approx((2.0, 2.0))

    def test_a_robot_that_left_can_do_nothing_and_its_id_is_free(self, world: World) -> None:
        act(world, ActionName.ROTATE_LEFT)
        world.remove_agent("robot")
        for call in (
            lambda: world.observe("robot"),
            lambda: world.step({"robot": Action(ActionName.STOP)}),
            lambda: world.remove_agent("robot"),
        ):
            with pytest.raises(WorldError, match="robot"):
                call()
        again = world.add_agent("robot", Capability(max_steps=9), Pose(0.5, 0.5))
        assert (again.steps_left, again.held, again.last_result) == (9, None, None)

    def test_what_a_robot_held_that_left_lies_where_it_stood(self, world: World) -> None:
        act(world, ActionName.PICK_UP, "apple")
        before = world.fingerprint()
        world.remove_agent("robot")
        assert world.fingerprint() != before
        truth = world.truth()["apple"]
        assert (truth.holder, truth.receptacle, truth.receptacle_category) == (None, FLOOR, FLOOR)
        assert truth.room == "room"
        assert truth.position == pytest.approx((2.0, 2.0, 0.05), abs=0.06)
        taken = world.add_agent("other", Capability(), Pose(1.25, 2.0, 0.0, 2 * DOWN))
        assert "apple" in {label.id for label in taken.labels.values()}
        assert act(world, ActionName.PICK_UP, "apple", "other").held == "apple"

    # --- entering ---------------------------------------------------------------------------------

    @pytest.mark.parametrize(
        "pose", [Pose(3.0, 2.0), Pose(9.0, 9.0), Pose(-0.5, 2.0), Pose(0.1, 2.0), Pose(1.0, 3.0)]
    )
    def test_a_robot_does_not_fit_into_things_or_outside(self, empty: World, pose: Pose) -> None:
        assert not empty.is_free(pose)
        with pytest.raises(WorldError):
            empty.add_agent("robot", Capability(), pose)
        assert not empty.agents()

    def test_an_id_can_be_taken_once(self, world: World) -> None:
        with pytest.raises(WorldError, match="robot"):
            world.add_agent("robot", Capability(), Pose(0.5, 0.5))

    def test_two_robots_do_not_fit_at_one_place(self, world: World) -> None:
        with pytest.raises(WorldError):
            world.add_agent("other", Capability(), Pose(2.0, 2.25))

    def test_an_unknown_robot_raises_and_nobody_acts(self, world: World) -> None:
        before = world.fingerprint()
        with pytest.raises(WorldError, match="nobody"):
            world.step({"robot": Action(ActionName.MOVE_BACK), "nobody": Action(ActionName.STOP)})
        with pytest.raises(WorldError, match="nobody"):
            world.observe("nobody")
        assert world.fingerprint() == before

    def test_free_poses_are_free_and_apart_and_follow_the_seed(self, empty: World) -> None:
        poses = empty.free_poses(4, seed=3)
        assert len(poses) == 4
        assert poses == empty.free_poses(4, seed=3)
        assert poses != empty.free_poses(4, seed=4)
        assert all(empty.is_free(pose) for pose in poses)
        for index, pose in enumerate(poses):
            empty.add_agent(f"robot {index}", Capability(), pose)

    # --- scenarios --------------------------------------------------------------------------------

    @pytest.mark.parametrize(("receptacle", "category"), [("table", "DiningTable"), (FLOOR, FLOOR)])
    def test_displacing_moves_an_object_to_a_place_of_the_seed(
        self, make_world: Callable[[], World], receptacle: str, category: str
    ) -> None:
        positions = []
        for seed in (1, 1, 2):
            world = make_world()
            world.reset(contract_house(), 0)
            assert world.displace("apple", receptacle, seed)
            truth = world.truth()["apple"]
            assert (truth.receptacle, truth.receptacle_category) == (receptacle, category)
            positions.append(truth.position)
            world.close()
        assert positions[0] == positions[1] != positions[2]

    def test_the_truth_at_the_beginning_is_the_house(self, empty: World) -> None:
        truth = empty.truth()
        assert set(truth) == {"apple", "pot", "ball"}
        assert truth["apple"].receptacle == "table"
        assert (truth["ball"].receptacle, truth["ball"].receptacle_category) == (FLOOR, FLOOR)
        assert {item.room for item in truth.values()} == {"room"}

    # --- histories --------------------------------------------------------------------------------

    def test_equal_histories_have_equal_fingerprints(self, make_world: Callable[[], World]) -> None:
        traces = [_trace(make_world()) for _ in range(2)]
        assert traces[0] == traces[1]
        assert len(set(traces[0])) == len(traces[0])

    def test_a_reset_forgets_everything(self, make_world: Callable[[], World]) -> None:
        world = make_world()
        first = _trace(world, close=False)
        assert _trace(world) == first

    def test_two_worlds_are_independent(self, make_world: Callable[[], World], world: World) -> None:
        before = world.fingerprint()
        _trace(make_world())
        assert world.fingerprint() == before

    def test_a_world_without_a_house_says_so(self, make_world: Callable[[], World]) -> None:
        world = make_world()
        with pytest.raises(WorldError):
            world.truth()
        world.close()

    def test_closing_twice_is_harmless(self, make_world: Callable[[], World]) -> None:
        world = make_world()
        world.reset(contract_house(), 0)
        world.close()
        world.close()


def _trace(world: World, close: bool = True) -> list[str]:
    """Fingerprints of a history in which everything happens once."""
    world.reset(contract_house(), 0)
    world.displace("pot", FLOOR, 5)
    world.add_agent("robot", Capability(), Pose(2.0, 2.0, 0.0, DOWN))
    prints = [world.fingerprint()]
    for name, target in (
        (ActionName.PICK_UP, "apple"),
        (ActionName.MOVE_BACK, None),
        (ActionName.DROP, None),
        (ActionName.ROTATE_LEFT, None),
    ):
        act(world, name, target)
        prints.append(world.fingerprint())
    world.add_agent("late", Capability(), Pose(0.5, 0.5))
    prints.append(world.fingerprint())
    if close:
        world.close()
    return prints
