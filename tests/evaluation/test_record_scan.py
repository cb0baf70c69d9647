from __future__ import annotations

from test_records import record

from adhoc.core.errors import RecordError
from adhoc.evaluation.records import RecordFile


def test_every_line_is_told_with_its_record_or_what_is_wrong(tmp_path):
    file = RecordFile(tmp_path)
    for number in range(4):
        file.append(record(number))
    lines = file.path.read_bytes().split(b"\n")
    lines[1] = lines[1].replace(b"task-1", b"task-9")
    lines[2] = b"nonsense"
    file.path.write_bytes(b"\n".join(lines)[:-3])
    found = dict(file.scan())
    assert found[1] == record(0)
    for line, told in ((2, "the checksum"), (3, "not a JSON record"), (4, "the last line is incomplete")):
        assert isinstance(found[line], RecordError)
        assert f"episodes.jsonl, line {line}: {told}" in str(found[line])
    assert len(found) == 4


def test_what_read_returns_is_what_scan_tells(tmp_path):
    file = RecordFile(tmp_path)
    assert list(file.scan()) == []
    for number in range(3):
        file.append(record(number, run="a" * number))
    assert [it for _, it in file.scan()] == file.read()


def test_the_run_decides_no_checksum(tmp_path):
    checksums = set()
    for run in ("a", "b"):
        RecordFile(tmp_path / run).append(record(run=run))
        checksums.add((tmp_path / run / "episodes.jsonl").read_text().rpartition('"crc"')[2])
    assert len(checksums) == 1
