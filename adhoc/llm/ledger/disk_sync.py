"""Getting a growing file to the disk without making anybody wait for the disk."""

from __future__ import annotations

import os
from pathlib import Path
from threading import Condition, Thread

from adhoc.core.errors import LedgerError


class DiskSync:
    """Syncs a file in a thread of its own, over and over while it grows; the thread ends when all is synced.

    What was written to a file outlives its process in any case, however that ends. The disk matters when the
    machine itself dies: then at most what was written during the last sync or two is lost.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._state = Condition()
        self._is_dirty = self._is_running = False
        self._trouble: OSError | None = None

    def soon(self) -> None:
        """The file has grown. Raises LedgerError if an earlier sync failed."""
        with self._state:
            self._raise_trouble()
            self._is_dirty = True
            if not self._is_running:
                self._is_running = True
                Thread(target=self._sync_while_dirty, name="ledger-sync").start()

    def wait(self) -> None:
        """Wait until everything is on the disk. Raises LedgerError if a sync failed."""
        with self._state:
            self._state.wait_for(lambda: not self._is_running)
            self._raise_trouble()

    def _sync_while_dirty(self) -> None:
        while self._take():
            try:
                _sync(self._path)
            except OSError as error:
                with self._state:
                    self._trouble = error

    def _take(self) -> bool:
        """Whether there is something to sync; if not, whoever grows the file next starts another thread."""
        with self._state:
            is_dirty, self._is_dirty = self._is_dirty and self._trouble is None, False
            if not is_dirty:
                self._is_running = False
                self._state.notify_all()
            return is_dirty

    def _raise_trouble(self) -> None:
        if self._trouble is not None:
            told = self._trouble.strerror or self._trouble
            raise LedgerError(f"{self._path}: did not reach the disk: {told}") from self._trouble


def sync_folder(folder: Path) -> None:
    """Get the names of a folder's files to the disk. Raises OSError."""
    _sync(folder)


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
