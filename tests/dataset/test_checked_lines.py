from __future__ import annotations

import gzip
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adhoc.core.errors import DatasetError
from adhoc.dataset.files.checked_lines import read_checked, write_checked, write_compressed

HEADER = {"name": "tiny"}
ROWS = [{"id": "a", "x": 1.5}, {"id": "b", "x": [2, 3]}]


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "rows.jsonl.gz"
    write_checked(path, "fruit", 3, HEADER, ROWS)
    return path


def read(path):
    lines = read_checked(path, "fruit", 3)
    return lines.header.value, [lines.row(index).value for index in range(len(lines.lines))]


def test_what_was_written_is_read(path):
    assert read(path) == ({"format": "fruit", "version": 3, **HEADER}, ROWS)


def test_every_line_carries_the_checksum_of_what_is_before_it(path):
    lines = gzip.decompress(path.read_bytes()).splitlines()
    assert lines[1] == b'{"id":"a","x":1.5,"crc":"059d02db"}'
    assert [set(json.loads(line)) >= {"crc"} for line in lines] == [True] * 3


def test_equal_contents_give_equal_bytes_under_any_name(path, tmp_path):
    other = tmp_path / "folder" / "other-name.gz"
    write_checked(other, "fruit", 3, HEADER, ROWS)
    assert other.read_bytes() == path.read_bytes()
    assert path.read_bytes()[4:8] == b"\0\0\0\0"
    assert b"rows" not in path.read_bytes()


def test_a_write_leaves_nothing_else_behind(path):
    assert [it.name for it in path.parent.iterdir()] == [path.name]


def test_every_flipped_bit_of_the_file_is_an_error_or_changes_nothing(path):
    intact, whole = path.read_bytes(), read(path)
    found = []
    for place in range(len(intact)):
        for bit in range(8):
            path.write_bytes(_flipped(intact, place, bit))
            found.append(_told(path))
    harmless = [it for it in found if it == whole]
    errors = [it for it in found if isinstance(it, str)]
    assert len(harmless) + len(errors) == 8 * len(intact)
    assert all(str(path) in text for text in errors)
    assert len(harmless) < 8 * 10, "only the header of gzip says things that do not matter"


def test_every_flipped_bit_of_the_content_is_an_error(path):
    content = gzip.decompress(path.read_bytes())
    for place in range(len(content)):
        for bit in range(8):
            write_compressed(path, _flipped(content, place, bit))
            with pytest.raises(DatasetError, match=r"rows\.jsonl\.gz, line \d"):
                read(path)


def test_a_file_cut_off_anywhere_is_an_error(path):
    intact = path.read_bytes()
    for length in range(len(intact)):
        path.write_bytes(intact[:length])
        with pytest.raises(DatasetError, match="rows"):
            read(path)


def test_a_content_cut_off_inside_a_line_is_an_error(path):
    content = gzip.decompress(path.read_bytes())
    ends = [place + 1 for place, byte in enumerate(content) if byte == ord("\n")]
    for length in range(1, len(content)):
        write_compressed(path, content[:length])
        if length in ends:
            assert read(path)[1] == ROWS[: ends.index(length)]
        else:
            with pytest.raises(DatasetError, match=r"line \d"):
                read(path)


@given(content=st.binary(max_size=200))
def test_foreign_files_are_errors(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("foreign") / "rows.jsonl.gz"
    path.write_bytes(content)
    with pytest.raises(DatasetError, match=r"rows\.jsonl\.gz"):
        read(path)
    write_compressed(path, content)
    with pytest.raises(DatasetError, match=r"rows\.jsonl\.gz, line 1"):
        read(path)


def test_another_version_is_told_before_anything_else(path):
    write_checked(path, "fruit", 4, HEADER, ROWS)
    with pytest.raises(DatasetError, match=r"line 1: version is 4; this release .* reads version 3"):
        read(path)


def test_another_kind_is_told(path):
    write_checked(path, "fish", 3, HEADER, ROWS)
    with pytest.raises(DatasetError, match="line 1: format is 'fish'; it should be 'fruit'"):
        read(path)


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(DatasetError, match=r"none\.gz: there is no such file"):
        read(tmp_path / "none.gz")


def _told(path):
    """What is read, or the text of the error."""
    try:
        return read(path)
    except DatasetError as error:
        return str(error)


def _flipped(data, place, bit):
    return data[:place] + bytes([data[place] ^ (1 << bit)]) + data[place + 1 :]
