import math
from dataclasses import replace

import pytest
from tiny_scene import walled_room
from tiny_world import TinyWorld, Walker

from adhoc.core.values import Action, ActionName, ActionResult, Failure, Pose
from adhoc.skills.navigator import Navigator, Travel


def walker(pose: Pose = Pose(0, 0)) -> Walker:  # noqa: B008
    walker = Walker(TinyWorld(walled_room("room|2", -2.5, -2.5, 2.5, 2.5), pose))
    walker.spin()
    walker.navigator.update(walker.observation)
    return walker


def travel(walker: Walker, turn_for: int | None = 0, most: int = 60) -> Travel:
    for _ in range(most):
        walker.navigator.update(walker.observation)
        step = walker.navigator.travel(walker.observation, turn_for)
        if isinstance(step, Travel):
            return step
        walker.do(step)
    raise AssertionError("the way did not end")


def test_the_shortest_way_is_found_without_turning():
    it = walker()
    assert it.navigator.aim_at_point(1.0, -1.5, 0.1)
    assert travel(it) is Travel.ARRIVED
    assert (it.world.pose.x, it.world.pose.y) == pytest.approx((1.0, -1.5), abs=1e-6)
    assert len(it.moves) == 4 + 6, "4 steps along x, 6 along y"
    assert it.moves.count("MoveAhead") == 4
    assert it.moves.count("MoveRight") == 6


def test_long_runs_are_faced():
    it = walker()
    it.navigator.aim_at_point(0.0, -1.5, 0.1)
    assert travel(it, turn_for=3) is Travel.ARRIVED
    assert it.moves == ["MoveAhead"] * 6
    assert math.cos(it.world.pose.yaw + math.pi / 2) == pytest.approx(1.0)


def test_the_lattice_follows_the_first_pose():
    it = walker(Pose(0.1, 0.2, math.radians(30)))
    it.navigator.aim_at_point(0.1 + math.cos(math.radians(30)), 0.2 + math.sin(math.radians(30)), 0.05)
    assert travel(it) is Travel.ARRIVED
    assert it.moves == ["MoveAhead"] * 4


def test_a_bump_leads_to_a_detour():
    it = walker()
    it.world.walls.append((0.6, -0.3, 0.7, 0.3))
    it.navigator.aim_at_point(1.5, 0.0, 0.1)
    assert travel(it) is Travel.ARRIVED
    assert it.world.pose.x == pytest.approx(1.5)
    assert 8 < len(it.moves) <= 20


def test_a_bump_is_forgotten_after_a_while():
    it = walker()
    it.world.walls.append((0.6, -3, 0.7, 3))
    it.navigator.aim_at_point(1.5, 0.0, 0.1)
    assert travel(it, most=200) is Travel.UNREACHABLE
    it.world.walls.clear()
    for _ in range(it.navigator.settings.bump_memory):
        it.do(Action(ActionName.ROTATE_LEFT))
    it.navigator.update(it.observation)
    it.navigator.aim_at_point(1.5, 0.0, 0.1)
    assert travel(it) is Travel.ARRIVED


@pytest.mark.parametrize("courtesy", [1, 3])
def test_a_robot_that_meets_another_steps_back_by_its_own_number_of_moves(courtesy):
    it = walker()
    navigator = Navigator(it.navigator.map, courtesy=courtesy)
    navigator.update(it.observation)
    navigator.aim_at_point(1.5, 0.0, 0.1)
    navigator.map.robots = {"other": (0.3, 0.0)}
    bump = ActionResult(Action(ActionName.MOVE_AHEAD), Failure.BLOCKED, "other is in the way")
    met = replace(it.observation, step=it.observation.step + 1, pose=Pose(0.0, 0.0), last_result=bump)
    navigator.update(met)
    navigator.map.robots = {}
    moves = [navigator.travel(met, 0) for _ in range(courtesy + 1)]
    assert moves == [Action(ActionName.MOVE_BACK)] * courtesy + [Action(ActionName.MOVE_AHEAD)]


def test_furniture_is_driven_around():
    scene = walled_room("room|2", -2.5, -2.5, 2.5, 2.5)
    scene.boxes["Table|1"] = ("DiningTable", 0.6, -0.6, 0, 1.0, 0.6, 0.8)
    it = Walker(TinyWorld(scene, Pose(0, 0)))
    it.spin()
    it.navigator.update(it.observation)
    it.navigator.aim_at_point(1.5, 0.0, 0.1)
    assert travel(it) is Travel.ARRIVED
    assert it.world.bumps == 0
    assert 6 + 2 * 4 <= len(it.moves) <= 6 + 2 * 6, "the table forces four steps to the side and back"


def test_a_robot_in_view_is_driven_around():
    it = walker()
    it.navigator.aim_at_point(1.5, 0.0, 0.1)
    it.world.scene.boxes["robot-b"] = ("Robot", 0.6, -0.15, 0, 0.9, 0.15, 1.7)
    it.do(Action(ActionName.LOOK_UP))
    assert travel(it) is Travel.ARRIVED
    assert len(it.moves) > 6


def test_points_in_walls_and_beyond_the_known_are_no_goal():
    it = walker()
    assert not it.navigator.aim_at_point(2.5, 0.0, 0.1)
    assert not it.navigator.aim_at_point(100.0, 0.0, 0.5)
    assert not it.navigator.aim_at_room("room|77")


def test_travel_costs_count_moves():
    it = walker()
    near, far, nowhere = it.navigator.travel_costs(it.observation, [(0.5, 0), (1.0, 1.0), (50.0, 0)])
    assert (near, far, nowhere) == (2.0, 8.0, math.inf)
