"""Asking again where a language model is busy."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace

from adhoc.core.errors import ConfigurationError, ModelBusy
from adhoc.llm.limiting import CallLimiter
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Wrapper

_MOST_DOUBLINGS = 60
"""Beyond any wait; numbers stay small."""


class RetryingModel(Wrapper):
    """Asks `inner` again after `ModelBusy` (rate limit, server fault, time-out), a bounded number of times.

    It waits as long as the provider says (`ModelBusy.retry_after`), else twice as long before each attempt.
    Any other error passes at once: a missing key stays missing. Put it inside of ledger and budget wrappers,
    so that one answer counts once.

    Args:
        inner: The model that is asked.
        attempts: How often in all, at least 1.
        wait: Seconds before the second attempt; doubled before each further one.
        max_wait: The longest single wait in seconds. A provider that asks for a longer one is given up.
        total_wait: The longest wait for one answer in seconds, all attempts together.
        limiter: The limit on calls at once and per minute, shared by all that ask the same provider.
        clock: Seconds that go on; tests replace it.
        sleep: How to wait; tests replace it.

    Raises:
        ConfigurationError: a number is out of range.
    """

    def __init__(
        self,
        inner: LanguageModel,
        attempts: int = 8,
        wait: float = 2.0,
        max_wait: float = 60.0,
        total_wait: float = 300.0,
        limiter: CallLimiter | None = None,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        if attempts < 1:
            raise ConfigurationError(f"RetryingModel: attempts is {attempts}, it must be at least 1")
        if not all(0.0 <= seconds < math.inf for seconds in (wait, max_wait, total_wait)):
            raise ConfigurationError(
                f"RetryingModel: wait={wait}, max_wait={max_wait} and total_wait={total_wait} must be finite "
                "and not negative"
            )
        super().__init__(inner)
        self._attempts, self._wait, self._max_wait, self._total_wait = attempts, wait, max_wait, total_wait
        self._limiter = limiter or CallLimiter()
        self._clock, self._sleep = clock, sleep

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`. Raises ModelBusy, which says how often, when all attempts were in vain."""
        started, waited = self._clock(), 0.0
        for attempt in range(1, self._attempts):
            try:
                response = self._ask(request)
            except ModelBusy as error:
                wait = self._next_wait(attempt, waited, error)
            else:
                return response if attempt == 1 else self._timed(response, started)
            self._sleep(wait)
            waited += wait
        try:
            return self._timed(self._ask(request), started)
        except ModelBusy as error:
            raise _given_up(error, f"asked {self._attempts} times") from error

    def _ask(self, request: LMRequest) -> LMResponse:
        with self._limiter.slot() as slot:
            try:
                response = super().complete(request)
            except ModelBusy as error:
                if error.rate_limited:
                    self._limiter.refused(slot, min(error.retry_after or 0.0, self._max_wait))
                raise
        self._limiter.answered()
        return response

    def _next_wait(self, attempt: int, waited: float, error: ModelBusy) -> float:
        """Seconds to wait after the attempt of this number. Raises ModelBusy if that would be too long."""
        if error.retry_after is not None and error.retry_after > self._max_wait:
            raise _given_up(
                error, f"it asks to wait {error.retry_after:g} s, longer than max_wait={self._max_wait:g}"
            ) from error
        doubled = min(self._wait * 2 ** min(attempt - 1, _MOST_DOUBLINGS), self._max_wait)
        wait = doubled if error.retry_after is None else error.retry_after
        if waited + wait > self._total_wait:
            raise _given_up(
                error, f"asked {attempt} times; waiting longer would pass total_wait={self._total_wait:g} s"
            ) from error
        return wait

    def _timed(self, response: LMResponse, started: float) -> LMResponse:
        return replace(response, latency_s=max(response.latency_s, self._clock() - started))


def _given_up(error: ModelBusy, why: str) -> ModelBusy:
    return ModelBusy(f"{error} ({why})", error.retry_after, error.rate_limited)
