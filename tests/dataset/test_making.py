from __future__ import annotations

import json
from dataclasses import replace

import pytest
from tiny_dataset import GRID, from_samples, make_tiny, nothing_falls

from adhoc.core.errors import ConfigurationError, DatasetError
from adhoc.dataset.checks.house_checks import Violation
from adhoc.dataset.files.dataset_folder import DatasetSplit, SplitFiles
from adhoc.dataset.generator import Generated
from adhoc.dataset.making.house_making import HousePlan, make_house
from adhoc.dataset.making.house_tasks import TaskGrid, task_id
from adhoc.dataset.making.split_making import make_split
from adhoc.evaluation.ranges import Ranges
from adhoc.houses.samples import sample_house

FILES = ["houses-test.jsonl.gz", "houses-test.sha256", "making-test.json", "tasks-test.jsonl.gz"]


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_two_processes_make_the_same_bytes_as_one(tiny, tmp_path):
    made = contents(make_tiny(tmp_path / "again", workers=2))
    assert sorted(made) == FILES
    assert made == contents(tiny)


def test_another_seed_makes_other_tasks(tiny, tmp_path):
    made = contents(make_tiny(tmp_path / "other", counts=(1,), seed=6))
    assert made["tasks-test.jsonl.gz"] != contents(tiny)["tasks-test.jsonl.gz"]


def test_no_two_houses_share_a_seed():
    plans = [
        HousePlan(split, rooms, index, seed)
        for split in ("train", "val", "test")
        for rooms in (1, 2, 10)
        for index in range(4)
        for seed in (0, 1)
    ]
    assert len({plan.house_seed(attempt) for plan in plans for attempt in range(3)}) == 3 * len(plans)


def test_more_houses_leave_the_others_as_they_are(tiny, tmp_path):
    alone = DatasetSplit(make_tiny(tmp_path / "alone", counts=(4,)), "test")
    both = DatasetSplit(tiny, "test")
    assert [both.task(task_id) for task_id in alone.ids] == [alone.task(task_id) for task_id in alone.ids]


def test_team_sizes_share_the_misplaced_objects_and_nothing_else(tiny):
    data = DatasetSplit(tiny, "test")
    three, four = data.task("test-04-00-k2-t3"), data.task("test-04-00-k2-t4")
    assert (three.misplaced, three.seed) == (four.misplaced, four.seed)
    assert three.newcomer.capability != four.newcomer.capability
    assert three.team[0].capability != four.team[0].capability
    assert data.task("test-04-00-k1-t3").seed != three.seed


def test_all_of_the_papers_sizes_are_made():
    sizes = list(TaskGrid().sizes())
    assert len(set(sizes)) == 15
    assert (sizes[0], sizes[-1]) == ((1, 3), (5, 5))
    assert task_id("test-01-00", *sizes[-1]) == "test-01-00-k5-t5"


def test_the_statistics_count_what_was_rejected(tiny):
    making = json.loads(SplitFiles(tiny, "test").making.read_text())
    assert making["rooms"] == {
        "1": {"houses": 1, "drawn": 2, "rejected": {"rooms": 1}},
        "4": {"houses": 1, "drawn": 2, "rejected": {"rooms": 1}},
    }


def test_a_house_in_which_things_fall_is_replaced_by_that_of_the_next_seed():
    plan = HousePlan("test", 1, 0, 5, GRID)
    seeds = []

    def generate(rooms, seed, house_id):
        seeds.append(seed)
        return Generated(replace(sample_house("one_room"), id=house_id), ())

    def fall(house):
        return [Violation("gravity", "Mug", "falls")] if len(seeds) < 3 else []

    made = make_house(replace(plan, generate=generate, fall=fall))
    assert seeds == [plan.house_seed(attempt) for attempt in range(3)]
    assert made.rejected == {"gravity": 2}
    assert made.house_id == "test-01-00"


def test_a_house_without_enough_to_misplace_is_replaced():
    bare = sample_house("one_room")
    bare = replace(bare, objects=tuple(it for it in bare.objects if not it.pickupable))
    houses = [bare, sample_house("one_room")]
    plan = HousePlan(
        "test", 1, 0, 5, GRID, lambda rooms, seed, name: Generated(replace(houses.pop(0), id=name), ())
    )
    made = make_house(replace(plan, fall=nothing_falls))
    assert made.rejected == {"too few objects to misplace": 1}
    assert len(made.tasks) == 4


def test_a_house_without_room_for_the_robots_is_replaced():
    ranges = Ranges(apart=30.0, crowded=30.0)
    plan = HousePlan("test", 1, 0, 5, replace(GRID, ranges=ranges), from_samples, nothing_falls)
    with pytest.raises(DatasetError, match="no room for the robots 20"):
        make_house(plan)


def test_no_usable_house_is_an_error_with_the_reasons():
    plan = HousePlan(
        "test", 1, 0, 5, GRID, from_samples, lambda house: [Violation("gravity", "Mug", "falls")]
    )
    with pytest.raises(DatasetError, match=r"'test-01-00': none of 20 .* can be used: gravity 20, rooms 20"):
        make_house(plan)


def test_progress_is_told_after_each_house(tmp_path):
    told = []
    make_tiny(tmp_path, progress=lambda *news: told.append(news))
    assert told == [(1, 2, "test-04-00"), (2, 2, "test-01-00")]


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"split": "dev"}, "split=dev: must be one of train, val, test"),
        ({"counts": (9,)}, r"rooms=\[9\]: must be some of 1, 2"),
        ({"counts": ()}, "rooms="),
        ({"workers": 0}, "workers=0: must be at least 1"),
        ({"houses_per_count": 0}, "houses_per_count=0: must be from 1 to 100"),
    ],
)
def test_impossible_numbers_are_refused(tmp_path, options, told):
    with pytest.raises(ConfigurationError, match=told):
        make_split(**{"split": "test", "folder": tmp_path, "dataset_seed": 0, **options})
    assert not list(tmp_path.iterdir())


def test_what_was_there_is_not_mixed_with_what_was_not_finished(tiny, copied):
    def fail(house):
        raise DatasetError("no")

    with pytest.raises(DatasetError):
        make_tiny(copied, fall=fail)
    assert contents(copied) == contents(tiny)
