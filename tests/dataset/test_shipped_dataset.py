"""The dataset that comes with the library: what it promises, and what its card says of it."""

from __future__ import annotations

import hashlib
from collections import Counter
from pathlib import Path

import pytest

from adhoc.core.line_checksum import canonical
from adhoc.dataset.benchmarks import TaskFileBenchmark
from adhoc.dataset.files.ceiling_file import read_ceilings
from adhoc.dataset.files.checked_lines import read_compressed
from adhoc.dataset.files.dataset_folder import SPLITS, DatasetSplit, dataset_folder
from adhoc.dataset.files.task_file import StoredTask
from adhoc.dataset.generator import ROOM_COUNTS, generate_house
from adhoc.dataset.making.house_making import HOUSE_ATTEMPTS, HousePlan, make_house
from adhoc.dataset.making.split_making import make_split
from adhoc.dataset.oracle.summary import summarise, to_markdown
from adhoc.dataset.subset import sample
from adhoc.evaluation.scenario import Difficulty
from adhoc.houses.procthor_writing import house_document
from adhoc.worlds.pybullet_world import PyBulletWorld

PAPER = dataset_folder("paper")
CARD = Path(__file__).parents[2] / "docs" / "dataset.md"


@pytest.fixture(scope="module", params=SPLITS)
def data(request) -> DatasetSplit:
    return DatasetSplit(PAPER, request.param)


@pytest.fixture(scope="module")
def tasks(data: DatasetSplit) -> list[StoredTask]:
    return [data.task(task_id) for task_id in data.ids]


def listed_hashes(split: str) -> dict[str, str]:
    lines = (PAPER / f"houses-{split}.sha256").read_text(encoding="utf-8").splitlines()
    return {house_id: digest for digest, house_id in (line.split("  ") for line in lines)}


def plan_of(house_id: str) -> HousePlan:
    split, rooms, index = house_id.split("-")
    return HousePlan(split, int(rooms), int(index), seed=0)


def test_every_split_is_the_papers_grid(data, tasks):
    assert len(tasks) == 1350
    grid = Counter((int(task.house_id.split("-")[1]), len(task.misplaced), len(task.team)) for task in tasks)
    assert grid == {
        (rooms, k, size): 10 for rooms in ROOM_COUNTS for k in (1, 2, 3, 4, 5) for size in (3, 4, 5)
    }
    assert Counter(task.difficulty for task in tasks) == dict.fromkeys(Difficulty, 450)


def test_robots_are_drawn_from_the_papers_ranges(tasks):
    for task in tasks:
        assert any(member.capability.can_manipulate for member in task.team)
    robots = [member.capability for task in tasks for member in (*task.team, task.newcomer)]
    assert all(robot.can_navigate for robot in robots)
    assert {robot.camera_height for robot in robots} == {0.9, 1.6}
    assert all(0.1 <= robot.payload <= 20.0 and 50 <= robot.max_steps <= 500 for robot in robots)
    assert {task.newcomer.capability.can_manipulate for task in tasks} == {True, False}
    assert min(robot.max_steps for robot in robots) < 60
    assert max(robot.payload for robot in robots) > 19.5


def test_team_sizes_share_the_misplaced_objects_and_nothing_else(tasks):
    scenarios: dict[str, list[StoredTask]] = {}
    for task in tasks:
        scenarios.setdefault(task.id.rsplit("-", 1)[0], []).append(task)
    assert len(scenarios) == 450
    for group in scenarios.values():
        assert len({(task.seed, task.misplaced) for task in group}) == 1
        assert len({task.newcomer for task in group}) == 3


def test_splits_share_no_seed_and_no_house():
    plans = [plan_of(house_id) for split in SPLITS for house_id in listed_hashes(split)]
    seeds = [plan.house_seed(attempt) for plan in plans for attempt in range(HOUSE_ATTEMPTS)]
    assert len(set(seeds)) == len(seeds) == 270 * HOUSE_ATTEMPTS
    hashes = [digest for split in SPLITS for digest in listed_hashes(split).values()]
    assert len(set(hashes)) == 270


def test_the_90_test_houses_are_made_again_bit_for_bit():
    wanted = listed_hashes("test")
    assert len(wanted) == 90
    for house_id, digest in wanted.items():
        plan = plan_of(house_id)
        assert any(house_hash(plan, attempt) == digest for attempt in range(5)), (
            f"{house_id} is made differently on this machine"
        )


def house_hash(plan: HousePlan, attempt: int) -> str:
    generated = generate_house(plan.rooms, plan.house_seed(attempt), plan.house_id)
    return hashlib.sha256(canonical(house_document(generated.house))).hexdigest()


@pytest.mark.parametrize("house_id", ["test-01-02", "val-05-03"])
def test_houses_and_tasks_are_made_again_byte_for_byte(house_id):
    made = make_house(plan_of(house_id))
    data = DatasetSplit(PAPER, house_id.split("-")[0])
    assert made.line == data.house_file.line(house_id)
    for task in made.tasks:
        assert data.task(task.id) == task


@pytest.mark.slow
@pytest.mark.timeout(1800)
@pytest.mark.parametrize("split", SPLITS)
def test_whole_splits_are_made_again_byte_for_byte(split, tmp_path):
    make_split(split, tmp_path, dataset_seed=0)
    made = sorted(tmp_path.iterdir())
    assert len(made) == 4
    for path in made:
        shipped = PAPER / path.name
        if path.suffix == ".gz":
            assert read_compressed(path) == read_compressed(shipped)
        else:
            assert path.read_bytes() == shipped.read_bytes()


def test_the_sample_stands_for_all(tasks, data):
    by_id = {task.id: task for task in tasks}
    chosen = [by_id[task_id] for task_id in sample(data.header.split)]
    assert len({task.house_id for task in chosen}) == len(chosen) == 30
    assert Counter(task.difficulty for task in chosen) == dict.fromkeys(Difficulty, 10)
    assert Counter(len(task.team) for task in chosen) == dict.fromkeys((3, 4, 5), 10)
    assert Counter(len(task.misplaced) for task in chosen) == dict.fromkeys((1, 2, 3, 4, 5), 6)
    assert {int(task.house_id.split("-")[1]) for task in chosen} == set(ROOM_COUNTS)


def test_tasks_of_all_room_counts_load():
    world = PyBulletWorld(image_size=2)
    scenarios = TaskFileBenchmark("paper").scenarios(world, seed=0)
    assert len(scenarios) == 1350
    for position in range(7, 1350, 150):
        scenario = scenarios[position]
        assert len(scenario.house.rooms) == int(scenario.id.split("-")[1])
    world.close()


def test_every_task_has_a_ceiling(data, tasks):
    ceilings = read_ceilings(data.files)
    assert list(ceilings) == list(data.ids)
    for task in tasks:
        found = ceilings[task.id]
        if found.kind == "none":
            assert found.reason
        else:
            assert found.joint_steps is not None
            assert found.joint_steps <= 500
            assert found.least_steps is None or found.least_steps <= found.joint_steps


def test_the_card_shows_the_ceilings_of_the_test_split():
    data = DatasetSplit(PAPER, "test")
    table = to_markdown(summarise(read_ceilings(data.files).values(), map(data.task, data.ids)))
    assert table in CARD.read_text(encoding="utf-8")
