"""Threads that wait for a language model on behalf of workers."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from queue import Empty, SimpleQueue

Call = Callable[[], None]


class CallThreads:
    """Makes calls in up to `count` threads.

    Unlike those of `concurrent.futures` the threads do not keep the process from ending: a call that hangs
    must not hang the end of a run.
    """

    def __init__(self, count: int) -> None:
        self._count = count
        self._calls: SimpleQueue[Call | None] = SimpleQueue()
        self._threads: list[threading.Thread] = []
        self._idle = threading.Semaphore(0)
        self.failures: SimpleQueue[BaseException] = SimpleQueue()
        """What calls raised."""

    def make(self, call: Call) -> None:
        """Make a call as soon as a thread is free."""
        self._calls.put(call)
        if not self._idle.acquire(blocking=False) and len(self._threads) < self._count:
            thread = threading.Thread(target=self._live, name="model-calls", daemon=True)
            self._threads.append(thread)
            thread.start()

    def close(self, patience: float) -> None:
        """Make no further call, and wait up to `patience` seconds for those that were begun."""
        try:
            while True:
                self._calls.get_nowait()
        except Empty:
            pass
        for _ in self._threads:
            self._calls.put(None)
        end = time.monotonic() + patience
        for thread in self._threads:
            thread.join(max(0.0, end - time.monotonic()))

    def _live(self) -> None:
        while True:
            call = self._calls.get()
            if call is None:
                return
            try:
                call()
            except BaseException as error:  # noqa: BLE001  (raised again by the thread that waits)
                self.failures.put(error)
            self._idle.release()
