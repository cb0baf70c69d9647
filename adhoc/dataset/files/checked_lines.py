"""Compressed JSON lines with a header and a checksum in every line; equal contents give equal bytes.

The first line is the header: `format` and `version` say what the file is. Every line, the header too, is one
of `core.line_checksum`.
"""

from __future__ import annotations

import gzip
import io
import os
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from adhoc.core.errors import AssetError, DatasetError, HouseError
from adhoc.core.line_checksum import checked_line, is_intact
from adhoc.houses.house_files import Document, decode
from adhoc.houses.json_fields import Fields

COMPRESSION = 9
FIRST_ROW = 2
"""The line of the first row; the header is line 1."""


@dataclass(frozen=True)
class CheckedLines:
    """A file that was read whole: its header, and its rows, which are decoded when they are asked for."""

    path: Path
    header: Fields
    lines: Sequence[bytes]

    def where(self, index: int) -> str:
        """File and line of row `index`, for error texts."""
        return f"{self.path}, line {index + FIRST_ROW}"

    def row(self, index: int) -> Fields:
        """Row `index`, from 0, without its checksum. Raises DatasetError if it is no JSON object."""
        return _decoded(self.lines[index], self.where(index))


def write_checked(
    path: Path, kind: str, version: int, header: Mapping[str, Any], rows: Iterable[Mapping[str, Any]]
) -> None:
    """Write a header and rows of JSON values; the file is there whole or not at all."""
    first = {"format": kind, "version": version, **header}
    write_compressed(path, b"".join(checked_line(line) for line in (first, *rows)))


def read_checked(path: Path, kind: str, version: int) -> CheckedLines:
    """Read a file that `write_checked` wrote.

    Raises DatasetError, naming file and line, if it is missing, cut off, damaged, or of another kind or
    version.
    """
    lines = read_compressed(path).split(b"\n")
    header = _checked_header(lines[0], f"{path}, line 1", kind, version)
    if lines.pop():
        raise DatasetError(f"{path}, line {len(lines) + 1}: the line is cut off; the file is damaged")
    for number, line in enumerate(lines, start=1):
        if not is_intact(line):
            raise DatasetError(
                f"{path}, line {number}: the checksum ('crc') does not fit the line; the file is damaged"
            )
    return CheckedLines(path, header, lines[1:])


def write_compressed(path: Path, data: bytes) -> None:
    """Compress `data` into a file, with no time and no name in it; it is there whole or not at all."""
    packed = io.BytesIO()
    with gzip.GzipFile(filename="", mode="wb", compresslevel=COMPRESSION, fileobj=packed, mtime=0) as file:
        file.write(data)
    write_whole(path, packed.getvalue())


def write_whole(path: Path, data: bytes) -> None:
    """Write a file, making its folder; after a kill it is there whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    part.write_bytes(data)
    os.replace(part, path)


def read_compressed(path: Path) -> bytes:
    """The content of a compressed file. Raises DatasetError if it is missing, cut off or damaged."""
    try:
        with gzip.open(path, "rb") as file:
            return file.read()
    except FileNotFoundError:
        maker = "ceilings --make" if path.name.startswith("ceilings") else "make"
        raise DatasetError(f"{path}: there is no such file; `adhoc dataset {maker}` writes it") from None
    except (gzip.BadGzipFile, EOFError, zlib.error) as error:
        raise DatasetError(f"{path}: it is cut off, damaged, or not compressed by gzip: {error}") from error
    except OSError as error:
        raise DatasetError(f"{path}: cannot be read: {error.strerror or error}") from error


@contextmanager
def dataset_errors() -> Iterator[None]:
    """Turns what is wrong with JSON fields, a HouseError elsewhere, into a DatasetError."""
    try:
        yield
    except (HouseError, AssetError) as error:
        raise DatasetError(str(error)) from error


def _decoded(line: bytes, where: str) -> Fields:
    with dataset_errors():
        try:
            text = line.decode()
        except UnicodeDecodeError as error:
            raise DatasetError(f"{where}: not valid text: {error}") from error
        fields = Fields.of(decode(Document("", where, text)), where)
    return Fields({name: value for name, value in fields.value.items() if name != "crc"}, where)


def _checked_header(line: bytes, where: str, kind: str, version: int) -> Fields:
    header = _decoded(line, where)
    found = header.value.get("format")
    if found != kind:
        raise DatasetError(f"{where}: format is {found!r}; it should be {kind!r}: this is another file")
    if header.value.get("version") != version:
        raise DatasetError(
            f"{where}: version is {header.value.get('version')!r}; this release of the library reads version "
            f"{version}: make the dataset again, or use the release that it was made with"
        )
    return header
