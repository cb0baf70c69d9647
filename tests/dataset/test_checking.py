from __future__ import annotations

import json

import pytest
from tiny_dataset import spoil_task

from adhoc.core.errors import DatasetError
from adhoc.dataset.checking import check_split
from adhoc.dataset.checks.house_checks import Violation
from adhoc.dataset.files.ceiling_file import FORMAT, VERSION, read_ceilings, write_ceilings
from adhoc.dataset.files.checked_lines import read_checked, write_checked
from adhoc.dataset.files.dataset_folder import DatasetSplit, SplitFiles
from adhoc.dataset.oracle.ceilings import Ceiling
from adhoc.houses.house import FLOOR
from adhoc.worlds.pybullet_world import PyBulletWorld


def check(folder, **options):
    return check_split(folder, "test", **{"workers": 1, "inspections": (), **options})


def kinds(report):
    return [violation.check for violation in report.violations]


def test_a_made_dataset_has_no_violations(tiny):
    report = check(tiny, workers=2)
    assert (report.houses, report.tasks, report.violations) == (2, 8, ())
    assert report.making["1"] == {"houses": 1, "drawn": 2, "rejected": {"rooms": 1}}


def test_fewer_can_be_checked(tiny):
    report = check(tiny, houses=1, tasks=3)
    assert (report.houses, report.tasks) == (1, 3)


def test_each_house_is_inspected(tiny):
    seen = []

    def inspect(house):
        seen.append(house.id)
        return [Violation("sight", "Mug", "is not seen")]

    report = check(tiny, inspections=(inspect,), tasks=1)
    assert seen == ["test-04-00", "test-01-00"]
    assert [str(it) for it in report.violations] == [
        "sight: test-01-00 Mug: is not seen",
        "sight: test-04-00 Mug: is not seen",
    ]


def test_an_impossible_task_is_a_violation_and_the_others_are_checked(copied):
    spoil_task(copied, lambda row: row["newcomer"].update(x=-100.0), index=3)
    spoil_task(copied, lambda row: row["newcomer"].update(yaw=45), index=4)
    report = check(copied)
    assert sorted(kinds(report)) == ["task file", "task file"]
    assert {violation.subject for violation in report.violations} == {"test-01-00-k2-t4", "test-04-00-k1-t3"}


def test_objects_that_come_to_rest_elsewhere_are_a_violation(copied):
    def shift(row):
        row["misplaced"][0]["position"][0] += 0.05

    spoil_task(copied, shift)
    (violation,) = check(copied).violations
    assert (violation.check, violation.subject) == ("set-up", "test-01-00-k1-t3")
    assert "came to rest at" in violation.detail
    assert "line 2" in violation.detail


def test_objects_that_are_in_place_are_a_violation(copied):
    data = DatasetSplit(copied, "test")
    house = data.house_file.house("test-01-00")
    task = data.task("test-01-00-k1-t3")
    thing = house.object(task.misplaced[0].object_id)
    assert thing.parent not in (None, FLOOR)

    def put_right(row):
        row["misplaced"][0].update(receptacle=thing.parent)

    spoil_task(copied, put_right)
    (violation,) = check(copied).violations
    where = violation.detail.split("came to rest at (")[1].split(")")[0]
    spoil_task(
        copied, lambda row: row["misplaced"][0].update(position=[float(it) for it in where.split(",")])
    )
    (violation,) = check(copied).violations
    assert violation.check == "misplaced"
    assert "lies in a reasonable place" in violation.detail


def test_a_newcomer_that_has_no_room_when_all_is_set_up_is_a_violation(tiny, monkeypatch):
    monkeypatch.setattr(PyBulletWorld, "is_free", lambda world, pose: False)
    report = check(tiny, houses=1, tasks=2)
    assert kinds(report) == ["newcomer", "newcomer"]
    assert "the newcomer cannot stand at x " in report.violations[0].detail


