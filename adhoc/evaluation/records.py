"""Episode records: one checksummed JSON line an episode, the truth that every table is derived from."""

from __future__ import annotations

import json
import os
import warnings
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import islice
from operator import itemgetter
from pathlib import Path
from typing import Any

from adhoc.core.errors import RecordError
from adhoc.core.whole_file import write_whole
from adhoc.evaluation.record_lines import AT_ONCE, quick_records, without_collecting

FILE_NAME = "episodes.jsonl"
UNFINISHED_NAME = "unfinished.jsonl"
"""Records of episodes that a run's budget cut short, in the form of the others. They are no results."""
UNCHECKED = ("wall_s", "llm.replayed", "run")
"""Fields that the checksum leaves out, so that equal episodes have equal checksums: wall-clock times, how
many answers came from a ledger, of which resumed and replayed runs have more, and the id of the run."""

Record = Mapping[str, Any]

REQUIRED: Mapping[str, type | tuple[type, ...]] = {
    "episode_id": str,
    "task_id": str,
    "house_id": str,
    "rooms": int,
    "difficulty": str,
    "teammates": int,
    "misplaced": int,
    "team": str,
    "policy": str,
    "join_step": (int, type(None)),
    "seed": int,
    "model": (str, type(None)),
    "success": bool,
    "replaced": int,
    "partial_success": (int, float),
    "temporal_steps": int,
    "action_steps": int,
    "reference_temporal_steps": (int, type(None)),
    "efficiency": (int, float, type(None)),
    "llm": dict,
    "wall_s": (int, float),
    "library_version": str,
    "config_hash": str,
}
"""The fields that every record has, with their types; records hold more (see `experiments.run`)."""


class TornRecordWarning(UserWarning):
    """The last line of a record file is incomplete: the run was killed while writing it."""


class RecordFile:
    """The `episodes.jsonl` of one run folder: read whole, appended one record at a time.

    One process writes to a folder at a time. A record is on the disk when `append` returns.
    """

    def __init__(self, folder: str | Path, name: str = FILE_NAME) -> None:
        self.path = Path(folder) / name

    def read(self) -> list[Record]:
        """All records in the order of writing; none if there is no file yet.

        An incomplete last line is left out with a TornRecordWarning. Raises RecordError, naming file and
        line, for any other damage and for an episode that is there twice.
        """
        if not self.path.exists():
            return []
        records: list[Record] = []
        with open(self.path, "rb") as file, without_collecting():
            while lines := list(islice(file, AT_ONCE)):
                torn = not lines[-1].endswith(b"\n")
                records += self._decoded([line[:-1] for line in lines[: len(lines) - torn]], len(records))
                if torn:
                    self._warn_of_torn(len(records) + 1)
        self._check_unique(records)
        return records

    def _decoded(self, lines: Sequence[bytes], before: int) -> Iterator[Record]:
        """The records of lines without their ends, of which so many were before. Raises RecordError."""
        quick = quick_records(lines, UNCHECKED)
        for number, (line, record) in enumerate(zip(lines, quick), start=before + 1):
            if record is not None and _has_seen_fields(record):
                yield record
            else:
                yield _decode(line, self.path, number)

    def _warn_of_torn(self, number: int) -> None:
        warnings.warn(
            f"{self.path}, line {number}: incomplete last record left out; its episode counts as not run",
            TornRecordWarning,
            stacklevel=3,
        )

    def scan(self) -> Iterator[tuple[int, Record | RecordError]]:
        """Every line's number, from 1, with its record or what is wrong with it; none if there is no file.

        An incomplete last line is wrong, too. Raises nothing for damage: it is for checking, not for use.
        """
        if not self.path.exists():
            return
        with open(self.path, "rb") as file:
            for number, line in enumerate(file, start=1):
                if not line.endswith(b"\n"):
                    yield number, RecordError(f"{self.path}, line {number}: the last line is incomplete")
                    continue
                try:
                    yield number, _decode(line[:-1], self.path, number)
                except RecordError as error:
                    yield number, error

    def append(self, record: Record) -> None:
        """Write one record behind the last complete one. Raises RecordError if a field is missing, or the
        file cannot be written."""
        line = _encode(record, self.path)
        with writing(self.path), open(self.path, "ab+") as file:
            file.truncate(_complete_bytes(self.path))
            file.write(line)
            file.flush()
            os.fsync(file.fileno())

    def replace(self, records: Sequence[Record]) -> None:
        """Write these records in place of all that are there; no record is no file. After a crash the file
        is the old one or the new one. Raises RecordError if a field is missing, or the file cannot be
        written."""
        lines = b"".join(_encode(record, self.path) for record in records)
        if not records:
            self.path.unlink(missing_ok=True)
            return
        with writing(self.path):
            write_whole(self.path, lines)

    def _check_unique(self, records: list[Record]) -> None:
        first_line: dict[str, int] = {}
        for number, record in enumerate(records, start=1):
            earlier = first_line.setdefault(record["episode_id"], number)
            if earlier != number:
                raise RecordError(
                    f"{self.path}, line {number}: episode {record['episode_id']!r} is there twice, first in "
                    f"line {earlier}; two runs wrote to one folder"
                )


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Write a file of a run folder; its folder is made if it is missing. Raises RecordError, naming the file,
    if it cannot be written, for example because the disk is full."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield
    except OSError as error:
        raise RecordError(f"{path}: cannot be written: {error.strerror or error}") from error


