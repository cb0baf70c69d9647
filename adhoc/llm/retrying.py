"""Asking again where a language model is busy."""

from __future__ import annotations

import time
from collections.abc import Callable

from adhoc.core.errors import ConfigurationError, ModelBusy
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse


class RetryingModel(LanguageModel):
    """Asks `inner` again after `ModelBusy` (rate limit, server fault, time-out), with doubling waits.

    Any other error passes at once: a missing key stays missing. Put it inside of counting and budget
    wrappers, so that one answer counts once.

    Args:
        inner: The model that is asked.
        attempts: How often in all, at least 1.
        wait: Seconds before the second attempt; doubled before each further one.
        sleep: How to wait; tests replace it.
    """

    def __init__(
        self,
        inner: LanguageModel,
        attempts: int = 4,
        wait: float = 2.0,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        if attempts < 1:
            raise ConfigurationError(f"RetryingModel: attempts is {attempts}, it must be at least 1")
        self._inner, self._attempts, self._wait, self._sleep = inner, attempts, wait, sleep

    @property
    def name(self) -> str:
        """The inner model's name."""
        return self._inner.name

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`. Raises ModelBusy, which says how often, when all attempts were in vain."""
        for attempt in range(self._attempts):
            if attempt:
                self._sleep(self._wait * 2 ** (attempt - 1))
            try:
                return self._inner.complete(request)
            except ModelBusy as error:
                busy = error
        raise ModelBusy(f"{busy} (asked {self._attempts} times)") from busy

    def note_invalid(self, stage: str, outcome: str) -> None:
        """See `LanguageModel`."""
        self._inner.note_invalid(stage, outcome)

    def note_repaired(self, stage: str) -> None:
        """See `LanguageModel`."""
        self._inner.note_repaired(stage)
