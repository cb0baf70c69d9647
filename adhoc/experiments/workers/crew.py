"""Starting and ending worker processes on this machine."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import get_context, resource_tracker
from multiprocessing.context import SpawnProcess

from adhoc.experiments.comparison import MakeComparisons
from adhoc.experiments.workers.wire import Wire
from adhoc.experiments.workers.worker import work

LEAVING_S = 10.0
"""Seconds that a process is given to end before it is killed."""


class SpawnedWorker:
    """A `Worker` that is a process of this machine. It dies with the parent.

    Args:
        number: Tells it from all others of the run.
        make: What it runs, see `MakeComparisons`.
    """

    def __init__(self, number: int, make: MakeComparisons) -> None:
        context = get_context("spawn")
        self.number = number
        mine, theirs = context.Pipe()
        self.wire: Wire | None = Wire(mine)
        self._process: SpawnProcess = context.Process(
            target=work, args=(theirs, make), name=f"adhoc-worker-{number}", daemon=True
        )
        with _without_interrupts():
            self._process.start()
        theirs.close()

    def has_ended(self) -> bool:
        """See `Worker`: its wire is there from the beginning, and tells."""
        return False

    def is_killed(self) -> bool:
        """Whether the process that hung up was killed by a signal. Waits for its end."""
        code = self._end_of_process()
        return code < 0

    @property
    def death(self) -> str:
        """How it ended, for error texts."""
        code = self._end_of_process()
        return f"signal {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"

    def stop(self) -> None:
        """End it without waiting for what it does."""
        self._process.terminate()
        self._end_of_process()
        if self.wire is not None:
            self.wire.close()

    def _end_of_process(self) -> int:
        self._process.join(LEAVING_S)
        if self._process.exitcode is None:
            self._process.kill()
            self._process.join()
        code = self._process.exitcode
        return 0 if code is None else code


@contextmanager
def _without_interrupts() -> Iterator[None]:
    """What is started inside never gets Ctrl-C: the parent decides what becomes of its workers."""
    resource_tracker.ensure_running()  # else it would be started inside, and lift the block
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
