"""The quick way of reading records passes exactly what the slow one passes."""

from __future__ import annotations

import gc
import json

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from test_records import record

from adhoc.core.errors import RecordError
from adhoc.evaluation.record_lines import AT_ONCE, quick_records, without_collecting
from adhoc.evaluation.records import UNCHECKED, RecordFile


def lines_of(folder, *records):
    file = RecordFile(folder)
    for it in records:
        file.append(it)
    return file.path.read_bytes().split(b"\n")[:-1]


FULL = {
    "llm": {"calls": 1, "cost_usd": 0.5, "replayed": 3},
    "run": "ab12",
    "name": 'with ",\\"wall_s":0.125, in it',
}


def test_good_lines_come_back_without_their_checksum(tmp_path):
    mine = [record(number, **FULL) for number in range(3)]
    assert quick_records(lines_of(tmp_path, *mine), UNCHECKED) == mine


def test_a_field_that_is_there_twice_is_left_to_the_slow_way(tmp_path):
    twice = record(0, other={"a": 1, "wall_s": 0.125})
    lines = lines_of(tmp_path, twice)
    assert quick_records(lines, UNCHECKED) == [None]
    assert RecordFile(tmp_path).read() == [twice]


@pytest.mark.parametrize(
    "line", [b"", b"{}", b"[1]", b"1,2", b'{"crc":"0"}', b'{"crc":7}', b"nonsense", b"\xff"]
)
def test_foreign_lines_are_left_to_the_slow_way(tmp_path, line):
    good = lines_of(tmp_path, record())
    assert quick_records([line], UNCHECKED) == [None]
    assert quick_records([*good, line], UNCHECKED)[1] is None


def test_lines_that_only_together_are_json_are_none(tmp_path):
    good = lines_of(tmp_path, record())[0]
    assert quick_records([b"[" + good, good + b"]", good + b"," + good], UNCHECKED) == [None] * 3


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=200)
@given(place=st.floats(0, 0.999), mask=st.integers(1, 255))
def test_of_a_damaged_line_both_ways_say_the_same(tmp_path_factory, place, mask):
    folder = tmp_path_factory.mktemp("records")
    line = bytearray(lines_of(folder, record(0, **FULL))[0])
    line[int(place * len(line))] ^= mask
    (quick,) = quick_records([bytes(line)], UNCHECKED)
    (folder / "episodes.jsonl").write_bytes(bytes(line) + b"\n")
    slow = next(RecordFile(folder).scan())[1]
    if quick is not None:
        assert quick == slow
    else:
        assert isinstance(slow, RecordError)


def test_damage_far_behind_the_first_lines_is_found(tmp_path):
    file = RecordFile(tmp_path)
    file.replace([record(number) for number in range(2 * AT_ONCE + 5)])
    text = file.path.read_bytes()
    assert [it["seed"] for it in file.read()] == list(range(2 * AT_ONCE + 5))
    wrong = text.replace(b'"task_id":"task-300"', b'"task_id":"task-301"')
    file.path.write_bytes(wrong)
    with pytest.raises(RecordError, match="line 301: the checksum"):
        file.read()
    file.path.write_bytes(text[: -len(text.split(b"\n")[-2]) - 1] + json.dumps({"a": 1}).encode() + b"\n")
    with pytest.raises(RecordError, match=f"line {2 * AT_ONCE + 5}: not an episode record"):
        file.read()


@pytest.mark.parametrize("enabled", [True, False])
def test_the_collector_is_as_it_was_afterwards(enabled):
    was = gc.isenabled()
    (gc.enable if enabled else gc.disable)()
    try:
        with without_collecting():
            assert not gc.isenabled()
        assert gc.isenabled() is enabled
    finally:
        (gc.enable if was else gc.disable)()
