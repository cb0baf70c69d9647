from __future__ import annotations

import numpy as np
import pytest
from grid_world import GridWorld, Script, scenario
from watched_grid import key_of, record_of, watched

from adhoc import HeuristicPolicy, PyBulletWorld, TidyingUp, run_episode, sample_house, sample_scenario
from adhoc.core.errors import EpisodeError
from adhoc.core.geometry import camera_at, intrinsics
from adhoc.core.values import Label, Observation, Pose
from adhoc.evaluation.imperfections import Imperfections
from adhoc.evaluation.keyed_episode import run_keyed
from adhoc.inspecting.field_of_view import RAYS, unit_of, view_outline
from adhoc.inspecting.known_floor import FloorGrid, runs_of
from adhoc.inspecting.recorder import Recorder
from adhoc.inspecting.snapshots import NOTHING, labels_picture, within
from adhoc.inspecting.watching import watch_again


class TestRecorder:
    def test_looking_on_changes_nothing(self):
        key = key_of()
        seen = run_keyed(GridWorld(), key, None, Recorder(key.scenario.house))
        assert seen.history == run_keyed(GridWorld(), key).history

    def test_every_robot_has_a_pose_at_every_step_from_its_first(self):
        one = watched(join_step=3)
        tracks, steps = one.recording.tracks, one.result.steps
        assert list(tracks) == ["teammate_1", "teammate_2", "newcomer"]
        assert {name: track.first for name, track in tracks.items()} == {
            "teammate_1": 0,
            "teammate_2": 0,
            "newcomer": 3,
        }
        for name, track in tracks.items():
            assert len(track.poses) == len(track.views) == len(track.actions) == steps + 1 - track.first
            for step in one.result.trace.steps[track.first + 1 :]:
                assert track.poses[step.step - track.first] == step.poses[name]
                assert track.actions[step.step - 1 - track.first] == step.actions[name]

    def test_objects_are_followed_into_the_hand_and_out_of_it(self):
        one = watched(join_step=3)
        moves = [(move.step, move.object.id, move.object.holder) for move in one.recording.moves]
        assert moves == [(4, "apple", "newcomer"), (5, "apple", None)]
        assert one.recording.tracks["newcomer"].held[:3] == [None, "apple", None]
        assert one.recording.moves[-1].object.receptacle == "counter"

    def test_doings_are_kept_when_they_change_and_decisions_with_pictures(self):
        one = watched(join_step=3)
        assert one.recording.doings["teammate_1"] == [(0, "at 0", None), (4, "at 1", None), (8, "at 2", None)]
        assert [(it.step, it.robot, it.is_sub_task) for it in one.recording.decisions] == [
            (3, "newcomer", True),
            (5, "newcomer", False),
            (6, "newcomer", True),
        ]
        assert all("doing" not in it.trace for it in one.recording.decisions)
        assert [one.recording.pictures[it.picture][:2] for it in one.recording.decisions] == [b"\xff\xd8"] * 3
        assert watched(pictures=False).recording.pictures == {}

    def test_a_robot_that_left_has_no_pose_any_more(self):
        where = scenario()
        recorder = Recorder(where.house)
        imperfections = Imperfections(leaves={0: 4})
        run_episode(
            GridWorld(), where, key_of().kind.conditions.task, [Script(), Script()], max_steps=8,
            imperfections=imperfections, observer=recorder,
        )  # fmt: skip
        tracks = recorder.recording.tracks
        assert (len(tracks["teammate_1"].poses), len(tracks["teammate_2"].poses)) == (4, 9)

    def test_the_floor_that_maps_know_grows_and_never_shrinks(self):
        world = PyBulletWorld(image_size=64)
        where = sample_scenario(world, sample_house("one_room"), seed=1, misplaced=1, teammates=1)
        recorder = Recorder(where.house)
        policy = HeuristicPolicy()
        run_episode(world, where, TidyingUp(), [policy], max_steps=12, observer=recorder)
        world.close()
        grid = recorder.recording.grid
        known = np.zeros(grid.columns * grid.rows, bool)
        log = recorder.recording.floors["teammate_1"]
        assert log.entries[0][0] == 0
        for _, runs in log.entries:
            new = np.zeros_like(known)
            at = 0
            for turn, length in enumerate(runs):
                new[at : at + length] = turn % 2 == 1
                at += length
            assert new.any()
            assert not (new & known).any()
            known |= new
        assert policy.map is not None
        assert (known == grid.known(policy.map)).all()
        assert 0.2 < known.mean() < 1.0


