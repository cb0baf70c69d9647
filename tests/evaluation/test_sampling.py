from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from grid_world import GridWorld, scenario, two_rooms
from hypothesis import given, settings
from hypothesis import strategies as st

from adhoc.core.errors import ConfigurationError, HouseError, WorldError
from adhoc.core.geometry import planar_distance
from adhoc.core.streams import stream
from adhoc.core.values import Pose
from adhoc.evaluation.benchmark import Draw, HouseBenchmark, SampleBenchmark
from adhoc.evaluation.misplacing import misplace
from adhoc.evaluation.ranges import Ranges
from adhoc.evaluation.referee import PlacementReferee
from adhoc.evaluation.sampling import add_robots, sample_scenario
from adhoc.evaluation.scenario import Difficulty, Displacement, difficulty_of, prepare
from adhoc.evaluation.team_drawing import draw_capability, draw_team
from adhoc.houses import samples
from adhoc.houses.house import FLOOR

SAMPLES = Path(samples.__file__).parent / "samples"


def draw(seed=0, **options):
    return sample_scenario(GridWorld(), two_rooms(), seed, **options)


class TestDraw:
    @settings(max_examples=40, deadline=None)
    @given(seed=st.integers(0, 10_000), misplaced=st.integers(1, 2), teammates=st.integers(3, 5))
    def test_what_is_drawn_can_be_set_up_and_is_misplaced(self, seed, misplaced, teammates):
        drawn = draw(seed, misplaced=misplaced, teammates=teammates)
        world = GridWorld()
        prepare(world, drawn)
        assert PlacementReferee(world, drawn).replaced() == ()
        assert len(drawn.misplaced) == misplaced
        assert list(world.agents()) == [f"teammate_{number + 1}" for number in range(teammates)]
        assert any(member.capability.can_manipulate for member in drawn.team)
        poses = [member.pose for member in (*drawn.team, drawn.newcomer)]
        gaps = [planar_distance(a, b) for i, a in enumerate(poses) for b in poses[:i]]
        assert min(gaps) >= 0.75

    def test_equal_seeds_give_equal_scenarios(self):
        assert draw(3, misplaced=2) == draw(3, misplaced=2)
        assert draw(3, misplaced=2) != draw(4, misplaced=2)

    def test_a_larger_team_leaves_the_objects_as_they_are(self):
        assert draw(3, misplaced=2, teammates=3).misplaced == draw(3, misplaced=2, teammates=5).misplaced

    def test_team_sizes_and_numbers_of_objects_are_the_papers(self):
        drawn = [draw(seed, ranges=Ranges(misplaced=(1, 2))) for seed in range(40)]
        assert {len(it.team) for it in drawn} == {3, 4, 5}
        assert {len(it.misplaced) for it in drawn} == {1, 2}

    def test_only_objects_with_a_right_place_are_misplaced(self):
        """The pillow belongs on the bed, the apple and the knife on the counter; nothing else is there."""
        displaced = {it for seed in range(60) for it in draw(seed, misplaced=1, teammates=3).misplaced}
        assert Displacement("Apple_0", "CounterTop_0") not in displaced
        assert Displacement("Pillow_0", "Bed_0") not in displaced
        assert {it.object_id for it in displaced} == {"Apple_0", "Knife_0", "Pillow_0"}
        assert {it.receptacle_id for it in displaced} == {"Bed_0", "CounterTop_0", FLOOR}

    def test_what_cannot_be_put_right_in_the_house_is_left_alone(self):
        house = two_rooms()
        objects = [replace(it, parent=FLOOR) if it.parent == "counter" else it for it in house.objects]
        without_counter = replace(house, objects=tuple(it for it in objects if it.id != "counter"))
        for seed in range(20):
            drawn = sample_scenario(GridWorld(), without_counter, seed, misplaced=1, teammates=3)
            assert [it.object_id for it in drawn.misplaced] == ["Pillow_0"]

    def test_what_no_right_place_has_room_for_is_left_alone(self):
        class FullCounter(GridWorld):
            def displace(self, object_id, receptacle_id, seed):
                return receptacle_id != "CounterTop_0" and super().displace(object_id, receptacle_id, seed)

        world = FullCounter()
        for seed in range(20):
            drawn = sample_scenario(world, two_rooms(), seed, misplaced=1, teammates=3)
            assert [it.object_id for it in drawn.misplaced] == ["Pillow_0"]
            assert world.truth()["Apple_0"].receptacle == "CounterTop_0"
        with pytest.raises(ConfigurationError, match="only 1 objects can be misplaced and put right again"):
            sample_scenario(world, two_rooms(), 0, misplaced=2, teammates=3)

    def test_objects_may_be_refused_where_they_lie(self):
        asked = []

        def nowhere_but_on_floors(truth):
            asked.append(truth.receptacle)
            return truth.receptacle == FLOOR

        drawn = sample_scenario(
            GridWorld(), two_rooms(), 3, misplaced=3, teammates=3, accepting=lambda _: nowhere_but_on_floors
        )
        assert {it.receptacle_id for it in drawn.misplaced} == {FLOOR}
        assert set(asked) > {FLOOR}

    def test_robots_are_added_to_one_disorder_again_and_again(self):
        world = GridWorld()
        disorder = misplace(world, two_rooms(), 3, 2)
        before = world.truth()
        drawn = [add_robots(world, disorder, seed, 3, Ranges(), "it") for seed in (3, 4)]
        assert world.truth() == before
        assert drawn[0] == replace(draw(3, misplaced=2, teammates=3), id="it")
        assert drawn[0].misplaced == drawn[1].misplaced
        assert drawn[0].team != drawn[1].team
        assert drawn[0].newcomer != drawn[1].newcomer

    def test_an_object_that_takes_the_last_room_of_another_is_misplaced_elsewhere(self):
        """The bed has room for one thing; whatever lies on it keeps a misplaced pillow away."""

        class SmallBed(GridWorld):
            def displace(self, object_id, receptacle_id, seed):
                others = [it for name, it in self.truth().items() if name != object_id]
                if receptacle_id == "Bed_0" and any(it.receptacle == "Bed_0" for it in others):
                    return False
                return super().displace(object_id, receptacle_id, seed)

        for seed in range(40):
            drawn = sample_scenario(SmallBed(), two_rooms(), seed, misplaced=3, teammates=3)
            assert len(drawn.misplaced) == 3
            assert "Bed_0" not in {it.receptacle_id for it in drawn.misplaced if it.object_id != "Pillow_0"}

    def test_too_many_objects_are_refused(self):
        with pytest.raises(ConfigurationError, match="only 3 objects can be misplaced"):
            draw(misplaced=4)

    @pytest.mark.parametrize("options", [{"misplaced": 0}, {"teammates": 0}])
    def test_empty_scenarios_are_refused(self, options):
        with pytest.raises(ConfigurationError, match="at least 1"):
            draw(**{"misplaced": 1, **options})

    def test_robots_that_do_not_fit_are_refused(self):
        with pytest.raises(WorldError, match="no room for 4 robots 9 m apart"):
            draw(misplaced=1, teammates=3, ranges=Ranges(apart=9.0, crowded=9.0))


