"""A shared limit on calls at once and per minute, which gives way when a provider asks for fewer."""

from __future__ import annotations

import contextlib
import time
from collections import deque
from collections.abc import Callable, Iterator
from threading import Condition

from adhoc.core.errors import ConfigurationError

GROW_AFTER = 20
"""Answers in a row after which one more call at once is tried."""
_MINUTE = 60.0


class CallLimiter:
    """Lets so many calls go at once, and so many start in a minute; share one among all that ask a provider.

    A refusal halves the calls at once, down to one, but once only for all calls that were under way when it
    came: they were refused for the same reason. `GROW_AFTER` answers in a row give one back.

    Args:
        concurrent: The most calls at once.
        per_minute: The most calls that start within any 60 seconds; None: no limit.
        clock: Seconds that go on; tests replace it.
        sleep: How to wait for the minute to pass; tests replace it.

    Raises:
        ConfigurationError: a limit is below 1.
    """

    def __init__(
        self,
        concurrent: int = 8,
        per_minute: int | None = None,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        if concurrent < 1 or (per_minute is not None and per_minute < 1):
            raise ConfigurationError(
                f"CallLimiter: concurrent={concurrent} and per_minute={per_minute} must be at least 1"
            )
        self._most, self._limit = concurrent, concurrent
        self._starts: deque[float] | None = None if per_minute is None else deque(maxlen=per_minute)
        self._clock, self._sleep = clock, sleep
        self._changed = Condition()
        self._under_way = 0
        self._refusals = 0
        self._answers_in_a_row = 0
        self._not_before = clock()

    @property
    def concurrent(self) -> int:
        """How many calls may go at once now."""
        return self._limit

    @contextlib.contextmanager
    def slot(self) -> Iterator[int]:
        """Wait until a call may start, and keep its place; the value goes to `refused`."""
        with self._changed:
            self._changed.wait_for(lambda: self._under_way < self._limit)
            self._under_way += 1
            delay, refusals = self._reserve(), self._refusals
        try:
            if delay > 0.0:
                self._sleep(delay)
            yield refusals
        finally:
            with self._changed:
                self._under_way -= 1
                self._changed.notify()

    def refused(self, slot: int, pause: float = 0.0) -> None:
        """The provider asked for fewer calls; no other call starts for `pause` seconds."""
        with self._changed:
            self._answers_in_a_row = 0
            self._not_before = max(self._not_before, self._clock() + pause)
            if slot == self._refusals:
                self._refusals += 1
                self._limit = max(1, self._limit // 2)

    def answered(self) -> None:
        """The provider answered a call."""
        with self._changed:
            self._answers_in_a_row += 1
            if self._answers_in_a_row >= GROW_AFTER and self._limit < self._most:
                self._answers_in_a_row = 0
                self._limit += 1
                self._changed.notify()

    def _reserve(self) -> float:
        """Take the next start that the minute and the pause allow; the seconds until then."""
        now = self._clock()
        start = max(now, self._not_before)
        if self._starts is not None:
            if len(self._starts) == self._starts.maxlen:
                start = max(start, self._starts[0] + _MINUTE)
            self._starts.append(start)
        return start - now
