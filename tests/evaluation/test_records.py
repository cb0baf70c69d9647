from __future__ import annotations

import json
import resource
import signal
import warnings
from contextlib import contextmanager

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from adhoc.core.errors import RecordError
from adhoc.evaluation.records import RecordFile, TornRecordWarning


def record(number: int = 0, **changes):
    return {
        "episode_id": f"episode-{number}",
        "task_id": f"task-{number}",
        "house_id": "house",
        "rooms": 2,
        "difficulty": "Easy",
        "teammates": 2,
        "misplaced": 2,
        "team": "heuristic",
        "policy": "none",
        "join_step": None,
        "seed": number,
        "model": None,
        "success": True,
        "replaced": 2,
        "partial_success": 1.0,
        "temporal_steps": 120,
        "action_steps": 240,
        "reference_temporal_steps": None,
        "efficiency": None,
        "llm": {"calls": 0, "cost_usd": 0.0},
        "wall_s": 0.125,
        "library_version": "0",
        "config_hash": "abc",
        **changes,
    }


@pytest.fixture
def file(tmp_path):
    file = RecordFile(tmp_path)
    for number in range(3):
        file.append(record(number))
    return file


def test_records_come_back_as_they_were_written(file):
    assert file.read() == [record(number) for number in range(3)]


def test_a_folder_without_records_is_empty(tmp_path):
    assert RecordFile(tmp_path / "nothing").read() == []


def test_every_torn_end_is_named_and_left_out(file):
    whole = file.path.read_bytes()
    last = len(b"\n".join(whole.split(b"\n")[:2])) + 1
    for end in (last + 1, last + 40, len(whole) - 1):
        file.path.write_bytes(whole[:end])
        with pytest.warns(TornRecordWarning, match="line 3: incomplete last record"):
            assert len(file.read()) == 2


def test_writing_goes_on_behind_a_torn_end(file):
    file.path.write_bytes(file.path.read_bytes()[:-30])
    file.append(record(7))
    assert [it["seed"] for it in file.read()] == [0, 1, 7]


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=150)
@given(place=st.floats(0, 0.999), mask=st.integers(1, 255))
def test_no_flipped_byte_goes_unnoticed(file, place, mask):
    """But for the digits of the wall-clock time, which no checksum covers and no result depends on."""
    whole = file.path.read_bytes()
    position = int(place * len(whole))
    damaged = bytearray(whole)
    damaged[position] ^= mask
    intact = file.read()
    file.path.write_bytes(bytes(damaged))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", TornRecordWarning)
            after = file.read()
    except RecordError as error:
        assert "line" in str(error)  # noqa: PT017
    else:
        without_wall = [{**it, "wall_s": 0} for it in after]
        assert without_wall == [{**it, "wall_s": 0} for it in intact][: len(after)]
        assert len(after) >= 2
    finally:
        file.path.write_bytes(whole)


def test_damage_names_file_and_line(file):
    text = file.path.read_text().replace('"task_id":"task-1"', '"task_id":"task-9"')
    file.path.write_text(text)
    with pytest.raises(RecordError, match=r"episodes\.jsonl, line 2: the checksum"):
        file.read()


@pytest.mark.parametrize("line", ["", "{}", "[1]", "not json", "\x00", '{"crc":"0"}', '{"crc":NaN,"a":NaN}'])
def test_foreign_lines_are_errors(file, line):
    with open(file.path, "a") as handle:
        handle.write(line + "\n")
    with pytest.raises(RecordError, match="line 4"):
        file.read()


def test_the_same_episode_twice_is_an_error(file):
    file.append(record(1))
    with pytest.raises(RecordError, match=r"line 4: episode 'episode-1' is there twice, first in line 2"):
        file.read()


@pytest.mark.parametrize(
    "changes",
    [{"rooms": "2"}, {"success": 1}, {"temporal_steps": True}, {"model": 3}, {"wall_s": float("nan")}],
)
def test_a_wrong_field_is_not_written(tmp_path, changes):
    with pytest.raises(RecordError):
        RecordFile(tmp_path).append(record(**changes))


def test_a_missing_field_is_not_written(tmp_path):
    incomplete = {name: value for name, value in record().items() if name != "seed"}
    with pytest.raises(RecordError, match="'seed' is missing"):
        RecordFile(tmp_path).append(incomplete)


def test_the_checksum_leaves_out_the_wall_clock(tmp_path):
    for name, wall in (("a", 1.0), ("b", 2.0)):
        RecordFile(tmp_path / name).append(record(wall_s=wall))
    first, second = (json.loads((tmp_path / name / "episodes.jsonl").read_text()) for name in ("a", "b"))
    assert first["crc"] == second["crc"]


@contextmanager
def full_disk(file):
    """No file may grow beyond the size of the records: what a full disk does, for this process alone.

    Nothing else may write meanwhile, such as a test runner to its own log.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (file.path.stat().st_size + 100, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        signal.signal(signal.SIGXFSZ, before)


def test_a_full_disk_is_told_and_nothing_is_lost(file):
    told = r"episodes\.jsonl: cannot be written: File too large"
    with pytest.raises(RecordError, match=told), full_disk(file):
        file.append(record(7))
    with pytest.raises(RecordError, match=told), full_disk(file):
        file.replace([record(number) for number in range(9)])
    with pytest.warns(TornRecordWarning):
        assert len(file.read()) == 3
