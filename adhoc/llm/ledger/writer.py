"""Writing a ledger: one file for each writer, and every entry in it before anything depends on it."""

from __future__ import annotations

import contextlib
import os
import re
import socket
from collections.abc import Callable, Iterable
from pathlib import Path
from threading import Lock

from adhoc.core.errors import LedgerError
from adhoc.llm.ledger.disk_sync import DiskSync, sync_folder
from adhoc.llm.ledger.entry import Entry, Header, Text
from adhoc.llm.ledger.line import encoded
from adhoc.llm.ledger.reader import SUFFIX

MOST_FILES = 100_000


class LedgerWriter:
    """Appends to a new file of its own, named after host, process and a number; no other file is touched.

    The file is begun with the first entry. Several threads may write; a process that was forked begins a
    file of its own.

    Args:
        folder: Where the file goes; it is made if it is missing.
        header: Makes the first line when the file is begun.
        wait_for_disk: See `append`.
    """

    def __init__(self, folder: str | Path, header: Callable[[], Header], wait_for_disk: bool = False) -> None:
        self._folder, self._header, self._waits_for_disk = Path(folder), header, wait_for_disk
        self._lock = Lock()
        self._process = 0
        self._path = Path()
        self._disk = DiskSync(self._path)
        self._size = 0
        self._texts: set[str] = set()
        """The hashes of the texts that the file has."""

    def append(self, entry: Entry, texts: Iterable[Text] = ()) -> tuple[Path, int]:
        """Write an entry, and before it those of its texts that the file has not yet.

        When this returns they are in the file, whatever becomes of the process, and on their way to the
        disk (see `DiskSync`); with `wait_for_disk` they have arrived, which takes some milliseconds.

        Returns:
            The file, and where the entry begins.

        Raises:
            LedgerError: they could not be written; then nothing of them is in the file.
        """
        line = encoded(entry)
        with self._lock:
            if self._process != os.getpid():
                self._begin()
            new = {text.sha256: text for text in texts if text.sha256 not in self._texts}
            header = [] if self._size else [encoded(self._header())]
            before = b"".join([*header, *map(encoded, new.values())])
            offset = self._size + len(before)
            self._write(before + line)
            self._texts |= new.keys()
            self._disk.soon()
            if self._waits_for_disk:
                self._disk.wait()
            return self._path, offset

    def _begin(self) -> None:
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            self._path = _created(self._folder)
            sync_folder(self._folder)
        except OSError as error:
            raise LedgerError(f"{self._folder}: no ledger can be begun: {error.strerror or error}") from error
        self._disk = DiskSync(self._path)
        self._process, self._size, self._texts = os.getpid(), 0, set()

    def _write(self, data: bytes) -> None:
        try:
            descriptor = os.open(self._path, os.O_WRONLY | os.O_APPEND)
            try:
                self._append_whole(descriptor, data)
            finally:
                os.close(descriptor)
        except OSError as error:
            raise LedgerError(f"{self._path}: cannot be written: {error.strerror or error}") from error
        self._size += len(data)

    def _append_whole(self, descriptor: int, data: bytes) -> None:
        """All of `data`, or nothing of it; where even its removal fails, the size tells at the next entry."""
        if os.fstat(descriptor).st_size != self._size:
            raise LedgerError(f"{self._path}: was changed by somebody else while it was written")
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[os.write(descriptor, rest) :]
        except OSError:
            with contextlib.suppress(OSError):
                os.ftruncate(descriptor, self._size)
            raise


def _created(folder: Path) -> Path:
    host = re.sub(r"[^A-Za-z0-9]+", "-", socket.gethostname())[:40] or "host"
    for number in range(MOST_FILES):
        path = folder / f"{host}-{os.getpid()}-{number}{SUFFIX}"
        try:
            path.open("xb").close()
        except FileExistsError:
            continue
        return path
    raise LedgerError(f"{folder}: holds {MOST_FILES} files of one process; use another folder")
