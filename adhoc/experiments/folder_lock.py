"""One writer at a time: a lock on a run folder that the kernel gives back when its holder is gone."""

from __future__ import annotations

import errno
import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from adhoc.core.errors import RecordError

LOCK_NAME = "run.lock"


@contextmanager
def locked(folder: str | Path) -> Iterator[None]:
    """Hold a run folder, which must exist; nothing is left to clean up after a kill.

    The lock file stays where it is and says which process holds, or held, the lock. Where the system or the
    file system knows no such locks, a warning says so and nothing is locked.

    Raises:
        RecordError: Another process holds the folder.
    """
    path = Path(folder) / LOCK_NAME
    with open(path, "a+", encoding="utf-8") as file:
        if not _lock(file.fileno(), path):
            file.seek(0)
            holder = file.read().strip() or "another process"
            raise RecordError(
                f"{folder}: a run ({holder}) is writing to this folder; wait for its end, or name another "
                "folder (out=...)"
            )
        file.truncate(0)
        file.write(f"process {os.getpid()} on {os.uname().nodename}\n" if hasattr(os, "uname") else "\n")
        file.flush()
        yield


def _lock(descriptor: int, path: Path) -> bool:
    """Whether nobody else has it."""
    if sys.platform == "win32":
        return True
    import fcntl

    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        if error.errno not in (errno.ENOLCK, errno.ENOTSUP, errno.ENOSYS):
            raise
        warnings.warn(
            f"{path}: this file system has no locks ({error.strerror}): take care that only one run at a "
            "time writes to the folder",
            stacklevel=4,
        )
    return True
