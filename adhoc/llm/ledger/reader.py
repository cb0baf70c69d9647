"""Reading the files of a ledger: all that is intact, and a clear word on what is not."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from adhoc.core.errors import LedgerError
from adhoc.core.line_checksum import is_intact
from adhoc.llm.ledger.entry import FORMAT, Entry, Header
from adhoc.llm.ledger.line import DAMAGED, decoded, decoded_header

SUFFIX = ".jsonl"
_KIND = re.compile(rb'\{"entry":"(\w+)"')
_BEGINNING = f'{{"entry":"header","format":"{FORMAT}","version":'.encode()


class TornLedgerWarning(UserWarning):
    """The last line of a ledger file is incomplete: its process ended while writing it."""


@dataclass(frozen=True)
class Line:
    """One intact line, without its line break."""

    path: Path
    number: int
    """From 1; the header is line 1."""
    offset: int
    """Where it begins, in bytes."""
    data: bytes

    @property
    def where(self) -> str:
        """File and line, for error texts."""
        return f"{self.path}, line {self.number}"

    @property
    def kind(self) -> str:
        """The kind of its entry, without decoding the rest."""
        name = _KIND.match(self.data)
        return "" if name is None else name[1].decode()

    def entry(self) -> Entry:
        """What it says. Raises LedgerError if that is no entry."""
        return decoded(self.data, self.where)


@dataclass(frozen=True)
class LedgerFile:
    """A file of a ledger, and its header."""

    path: Path
    header: Header

    def lines(self) -> Iterator[Line]:
        """All lines after the header, in order; each is read when it is asked for.

        An incomplete last line is left out, with a TornLedgerWarning. Raises LedgerError for other damage.
        """
        with open(self.path, "rb") as file:
            for line in _intact_lines(file, self.path):
                if line.number > 1:
                    yield line

    def entries(self) -> Iterator[tuple[Line, Entry]]:
        """All entries after the header, and their lines. Raises LedgerError, naming file, line and field."""
        for line in self.lines():
            yield line, line.entry()


def ledger_files(path: str | Path) -> list[LedgerFile]:
    """The files of a ledger, in the order in which they were begun: of a folder, those that end with
    `.jsonl`, or a single file. None if the folder is not there yet.

    A file without even a complete header, whose process ended right after creating it, is left out with a
    TornLedgerWarning. Raises LedgerError for foreign, damaged and too new or too old files.
    """
    root = Path(path)
    paths = [root] if root.is_file() else sorted(root.glob(f"*{SUFFIX}"))
    if root.exists() and not root.is_file() and not root.is_dir():
        raise LedgerError(f"{root}: is no file and no folder")
    found = [LedgerFile(it, header) for it in paths if (header := _header(it)) is not None]
    return sorted(found, key=lambda file: (file.header.time, file.path.name))


def existing_files(path: str | Path) -> list[LedgerFile]:
    """As `ledger_files`, but there must be some. Raises LedgerError if there are none."""
    files = ledger_files(path)
    if not files:
        trouble = "holds no ledger" if Path(path).exists() else "there is no such file or folder"
        raise LedgerError(f"{path}: {trouble}; a run writes one to OUT/ledger, or where ledger.path=... says")
    return files


def line_at(path: Path, offset: int) -> Line:
    """The line that begins at `offset`. Raises LedgerError if the file is no longer as it was."""
    with open(path, "rb") as file:
        file.seek(offset)
        return Line(path, 0, offset, file.readline().rstrip(b"\n"))


def _header(path: Path) -> Header | None:
    with open(path, "rb") as file:
        line = next(_intact_lines(file, path), None)
    return None if line is None else decoded_header(line.data, line.where)


def _intact_lines(file: BinaryIO, path: Path) -> Iterator[Line]:
    offset = number = 0
    for data in file:
        number += 1
        line = Line(path, number, offset, data.rstrip(b"\n"))
        offset += len(data)
        if number == 1:
            _check_beginning(line, data.endswith(b"\n"))
        if not is_intact(line.data):
            _judge_broken(line, data.endswith(b"\n"))
            return
        yield line
    if number == 0:
        _warn(f"{path}: is empty: its process ended while it was begun")


def _check_beginning(line: Line, is_whole: bool) -> None:
    """A foreign file is told before its damage is; the header may be incomplete if it is all there is."""
    if is_whole or not (_BEGINNING.startswith(line.data) or line.data.startswith(_BEGINNING)):
        decoded_header(line.data, line.where)


def _judge_broken(line: Line, is_whole: bool) -> None:
    """Only the last line may be broken, and only by its end missing."""
    if is_whole or is_intact(line.data[:-1]):
        raise LedgerError(f"{line.where}: {DAMAGED}")
    _warn(f"{line.where}: incomplete last line left out; a call that it answered counts as not answered")


def _warn(text: str) -> None:
    warnings.warn(text, TornLedgerWarning, stacklevel=4)