def test_a_list_of_hashes_that_does_not_fit_is_a_violation(copied):
    path = SplitFiles(copied, "test").house_hashes
    lines = path.read_text().splitlines(keepends=True)
    path.write_text(lines[0] + "0" + lines[1][1:])
    assert kinds(check(copied)) == ["hashes"]
    path.write_text("".join(lines) + lines[0])
    assert kinds(check(copied)) == ["hashes"]
    path.unlink()
    assert kinds(check(copied)) == ["hashes"]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("{}", "rooms is missing"),
        ("[", "not valid JSON"),
        ('{"rooms":{"1":3}}', "rooms.1 is 3; it should be an object"),
        ('{"rooms":{"1":{"houses":0,"drawn":0,"rejected":{}}}}', "rooms.1.houses is 0"),
    ],
)
def test_broken_statistics_are_an_error(copied, text, told):
    SplitFiles(copied, "test").making.write_text(text)
    with pytest.raises(DatasetError, match=rf"making-test\.json.*{told}"):
        check(copied, houses=1, tasks=1)


class TestCeilings:
    def ceilings(self, folder):
        ids = DatasetSplit(folder, "test").ids
        first = Ceiling(ids[0], "team", 120, 80, least_steps=60)
        second = Ceiling(ids[1], "none", None, None, "too heavy", False)
        return [first, second, *(Ceiling(task_id, "newcomer", None, 100) for task_id in ids[2:])]

    def test_what_was_written_is_read(self, copied):
        files = SplitFiles(copied, "test")
        write_ceilings(files, self.ceilings(copied), 500)
        assert list(read_ceilings(files).values()) == self.ceilings(copied)
        assert check(copied).violations == ()

    def test_missing_and_foreign_ones_are_violations(self, copied):
        write_ceilings(
            SplitFiles(copied, "test"), [*self.ceilings(copied)[1:], Ceiling("x", "team", 1, 1)], 500
        )
        subjects = {violation.subject for violation in check(copied, tasks=1).violations}
        assert subjects == {"test-01-00-k1-t3", "x"}

    def test_those_of_other_tasks_are_refused(self, copied):
        write_ceilings(SplitFiles(copied, "test"), self.ceilings(copied), 500)
        spoil_task(copied, lambda row: row["newcomer"].update(steps=77))
        with pytest.raises(DatasetError, match=r"line 1: tasks_sha256 .* the ceilings are of other tasks"):
            read_ceilings(SplitFiles(copied, "test"))

    @pytest.mark.parametrize(
        ("ceiling", "told"),
        [
            (Ceiling("a", "all", 1, 1), "line 2: kind is 'all'; it should be one of team"),
            (Ceiling("a", "team", -1, 1), "line 2: team_steps is -1"),
            (Ceiling("a", "team", 1, "2"), "line 2: joint_steps is '2'"),
            (Ceiling("a", "none", None, None, 3), "line 2: reason is 3"),
            (Ceiling("a", "team", None, 1), "line 2: team_steps is None; it should be a number of steps"),
            (Ceiling("a", "newcomer", 3, 1), "line 2: team_steps is 3; it should be null"),
            (Ceiling("a", "none", None, 1), "line 2: joint_steps is 1; it should be null"),
            (Ceiling("a", "none", None, None, "", "x"), "line 2: proven is 'x'"),
        ],
    )
    def test_wrong_fields_are_told(self, copied, ceiling, told):
        files = SplitFiles(copied, "test")
        write_ceilings(files, [ceiling], 500)
        with pytest.raises(DatasetError, match=told):
            read_ceilings(files)

    @pytest.mark.parametrize(
        ("field", "value", "told"),
        [
            ("split", "val", "line 1: split is 'val'; it should be 'test'"),
            ("max_steps", "x", "max_steps is 'x'"),
        ],
    )
    def test_a_header_that_does_not_fit_is_refused(self, copied, field, value, told):
        files = SplitFiles(copied, "test")
        write_ceilings(files, [], 500)
        header = dict(read_checked(files.ceilings, FORMAT, VERSION).header.value)
        del header["format"], header["version"]
        write_checked(files.ceilings, FORMAT, VERSION, {**header, field: value}, [])
        with pytest.raises(DatasetError, match=told):
            read_ceilings(files)

    def test_one_that_is_there_twice_is_refused(self, copied):
        files = SplitFiles(copied, "test")
        write_ceilings(files, [Ceiling("a", "team", 1, 1)] * 2, 500)
        with pytest.raises(DatasetError, match="line 3: task_id 'a' is there twice"):
            read_ceilings(files)


def test_the_statistics_are_plain_json(tiny):
    assert json.loads(SplitFiles(tiny, "test").making.read_text())["format"] == "adhoc-making"
