from __future__ import annotations

import gzip
from dataclasses import replace

import pytest
from tiny_dataset import GRID, from_samples, spoil_task

from adhoc.core.errors import DatasetError
from adhoc.core.values import Pose
from adhoc.dataset.files.checked_lines import write_compressed
from adhoc.dataset.files.dataset_folder import DatasetSplit, SplitFiles, dataset_folder
from adhoc.dataset.files.task_file import HASH_DIGITS
from adhoc.dataset.making.house_making import HousePlan, make_house
from adhoc.dataset.making.house_tasks import draw_tasks
from adhoc.evaluation.scenario import prepare
from adhoc.houses.house import FLOOR
from adhoc.houses.house_files import decode, documents
from adhoc.worlds.pybullet_world import PyBulletWorld

TASK = "test-04-00-k2-t4"
LINE = 9


@pytest.fixture(scope="module")
def world():
    world = PyBulletWorld(image_size=2)
    yield world
    world.close()


def test_a_task_is_the_scenario_that_was_drawn(tiny, world):
    data = DatasetSplit(tiny, "test")
    house = data.house_file.house("test-04-00")
    drawn = next(it for it in draw_tasks(world, house, 5, GRID) if it.id == TASK)
    loaded = data.scenario(TASK)
    assert replace(loaded, source="") == drawn
    assert loaded.content_hash() == drawn.content_hash()
    assert loaded.source == f"{SplitFiles(tiny, 'test').tasks}, line {LINE}"


def test_every_task_can_be_set_up_where_it_was_drawn(tiny, world):
    data = DatasetSplit(tiny, "test")
    for task_id in data.ids:
        prepare(world, data.scenario(task_id))


def test_robots_see_names_that_tell_nothing(tiny):
    data = DatasetSplit(tiny, "test")
    stored, scenario = data.task(TASK), data.scenario(TASK)
    house = data.house_file.house("test-04-00")
    for before, after in zip(stored.misplaced, scenario.misplaced):
        assert before.object_id in {thing.id for thing in house.objects}
        assert after.object_id.startswith(f"{scenario.house.object(after.object_id).category}_")
        assert house.object(before.object_id).category == scenario.house.object(after.object_id).category
        assert (before.receptacle_id == FLOOR) == (after.receptacle_id == FLOOR)


def test_the_house_file_is_a_plain_file_of_houses(tiny):
    path = SplitFiles(tiny, "test").houses
    assert [len(decode(document)["rooms"]) for document in documents(path)] == [1, 4]


def test_the_hashes_are_those_of_the_lines(tiny):
    plan = HousePlan("test", 1, 0, 5, GRID, from_samples, lambda house: [])
    made = make_house(plan)
    listed = SplitFiles(tiny, "test").house_hashes.read_text().splitlines()
    assert listed[0] == f"{made.sha256}  test-01-00"
    assert DatasetSplit(tiny, "test").task("test-01-00-k1-t3").house_hash == made.sha256[:HASH_DIGITS]


def pose(member, x, y):
    def edit(row):
        target = row["newcomer"] if member is None else row["team"][member]
        target.update(x=x, y=y)

    return edit


def misplaced(**fields):
    return lambda row: row["misplaced"][0].update(fields)


def table_of(folder):
    house = DatasetSplit(folder, "test").house_file.house("test-04-00")
    return next(thing for thing in house.objects if thing.category == "DiningTable").position


