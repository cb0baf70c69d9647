from __future__ import annotations

import gzip
import json

import pytest
from tiny_dataset import spoil_task

from adhoc.core.errors import DatasetError
from adhoc.dataset.files.checked_lines import write_compressed
from adhoc.dataset.files.dataset_folder import DatasetSplit, SplitFiles
from adhoc.dataset.files.task_file import TaskFile, write_tasks


def task_path(folder):
    return SplitFiles(folder, "test").tasks


def set_to(*path, value):
    """An edit that sets the field at a path of names and indices."""

    def edit(row):
        for step in path[:-1]:
            row = row[step]
        row[path[-1]] = value

    return edit


def without(*path):
    def edit(row):
        for step in path[:-1]:
            row = row[step]
        del row[path[-1]]

    return edit


def test_the_header_says_what_the_file_is(tiny):
    header = TaskFile(task_path(tiny)).header
    assert (header.dataset, header.split, header.seed, header.tasks) == ("tiny", "test", 5, 8)
    assert header.houses == ("test-01-00", "test-04-00")
    assert header.ranges.heights == (0.9, 1.6)


def test_ids_are_in_order_and_say_what_they_are(tiny):
    assert TaskFile(task_path(tiny)).ids[:5] == (
        "test-01-00-k1-t3",
        "test-01-00-k1-t4",
        "test-01-00-k2-t3",
        "test-01-00-k2-t4",
        "test-04-00-k1-t3",
    )


def test_a_line_is_compact_and_readable(tiny):
    line = gzip.decompress(task_path(tiny).read_bytes()).splitlines()[1]
    assert line.startswith(b'{"id":"test-01-00-k1-t3","house":"test-01-00","house_hash":"')
    assert b": " not in line
    row = json.loads(line)
    assert set(row["team"][0]) == {"name", "manipulate", "height", "payload", "steps", "x", "y", "yaw"}
    assert row["team"][0]["yaw"] in (-90, 0, 90, 180)
    assert len(line) < 1000


def test_writing_what_was_read_gives_the_same_bytes(tiny, tmp_path):
    file = TaskFile(task_path(tiny))
    write_tasks(tmp_path / "again.gz", file.header, [file.task(task_id) for task_id in file.ids])
    assert (tmp_path / "again.gz").read_bytes() == task_path(tiny).read_bytes()


def test_an_unknown_task_is_told_with_an_example(tiny):
    with pytest.raises(DatasetError, match="no task 'test-09'; ids are like 'test-01-00-k1-t3'"):
        TaskFile(task_path(tiny)).task("test-09")


@pytest.mark.parametrize(
    ("edit", "told"),
    [
        (set_to("house", value="test-01-09"), "house is 'test-01-09'; it should be a known one: test-01-00"),
        (set_to("house_hash", value=3), "house_hash is 3; it should be a string"),
        (set_to("difficulty", value="Hard"), "difficulty is 'Hard'; it should be a known one: Easy"),
        (set_to("seed", value=-1), "seed is -1; it should be a whole number from 0"),
        (set_to("seed", value=2**63), "seed is 9223372036854775808; it should be a whole number"),
        (set_to("seed", value=1.0), "seed is 1.0; it should be a whole number"),
        (set_to("seed", value=True), "seed is True; it should be a whole number"),
        (set_to("misplaced", value=[]), "misplaced is a list of 0; it should be a list of 1 to 5"),
        (set_to("misplaced", value={}), "misplaced is an object of 0; it should be a list"),
        (set_to("misplaced", 0, "position", value=[1, 2]), r"misplaced[0].position is a list of 2"),
        (set_to("misplaced", 0, "position", value=[1, 2, "x"]), r"misplaced[0].position is a list of 3"),
        (set_to("misplaced", 0, "position", value=[1, 2, 1e9]), r"between -1000 and 1000"),
        (without("misplaced", 0, "object"), "misplaced[0].object is missing"),
        (set_to("misplaced", 0, "height", value=1), "misplaced[0].height: there is no such field"),
        (set_to("team", value=[]), "team is a list of 0; it should be a list of 3 to 5"),
        (set_to("team", 1, "height", value=1.2), "team[1].height is 1.2; it should be one of 0.9, 1.6"),
        (set_to("team", 1, "payload", value=20.5), "team[1].payload is 20.5; it should be a number from 0.1"),
        (set_to("team", 1, "payload", value="7"), "team[1].payload is '7'; it should be a number"),
        (set_to("team", 1, "steps", value=49), "team[1].steps is 49; it should be a whole number from 50"),
        (set_to("team", 1, "manipulate", value=1), "team[1].manipulate is 1; it should be true or false"),
        (without("team", 1, "manipulate"), "team[1].manipulate is missing; it should be true or false"),
        (set_to("team", 1, "yaw", value=45), "team[1].yaw is 45; it should be a multiple of 90"),
        (set_to("team", 1, "yaw", value=270), "team[1].yaw is 270; it should be a whole number from -180"),
        (set_to("team", 1, "x", value=None), "team[1].x is None; it should be a number"),
        (set_to("team", 1, "name", value=""), "team[1].name is ''; it should be a string"),
        (set_to("team", 1, "name", value="[/x]"), "team[1].name is '[/x]'; it should be a name of letters"),
        (set_to("team", 1, "name", value="newcomer"), "team: two robots have one name"),
        (set_to("newcomer", "steps", value=501), "newcomer.steps is 501"),
        (set_to("newcomer", value=None), "newcomer is None; it should be an object"),
        (without("newcomer"), "newcomer is missing"),
        (set_to("colour", value="red"), "colour: there is no such field; there are id, house"),
    ],
)
def test_a_wrong_field_is_one_error_with_file_line_and_field(copied, edit, told):
    spoil_task(copied, edit, index=2)
    file = TaskFile(task_path(copied))
    assert file.task(file.ids[1])
    with pytest.raises(DatasetError) as error:
        file.task(file.ids[2])
    assert f"{task_path(copied)}, line 4: " in str(error.value)
    assert told in str(error.value)
    assert "\n" not in str(error.value)


