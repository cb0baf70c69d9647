"""Training houses are no benchmark's, and those to validate on are not those to fit to."""

from __future__ import annotations

import pytest

from adhoc.dataset.files.dataset_folder import SPLITS, DatasetSplit, dataset_folder
from adhoc.dataset.making.house_making import HousePlan
from adhoc.training.training_houses import CHOOSE, FIT, VALIDATE, house_draws, house_of, scenarios_of
from adhoc.worlds.pybullet_world import PyBulletWorld


def furniture(house):
    return {(it.asset, it.position) for it in house.objects}


def test_no_seed_is_that_of_a_shipped_house_or_of_another_split():
    ours = {
        draw.derive()
        for split in (FIT, CHOOSE, VALIDATE)
        for seed in (0, 1)
        for draw in house_draws(split, 400, seed)
    }
    assert len(ours) == 3 * 2 * 400
    shipped = {
        HousePlan(split, rooms, index, 0).house_seed(attempt)
        for split in SPLITS
        for rooms in range(1, 11)
        for index in range(10)
        for attempt in range(3)
    }
    assert not ours & shipped


def test_the_houses_are_others():
    ours = [house_of(draw) for split in (FIT, VALIDATE) for draw in house_draws(split, 9, 0)]
    kept = [furniture(house) for house in ours]
    for split in SPLITS:
        data = DatasetSplit(dataset_folder("paper", None), split)
        for task_id in data.ids[::150]:
            shipped = furniture(data.scenario(task_id).house)
            assert all(not shipped & house for house in kept)
    assert all(not one & other for n, one in enumerate(kept) for other in kept[:n])


def test_more_houses_begin_with_the_same():
    assert house_draws(FIT, 12, 3)[:5] == house_draws(FIT, 5, 3)
    assert [draw.rooms for draw in house_draws(FIT, 10, 3)] == [1, 2, 3, 4, 5, 6, 7, 8, 10, 1]


@pytest.fixture
def world():
    made = PyBulletWorld()
    yield made
    made.close()


def test_scenarios_are_drawn_the_same_each_time(world):
    (draw,) = house_draws(VALIDATE, 1, 0)
    first, second = (list(scenarios_of(world, draw, 2)) for _ in range(2))
    assert [it.content_hash() for it in first] == [it.content_hash() for it in second]
    assert first[0].seed != first[1].seed