class TestCapability:
    def test_ranges_are_the_papers(self):
        drawn = [draw_capability(stream(seed, "c")) for seed in range(400)]
        assert all(it.can_navigate for it in drawn)
        assert {it.camera_height for it in drawn} == {0.9, 1.6}
        assert all(0.1 <= it.payload <= 20 for it in drawn)
        assert min(it.max_steps for it in drawn) < 60
        assert max(it.max_steps for it in drawn) > 490
        assert all(50 <= it.max_steps <= 500 for it in drawn)
        able = Counter(it.can_manipulate for it in drawn)
        assert 150 < able[True] < 250

    def test_one_teammate_at_least_manipulates(self):
        teams = [draw_team(stream(seed, "t"), 3) for seed in range(100)]
        assert all(any(it.can_manipulate for it in team) for team in teams)
        assert not all(team[0].can_manipulate for team in teams)

    def test_an_impossible_guarantee_is_refused(self):
        with pytest.raises(ConfigurationError, match="can_manipulate=0"):
            draw_team(stream(0, "t"), 3, Ranges(can_manipulate=0.0))


@pytest.mark.parametrize(
    ("rooms", "difficulty"),
    [
        (1, Difficulty.EASY),
        (3, Difficulty.EASY),
        (4, Difficulty.MEDIUM),
        (6, Difficulty.MEDIUM),
        (7, Difficulty.DIFFICULT),
        (10, Difficulty.DIFFICULT),
        (12, Difficulty.DIFFICULT),
    ],
)
def test_difficulty(rooms, difficulty):
    assert difficulty_of(rooms) is difficulty


def test_a_house_without_rooms_is_refused():
    with pytest.raises(HouseError):
        difficulty_of(0)