def test_a_team_without_hands_is_refused(copied):
    def tie(row):
        for member in row["team"]:
            member["manipulate"] = False

    spoil_task(copied, tie)
    with pytest.raises(DatasetError, match="line 2: team: no robot can manipulate"):
        TaskFile(task_path(copied)).task("test-01-00-k1-t3")


@pytest.mark.parametrize(
    ("edit", "told"),
    [
        (set_to("house_sha256", value="abc"), "house_sha256 is 'abc'; it should be 64 hexadecimal digits"),
        (set_to("house_file", value="../houses.gz"), "house_file is '../houses.gz'; it should be the name"),
        (set_to("houses", value=["a", "a"]), "houses is a list of 2; it should be a list of names that are"),
        (set_to("tasks", value=7), "the file has 8 tasks; by its header it should have 7"),
        (set_to("seed", value="0"), "seed is '0'"),
        (set_to("split", value="val"), "split is 'val'; by the file's name it is 'test'"),
        (set_to("ranges", "payload", value=[3, 1]), "ranges.payload is a list of 2; it should be a lowest"),
        (set_to("ranges", "max_steps", value=[1.5, 3]), "ranges.max_steps is a list of 2; it should be two"),
        (set_to("ranges", "floor", value=2), "ranges.floor is 2; it should be a number from 0 to 1"),
        (without("ranges", "apart"), "ranges.apart is missing"),
        (set_to("licence", value="x"), "licence: there is no such field"),
    ],
)
def test_a_wrong_header_is_one_error(copied, edit, told):
    spoil_task(copied, edit, index=None)
    with pytest.raises(DatasetError) as error:
        DatasetSplit(copied, "test")
    assert str(task_path(copied)) in str(error.value)
    assert told in str(error.value)


def test_a_task_that_is_there_twice_is_refused_with_both_lines(copied):
    spoil_task(copied, set_to("id", value="test-01-00-k1-t3"), index=5)
    with pytest.raises(
        DatasetError, match=r"line 7: id 'test-01-00-k1-t3' is there twice, first in .* line 2"
    ):
        TaskFile(task_path(copied))


def test_a_task_without_an_id_is_refused(copied):
    spoil_task(copied, without("id"), index=1)
    with pytest.raises(DatasetError, match="line 3: id is missing"):
        TaskFile(task_path(copied))


def test_lines_that_are_missing_are_noticed(copied):
    content = gzip.decompress(task_path(copied).read_bytes())
    write_compressed(task_path(copied), b"".join(content.splitlines(keepends=True)[:-1]))
    with pytest.raises(DatasetError, match="the file has 7 tasks; by its header it should have 8"):
        TaskFile(task_path(copied))


@pytest.mark.parametrize(
    ("kind", "version", "told"), [("x", 1, "format is 'x'"), ("adhoc-tasks", 2, "version is 2")]
)
def test_other_files_and_versions_are_told(copied, kind, version, told):
    spoil_task(copied, lambda row: None, kind=kind, version=version)
    with pytest.raises(DatasetError, match=f"line 1: {told}"):
        TaskFile(task_path(copied))