class TestImpossibleTasks:
    def refused(self, folder):
        data = DatasetSplit(folder, "test")
        with pytest.raises(DatasetError) as error:
            data.scenario(TASK)
        text = str(error.value)
        prefix = f"{SplitFiles(folder, 'test').tasks}, line {LINE}: "
        assert text.startswith(prefix)
        return text.removeprefix(prefix)

    @pytest.mark.parametrize(
        ("edit", "told"),
        [
            (pose(0, -3.0, 1.0), "team[0] stands at x -3, y 1; that is outside the house"),
            (pose(None, 500.0, 1.0), "newcomer stands at x 500, y 1; that is outside the house"),
            (pose(1, 1.1, 1.0), "team[1] stands at x 1.1, y 1; robots begin at multiples of 0.25 m"),
            (
                misplaced(object="Spoon|9"),
                "misplaced[0].object is 'Spoon|9'; it should be an object of house",
            ),
            (
                misplaced(receptacle="Shelf|9"),
                "misplaced[0].receptacle is 'Shelf|9'; it should be 'Floor' or a",
            ),
            (
                misplaced(position=[-9, 1, 1]),
                "misplaced[0].position is (-9, 1, 1); it should be inside the house",
            ),
            (misplaced(position=[1, 1, 99]), "misplaced[0].position is (1, 1, 99); it should be inside the"),
            (
                lambda row: row.update(difficulty="Easy"),
                "difficulty is 'Easy'; a house of 4 rooms is 'Medium'",
            ),
            (
                lambda row: row.update(house_hash="0" * 16),
                "house_hash is '0000000000000000'; house 'test-04-00' of",
            ),
            (lambda row: row["misplaced"].append(row["misplaced"][0]), "that object is misplaced already"),
        ],
    )
    def test_they_are_told_with_file_line_and_field(self, copied, edit, told):
        spoil_task(copied, edit, index=LINE - 2)
        assert told in self.refused(copied)

    def test_a_robot_in_a_table(self, copied):
        x, y, _ = table_of(copied)
        spoil_task(copied, pose(2, round(4 * x) / 4, round(4 * y) / 4), index=LINE - 2)
        assert "team[2] stands at" in (text := self.refused(copied))
        assert "a wall or a piece of furniture is in the way" in text

    def test_a_robot_on_another(self, copied):
        other = DatasetSplit(copied, "test").task(TASK).team[1].pose
        spoil_task(copied, pose(3, other.x, other.y), index=LINE - 2)
        assert "0.00 m from team[1]; robots begin at least 0.5 m apart" in self.refused(copied)

    def test_a_robot_on_a_dropped_object(self, copied):
        here = DatasetSplit(copied, "test").task(TASK).newcomer.pose
        spoil_task(copied, misplaced(receptacle=FLOOR, position=[here.x + 0.1, here.y, 0.1]), index=LINE - 2)
        assert "newcomer stands at" in (text := self.refused(copied))
        assert "lies there" in text

    def test_furniture_cannot_be_misplaced(self, copied):
        table = next(
            thing.id
            for thing in DatasetSplit(copied, "test").house_file.house("test-04-00").objects
            if thing.category == "DiningTable"
        )
        spoil_task(copied, misplaced(object=table), index=LINE - 2)
        assert "that can be picked up" in self.refused(copied)

    def test_a_robot_that_is_locked_in(self, copied, monkeypatch):
        import adhoc.dataset.files.task_checks as checks

        here = DatasetSplit(copied, "test").task(TASK).team[0].pose

        class Severed(checks.FreeCells):
            def __init__(self, *arguments):
                super().__init__(*arguments)
                self.connected[self.index(here.x, here.y)] = False

        monkeypatch.setattr(checks, "FreeCells", Severed)
        assert "team[0] stands at" in (text := self.refused(copied))
        assert "the rest of the house cannot be reached from there" in text


class TestHouseFile:
    def test_a_changed_house_is_noticed_before_any_task_is_run_in_it(self, copied):
        path = SplitFiles(copied, "test").houses
        content = gzip.decompress(path.read_bytes())
        write_compressed(path, content.replace(b"0.1", b"0.2", 1))
        with pytest.raises(DatasetError, match=r"houses-test\.jsonl\.gz: the SHA-256 of its content is"):
            DatasetSplit(copied, "test").scenario(TASK)

    def test_a_damaged_file_is_told(self, copied):
        path = SplitFiles(copied, "test").houses
        path.write_bytes(path.read_bytes()[:-20])
        with pytest.raises(DatasetError, match=r"houses-test\.jsonl\.gz: it is cut off"):
            DatasetSplit(copied, "test").scenario(TASK)

    def test_a_missing_file_is_told(self, copied):
        SplitFiles(copied, "test").houses.unlink()
        with pytest.raises(DatasetError, match=r"houses-test\.jsonl\.gz: there is no such file"):
            DatasetSplit(copied, "test").scenario(TASK)

    def test_few_houses_are_kept(self, tiny):
        houses = DatasetSplit(tiny, "test").house_file
        assert houses.house("test-01-00") is houses.house("test-01-00")
        assert houses.house("test-01-00").id == "test-01-00"
        with pytest.raises(DatasetError, match="there is no house 'test-09-00'"):
            houses.house("test-09-00")


def test_a_missing_split_dataset_or_folder_is_told(tiny, tmp_path):
    with pytest.raises(DatasetError, match=r"tasks-val\.jsonl\.gz: there is no such file"):
        DatasetSplit(tiny, "val")
    with pytest.raises(DatasetError, match="no split 'dev'; there are: train, val, test"):
        DatasetSplit(tiny, "dev")
    with pytest.raises(DatasetError, match="no dataset 'nothing' is shipped"):
        dataset_folder("nothing")
    with pytest.raises(DatasetError, match="nowhere: there is no such folder"):
        dataset_folder("paper", tmp_path / "nowhere")
    assert dataset_folder("paper", tiny) == tiny


def test_poses_survive_exactly(tiny):
    for member in DatasetSplit(tiny, "test").task(TASK).team:
        assert isinstance(member.pose, Pose)
        assert (4 * member.pose.x).is_integer()
        assert member.pose.pitch == 0.0
