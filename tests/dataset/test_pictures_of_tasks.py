from __future__ import annotations

from dataclasses import replace

import matplotlib.image
import numpy as np
import pytest

from adhoc.core.errors import ConfigurationError
from adhoc.core.values import Capability, Pose
from adhoc.dataset.drawing.gallery import draw_gallery
from adhoc.dataset.drawing.label_places import LabelPlaces
from adhoc.dataset.drawing.task_drawing import draw_task
from adhoc.evaluation.floor_drawing import draw_floor_plan
from adhoc.evaluation.scenario import Difficulty, Displacement, Member, Scenario
from adhoc.houses.house import FLOOR
from adhoc.houses.samples import sample_house, sample_names


def count(path, colour):
    pixels = matplotlib.image.imread(path)[..., :3]
    wanted = np.array([int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    return int((np.abs(pixels - wanted).max(axis=-1) < 0.02).sum())


@pytest.fixture
def scenario():
    house = sample_house("one_room")
    item = next(thing for thing in house.objects if thing.pickupable)
    return Scenario(
        id="one-k1",
        house=house,
        misplaced=(Displacement(item.id, FLOOR, (2.0, 2.0, 0.05)),),
        team=(
            Member("teammate_1", Capability(can_manipulate=True), Pose(1.5, 3.0)),
            Member("teammate_2", Capability(can_manipulate=False), Pose(4.0, 2.0, 1.57)),
        ),
        newcomer=Member("newcomer", Capability(), Pose(4.0, 3.0, -1.57)),
        seed=0,
        difficulty=Difficulty.EASY,
    )


class TestTask:
    def test_everything_is_drawn(self, scenario, tmp_path):
        path = tmp_path / "new" / "task.png"
        draw_task(scenario, path, ["The team alone needs 40 steps."])
        for colour in ("#c62828", "#2e7d32", "#1565c0", "#9aa3ad", "#ffb300", "#dfeedd"):
            assert count(path, colour) > 60, colour

    def test_equal_tasks_give_equal_files(self, scenario, tmp_path):
        for name in ("a.png", "b.png"):
            draw_task(scenario, tmp_path / name)
        assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()

    def test_poses_abilities_and_lines_change_the_picture(self, scenario, tmp_path):
        first = scenario.team[0]
        variants = {
            "base": scenario,
            "turned": replace(scenario, newcomer=replace(scenario.newcomer, pose=Pose(4.0, 3.0, 0.0))),
            "handless": replace(
                scenario,
                team=(replace(first, capability=Capability(can_manipulate=False)), *scenario.team[1:]),
            ),
            "elsewhere": replace(
                scenario, misplaced=(replace(scenario.misplaced[0], position=(3.0, 2.0, 0.05)),)
            ),
        }
        for name, variant in variants.items():
            draw_task(variant, tmp_path / f"{name}.png")
        draw_task(scenario, tmp_path / "told.png", ["a verdict"])
        assert len({path.read_bytes() for path in tmp_path.iterdir()}) == 5
        assert count(tmp_path / "handless.png", "#1565c0") < count(tmp_path / "base.png", "#1565c0")

    def test_without_known_positions_objects_are_only_listed(self, scenario, tmp_path):
        unknown = replace(scenario, misplaced=(replace(scenario.misplaced[0], position=None),))
        draw_task(unknown, tmp_path / "task.png")
        draw_task(scenario, tmp_path / "known.png")
        assert count(tmp_path / "task.png", "#2e7d32") == 0
        assert 0 < count(tmp_path / "task.png", "#c62828") < count(tmp_path / "known.png", "#c62828")


class TestGallery:
    def test_all_rooms_on_one_page(self, tmp_path):
        path = tmp_path / "new" / "gallery.png"
        draw_gallery([sample_house(name) for name in sample_names()], path)
        for colour in ("#fbe8d3", "#dfeedd", "#dde7f5", "#e3f1f3", "#efebe4", "#9cc7de"):
            assert count(path, colour) > 200, colour
        height, width = matplotlib.image.imread(path).shape[:2]
        assert width == 1800
        assert height <= 1.2 * width

    def test_one_scale(self, tmp_path):
        """A house twice makes the page's plans half as wide, and so a quarter as large."""
        house = sample_house("one_room")
        draw_gallery([house], tmp_path / "one.png")
        draw_gallery([house] * 9, tmp_path / "nine.png")
        one, nine = (count(tmp_path / name, "#dfeedd") for name in ("one.png", "nine.png"))
        assert nine == pytest.approx(one, rel=0.25)

    def test_no_houses(self, tmp_path):
        with pytest.raises(ConfigurationError, match="at least one"):
            draw_gallery([], tmp_path / "gallery.png")

    def test_a_plan_of_its_own_is_as_before(self, tmp_path):
        draw_floor_plan(sample_house("one_room"), tmp_path / "plan.png")
        assert count(tmp_path / "plan.png", "#dfeedd") > 1000


class TestLabelPlaces:
    def test_right_of_the_point_where_it_is_free(self):
        places = LabelPlaces((0, 0, 10, 10))
        assert places.beside(5, 5, 2, 1, gap=0.5) == pytest.approx((6.5, 5))

    def test_not_over_what_is_taken(self):
        places = LabelPlaces((0, 0, 10, 10))
        places.take(6.5, 5, 2, 1)
        first = places.beside(5, 5, 2, 1, gap=0.5)
        assert not places.is_free(*first, 2, 1)
        assert abs(first[0] - 6.5) >= 2 or abs(first[1] - 5) >= 1

    def test_inside_the_bounds(self):
        x, y = LabelPlaces((0, 0, 10, 10)).beside(9.5, 5, 2, 1)
        assert 1 <= x <= 9
        assert 0.5 <= y <= 9.5

    def test_the_least_covered_place_where_none_is_free(self):
        places = LabelPlaces((0, 0, 2, 1))
        places.take(1, 0.5, 2, 1)
        x, y = places.beside(1, 0.5, 2, 1)
        assert np.isfinite([x, y]).all()