def checked_part(record: Record) -> dict[str, Any]:
    """A record without the `UNCHECKED` fields: equal for equal episodes."""
    return {
        field: _checked_value(value, f"{field}.") for field, value in record.items() if field not in UNCHECKED
    }


def _checked_value(value: Any, prefix: str) -> Any:
    if not isinstance(value, Mapping):
        return value
    return {name: inner for name, inner in value.items() if prefix + name not in UNCHECKED}


def _encode(record: Record, path: Path) -> bytes:
    _check_fields(record, f"{path}: new record")
    try:
        text = _canonical({**record, "crc": _checksum(record)})
    except ValueError as error:
        raise RecordError(f"{path}: record of {record['episode_id']!r} is not JSON: {error}") from error
    return text.encode() + b"\n"


def _decode(line: bytes, path: Path, number: int) -> Record:
    where = f"{path}, line {number}"
    try:
        record = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise RecordError(f"{where}: not a JSON record ({error}); the file is damaged") from error
    if not isinstance(record, dict) or "crc" not in record:
        raise RecordError(f"{where}: not an episode record: it has no checksum ('crc')")
    crc = record.pop("crc")
    if not _is_intact(record, crc, line):
        raise RecordError(f"{where}: the checksum ('crc') does not fit the record; the file is damaged")
    _check_fields(record, where)
    return record


def _check_fields(record: Record, where: str) -> None:
    for field, kind in REQUIRED.items():
        if field not in record:
            raise RecordError(f"{where}: field {field!r} is missing")
        value = record[field]
        kinds = kind if isinstance(kind, tuple) else (kind,)
        if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
            raise RecordError(f"{where}: field {field!r} cannot be {value!r}")
    _SEEN_FIELDS.add(tuple(map(type, _required_values(record))))


def _has_seen_fields(record: Record) -> bool:
    """Whether all fields are there and of types that were found right before."""
    try:
        return tuple(map(type, _required_values(record))) in _SEEN_FIELDS
    except KeyError:
        return False


_required_values = itemgetter(*REQUIRED)
_SEEN_FIELDS: set[tuple[type, ...]] = set()
"""There are few combinations of types, and many records."""


def _is_intact(record: Record, crc: object, line: bytes) -> bool:
    try:
        return crc == _checksum(record) and _canonical({**record, "crc": crc}).encode() == line
    except ValueError:
        return False


def _checksum(record: Record) -> str:
    return f"{zlib.crc32(_canonical(checked_part(record)).encode()):08x}"


def _canonical(record: Record) -> str:
    return json.dumps(record, separators=(",", ":"), allow_nan=False)


def _complete_bytes(path: Path) -> int:
    """The length of the file up to the end of its last complete line."""
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(0, size - 1))
        if file.read(1) == b"\n":
            return size
        file.seek(0)
        return file.read().rfind(b"\n") + 1