class TestWatchingAgain:
    def test_an_episode_that_is_the_recorded_one_is_shown(self):
        alone = record_of(key_of(None))
        assert watch_again(GridWorld(), key_of(None), alone).result.steps == alone["steps"]
        record = record_of(key_of(3), alone)
        assert watch_again(GridWorld(), key_of(3), record, alone).record is record

    def test_another_episode_is_refused_with_what_differs(self):
        record = record_of(key_of(None))
        world = GridWorld(disturb_step=4)
        world.resets = 1
        with pytest.raises(EpisodeError, match=r"history_hash was .*; the histories part before step 4"):
            watch_again(world, key_of(None), record)

    @pytest.mark.parametrize(
        ("change", "told"),
        [
            ({"scenario_hash": "0"}, "scenario_hash was 0 when it was recorded.*robots of its scenario"),
            ({"config_hash": "0"}, "config_hash was 0 .*settings of team"),
            ({"episode_id": "other"}, "makes episode 'two_rooms-s0--walkers--alone'"),
            ({"steps": 99}, "steps was 99, is 12"),
        ],
    )
    def test_records_of_something_else_are_refused(self, change, told):
        with pytest.raises(EpisodeError, match=told):
            watch_again(GridWorld(), key_of(None), {**record_of(key_of(None)), **change})


def observation(pose: Pose, depth: np.ndarray) -> Observation:
    matrix = intrinsics(depth.shape[1], depth.shape[0], np.pi / 2)
    instances = np.full(depth.shape, -1, np.int32)
    return Observation(0, depth, instances, {}, camera_at(pose, 1.0, matrix), pose, None, 9, None)


class TestFieldOfView:
    def test_it_ends_at_a_wall_and_at_the_reach(self):
        depth = np.full((64, 64), 2.0, np.float32)
        depth[:, 32:] = np.inf
        points = view_outline(observation(Pose(0.0, 0.0, 0.0), depth), 4.0) * unit_of(4.0)
        assert points.shape == (RAYS, 2)
        assert points[0] == pytest.approx((2.0, 2.0), abs=0.04)
        assert points[-1] == pytest.approx((4.0, -4.0), abs=0.15)

    def test_what_is_seen_above_a_wall_does_not_count(self):
        depth = np.full((64, 64), 2.0, np.float32)
        depth[:20] = np.inf
        points = view_outline(observation(Pose(0.0, 0.0), depth), 4.0) * unit_of(4.0)
        assert points[:, 0] == pytest.approx(np.full(RAYS, 2.0), abs=0.04)

    def test_it_turns_with_the_robot(self):
        depth = np.full((64, 64), 2.0, np.float32)
        ahead, left = (view_outline(observation(Pose(0.0, 0.0, yaw), depth), 4.0) for yaw in (0.0, np.pi / 2))
        assert (left[:, 0] == -ahead[:, 1]).all()
        assert (left[:, 1] == ahead[:, 0]).all()

    def test_it_goes_behind_low_things(self):
        depth = np.full((64, 64), 3.0, np.float32)
        depth[40:] = 1.0
        points = view_outline(observation(Pose(0.0, 0.0), depth), 4.0) * unit_of(4.0)
        assert points[:, 0] == pytest.approx(np.full(RAYS, 3.0), abs=0.04)


class TestFloorAndPictures:
    @pytest.mark.parametrize(
        ("cells", "runs"), [("0110", [1, 2]), ("1011", [0, 1, 1, 2]), ("000", []), ("1", [0, 1])]
    )
    def test_runs(self, cells, runs):
        assert runs_of(np.array([it == "1" for it in cells])) == runs

    def test_the_grid_covers_the_house(self):
        grid = FloorGrid.of(scenario().house)
        assert (grid.x, grid.y, grid.columns, grid.rows) == (0, 0, 80, 40)

    def test_labels_are_drawn_where_there_is_no_colour(self):
        one = observation(Pose(0, 0), np.ones((2, 2), np.float32))
        one.instances[0, 0] = 7
        one.labels[7] = Label("mug", "Mug")
        picture = labels_picture(one)
        assert tuple(picture[1, 1]) == NOTHING
        assert tuple(picture[0, 0]) != NOTHING

    def test_pictures_are_thinned_to_what_fits_the_wanted_first(self):
        pictures = {number: bytes(100) for number in range(10)}
        assert list(within(pictures, [2, 5], 5000)) == list(range(10))
        few = within(pictures, [2, 5], 600)
        assert {2, 5} <= set(few)
        assert len(few) == 6
        assert max(few) > 6, "spread over the episode"
        assert list(within(pictures, [2, 5], 100)) in ([2], [5])
