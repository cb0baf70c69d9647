"""Finding a call's answer among 100,000 without holding them in memory."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from adhoc.core.errors import LedgerError
from adhoc.llm.ledger.entry import Answer, Header
from adhoc.llm.ledger.reader import LedgerFile, Line, ledger_files, line_at

_HEAD = re.compile(rb'\{"entry":"answer","key":"([0-9a-f]{64})"')


class Ledger:
    """Where the answer to every call is; the answers themselves stay on the disk until they are asked for.

    The first answer to a key counts, files in the order in which they were begun. Made by `open_ledger`.
    """

    def __init__(self, files: Iterable[LedgerFile]) -> None:
        self.headers: list[Header] = []
        """Of all files that were there."""
        self._paths: list[Path] = []
        self._places: dict[bytes, tuple[int, int]] = {}
        """By key: the file's number and where the line begins."""
        for file in files:
            self.headers.append(file.header)
            self._paths.append(file.path)
            for line in file.lines():
                key = _answered_key(line)
                if key is not None:
                    self._places.setdefault(key, (len(self._paths) - 1, line.offset))

    def __len__(self) -> int:
        """How many calls have an answer."""
        return len(self._places)

    def find(self, key: str) -> Answer | None:
        """The answer to the call of this key, or None. Raises LedgerError for damage."""
        place = self._places.get(bytes.fromhex(key))
        if place is None:
            return None
        path = self._paths[place[0]]
        entry = line_at(path, place[1]).entry()
        if not isinstance(entry, Answer) or entry.key != key:
            raise LedgerError(f"{path}: was changed by somebody else while it was read")
        return entry

    def add(self, key: str, path: Path, offset: int) -> None:
        """An answer was written to `path`, where its line begins at `offset`."""
        if not self._paths or self._paths[-1] != path:
            self._paths.append(path)
        self._places.setdefault(bytes.fromhex(key), (len(self._paths) - 1, offset))


def open_ledger(path: str | Path) -> Ledger:
    """The ledger in a folder, or in a single file; an empty one if the folder is not there yet.

    Raises LedgerError, naming file and line, for a file that is damaged, foreign or of another version;
    an incomplete last line of a file is left out with a TornLedgerWarning.
    """
    return Ledger(ledger_files(path))


def _answered_key(line: Line) -> bytes | None:
    """Its checksum vouches for the line, so that it need not be decoded to be found."""
    head = _HEAD.match(line.data)
    return None if head is None else bytes.fromhex(head[1].decode())
