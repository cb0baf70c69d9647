from __future__ import annotations

import os
import subprocess
import sys

import pytest

from adhoc.core.errors import RecordError
from adhoc.experiments.folder_lock import LOCK_NAME, locked

HOLD = """
import sys
from adhoc.experiments.folder_lock import locked
with locked(sys.argv[1]):
    print("held", flush=True)
    sys.stdin.read()
"""


def holder(folder):
    process = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "held\n"
    return process


def test_a_second_holder_is_refused_and_told_who_has_it(tmp_path):
    with holder(tmp_path) as process:
        with pytest.raises(RecordError, match=f"process {process.pid} on .* is writing to this folder"):
            locked(tmp_path).__enter__()
        process.stdin.close()
        process.wait()
    with locked(tmp_path):
        assert (tmp_path / LOCK_NAME).read_text().startswith(f"process {os.getpid()} ")


def test_a_killed_holder_leaves_nothing_locked(tmp_path):
    with holder(tmp_path) as process:
        process.kill()
        process.wait()
    with locked(tmp_path):
        pass


def test_the_lock_is_given_back_after_an_error(tmp_path):
    with pytest.raises(ZeroDivisionError), locked(tmp_path):
        raise ZeroDivisionError
    with locked(tmp_path):
        pass


def test_other_folders_are_free(tmp_path):
    (tmp_path / "other").mkdir()
    with locked(tmp_path), locked(tmp_path / "other"):
        pass


def test_a_file_system_without_locks_is_told(tmp_path, monkeypatch):
    import errno
    import fcntl

    def refuse(descriptor, operation):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "flock", refuse)
    with pytest.warns(UserWarning, match="only one run at a time"), locked(tmp_path):
        pass
