"""Starting and ending worker processes."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import get_context, resource_tracker
from multiprocessing.context import SpawnProcess

from adhoc.experiments.workers.comparison import MakeComparison
from adhoc.experiments.workers.worker import work

LEAVING_S = 10.0
"""Seconds that a process is given to end before it is killed."""


class Worker:
    """One worker process, as its parent sees it. It dies with the parent.

    Args:
        number: Tells it from all others of the run.
        make: What it runs, see `MakeComparison`.
    """

    def __init__(self, number: int, make: MakeComparison) -> None:
        context = get_context("spawn")
        self.number = number
        self.connection, theirs = context.Pipe()
        self._sending = threading.Lock()
        self._process: SpawnProcess = context.Process(
            target=work, args=(theirs, make), name=f"adhoc-worker-{number}", daemon=True
        )
        with _without_interrupts():
            self._process.start()
        theirs.close()

    def answer(self, number: int, answer: object) -> None:
        """Answer a question; no use if the worker is dead. Any thread may."""
        with self._sending:
            if self.connection.closed:
                return
            try:
                self.connection.send((number, answer))
            except (BrokenPipeError, ConnectionResetError):
                return  # it died meanwhile, which `connection` tells its reader

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
        with self._sending:
            self.connection.close()

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
