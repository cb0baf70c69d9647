from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest
from tiny_dataset import spoil_task

from adhoc.core.errors import ConfigurationError, DatasetError
from adhoc.core.streams import derive_seed
from adhoc.dataset.benchmarks import TaskFileBenchmark
from adhoc.dataset.subset import sample
from adhoc.evaluation.lazy_scenarios import scenario_ids
from adhoc.evaluation.scenario import prepare
from adhoc.worlds.pybullet_world import PyBulletWorld


class NoWorld:
    """Fixed tasks are tried in no world."""


def benchmark(folder, **options):
    return TaskFileBenchmark(folder=str(folder), **options)


def test_all_tasks_in_order_or_the_first_few(tiny):
    scenarios = benchmark(tiny).scenarios(NoWorld(), 0)
    assert len(scenarios) == 8
    assert scenario_ids(scenarios)[0] == scenarios[0].id == "test-01-00-k1-t3"
    assert scenario_ids(benchmark(tiny).scenarios(NoWorld(), 0, limit=3)) == scenario_ids(scenarios)[:3]


def test_nothing_is_loaded_before_it_is_needed(copied):
    spoil_task(copied, lambda row: row.update(difficulty="?"), index=6)
    scenarios = benchmark(copied).scenarios(NoWorld(), 0)
    assert scenarios[5].id == "test-04-00-k1-t4"
    with pytest.raises(DatasetError, match=r"line 8: difficulty is '[?]'"):
        scenarios[6]


def test_another_run_seed_keeps_the_task_and_changes_the_episode(tiny):
    task = benchmark(tiny).scenarios(NoWorld(), 0)[3]
    again = benchmark(tiny).scenarios(NoWorld(), 7)[3]
    assert (again.id, again.seed) == ("test-01-00-k2-t4-r7", derive_seed(7, "episode", task.seed))
    assert again.placement_seed == task.placement_seed == task.seed
    assert replace(again, id=task.id, seed=task.seed, setup_seed=None) == task
    world = PyBulletWorld(image_size=2)
    prepare(world, again)
    world.close()


def test_no_two_run_seeds_share_an_id_or_an_episode(tiny):
    drawn = [it for seed in range(3) for it in benchmark(tiny).scenarios(NoWorld(), seed)]
    assert len({it.id for it in drawn}) == len(drawn)
    assert len({(it.seed, it.house.id, len(it.misplaced)) for it in drawn}) == 3 * 4


def test_masses_can_be_scaled(tiny):
    before = benchmark(tiny).scenarios(NoWorld(), 0)[0].house
    after = benchmark(tiny, mass_scale=20.0).scenarios(NoWorld(), 0)[0].house
    for light, heavy in zip(before.objects, after.objects):
        assert heavy.mass == (20.0 * light.mass if light.pickupable else light.mass)
        assert replace(heavy, mass=light.mass) == light


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"split": "dev"}, "benchmark.split=dev: must be one of train, val, test"),
        ({"subset": "half"}, "benchmark.subset=half: must be null or one of sample"),
        ({"mass_scale": 0.0}, "benchmark.mass_scale=0.0: must be above 0"),
        ({"mass_scale": float("nan")}, "benchmark.mass_scale=nan"),
    ],
)
def test_impossible_arguments_are_refused(options, told):
    with pytest.raises(ConfigurationError, match=told):
        TaskFileBenchmark(**options)


def test_a_dataset_that_is_not_shipped_is_refused():
    with pytest.raises(DatasetError, match="no dataset 'other' is shipped"):
        TaskFileBenchmark("other").scenarios(NoWorld(), 0)


class TestSample:
    def test_it_is_stratified(self):
        parts = [name.split("-") for name in sample("test")]
        rooms = Counter(int(part[1]) for part in parts)
        assert sum(rooms[count] for count in (1, 2, 3)) == 10
        assert sum(rooms[count] for count in (4, 5, 6)) == 10
        assert sum(rooms[count] for count in (7, 8, 10)) == 10
        assert set(rooms.values()) == {3, 4}
        assert Counter(part[3] for part in parts) == {f"k{k}": 6 for k in range(1, 6)}
        assert Counter(part[4] for part in parts) == {f"t{size}": 10 for size in (3, 4, 5)}
        assert len({tuple(part[:3]) for part in parts}) == 30
        assert all(part[0] == "test" and int(part[2]) < 10 for part in parts)

    def test_sizes_do_not_go_together(self):
        """Neither with each other nor with the number of rooms: no combination is much more frequent."""
        parts = [name.split("-") for name in sample("val")]
        for first, second in ((1, 3), (1, 4), (3, 4)):
            together = Counter((part[first], part[second]) for part in parts)
            assert max(together.values()) <= 3

    def test_the_first_few_are_of_all_difficulties(self):
        assert [name.split("-")[1] for name in sample("test")[:3]] == ["01", "04", "07"]

    def test_a_dataset_without_them_is_refused_at_once(self, tiny):
        with pytest.raises(DatasetError, match="there is no task 'test-07-00-k1-t5'"):
            benchmark(tiny, subset="sample").scenarios(NoWorld(), 0)
        first_two = benchmark(tiny, subset="sample").scenarios(NoWorld(), 0, limit=2)
        assert scenario_ids(first_two) == ("test-01-00-k1-t3", "test-04-00-k1-t4")