def test_a_held_object_is_not_in_place_wherever_the_world_says_it_is():
    class Optimist(GridWorld):
        def truth(self):
            return {name: replace(it, holder="teammate_1") for name, it in super().truth().items()}

    world = Optimist()
    prepare(world, scenario(misplaced=()))
    honest = PlacementReferee(world, scenario())
    world.displace("apple", "counter", 0)
    assert honest.replaced() == ()
    assert PlacementReferee(world, scenario()).watched == ("apple", "knife")


def test_a_scenario_of_another_world_is_refused():
    class Full(GridWorld):
        def displace(self, object_id, receptacle_id, seed):
            return False

    with pytest.raises(WorldError, match="no free place for 'apple'"):
        prepare(Full(), scenario())


def test_objects_that_come_to_rest_elsewhere_make_another_scenario():
    moved = replace(scenario().misplaced[0], position=(1.0, 1.0, 9.0))
    with pytest.raises(WorldError, match=r"misplaced\[0\].position is \(1.000, 1.000, 9.000\); 'apple' came"):
        prepare(GridWorld(), replace(scenario(), misplaced=(moved,)))


def test_the_seed_of_the_set_up_is_the_scenarios_own_unless_it_is_given():
    assert scenario().placement_seed == scenario().seed
    again = replace(scenario(), seed=99, setup_seed=scenario().seed)
    first, second = GridWorld(), GridWorld()
    prepare(first, scenario())
    prepare(second, again)
    assert first.truth() == second.truth()


class TestBenchmark:
    def test_unknown_fields_and_houses_are_refused_with_the_known_ones(self):
        with pytest.raises(ConfigurationError, match="house, seed, misplaced, teammates"):
            SampleBenchmark([{"hous": "corridor"}])
        with pytest.raises(ConfigurationError, match="there are corridor"):
            SampleBenchmark([{"house": "castle"}])

    @pytest.mark.parametrize(
        "wrong", [{"seed": "x"}, {"seed": None}, {"misplaced": 1.5}, {"teammates": True}]
    )
    def test_ill_typed_draws_are_refused(self, wrong):
        (name,) = wrong
        with pytest.raises(ConfigurationError, match=f"{name}={wrong[name]!r} of .* must be a whole number"):
            SampleBenchmark([{"house": "corridor", **wrong}])

    def test_seed_and_limit(self):
        benchmark = SampleBenchmark([Draw("one_room", 1, 1, 3), Draw("corridor", 2, 1, 3)])
        assert [it.id for it in benchmark.scenarios(GridWorld(), 7, limit=1)] == ["one_room-s1-r7"]
        assert [it.id for it in benchmark.scenarios(GridWorld(), 0)] == ["one_room-s1", "corridor-s2"]
        assert [it.seed for it in benchmark.scenarios(GridWorld(), 0)] == [1, 2]

    def test_no_two_seeds_share_a_scenario(self, tmp_path):
        file = tmp_path / "house.json"
        file.write_bytes((SAMPLES / "one_room.json").read_bytes())
        benchmarks = (
            SampleBenchmark([Draw("one_room", seed, 1, 3) for seed in range(3)]),
            HouseBenchmark(file, count=3, misplaced=1, teammates=3),
        )
        for benchmark in benchmarks:
            drawn = [it for seed in range(4) for it in benchmark.scenarios(GridWorld(), seed)]
            assert len({it.id for it in drawn}) == len(drawn)
            assert len({it.seed for it in drawn}) == len(drawn)
            assert len({replace(it, id="").content_hash() for it in drawn}) == len(drawn)


def test_the_newcomer_stays_on_the_grid_beside_an_occupied_pose():
    from adhoc.evaluation.joining import joining_pose

    world = GridWorld()
    prepare(world, scenario())
    assert joining_pose(world, Pose(6.0, 2.0)) == Pose(6.0, 2.0)
    found = joining_pose(world, Pose(1.0, 2.0, yaw=1.0))
    assert world.is_free(found)
    assert planar_distance(found, Pose(1.0, 2.0)) == 0.5
    assert found.yaw == 1.0


def test_a_newcomer_with_no_way_in_is_an_error():
    from adhoc.evaluation.joining import joining_pose

    class Crowded(GridWorld):
        def is_free(self, pose):
            return False

    with pytest.raises(WorldError, match="no free place for the newcomer"):
        joining_pose(Crowded(), Pose(1.0, 1.0))
