"""A language model that seems to cost money and is none."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage
from adhoc.llm.offline.reasoner import OfflineReasoner


class PaidReasoner(LanguageModel):
    """Answers like the offline reasoner, as `paid`, at 10 and 30 dollars for a million tokens.

    It dies instead of answering the call number `dies_at` of the process.
    """

    calls: ClassVar[list[LMRequest]] = []
    """What was asked in this process."""
    dies_at: ClassVar[int | None] = None

    def __init__(self, places, model: str = "paid") -> None:
        self._reasoner, self._name = OfflineReasoner(places), model

    @property
    def name(self) -> str:
        return self._name

    def complete(self, request: LMRequest) -> LMResponse:
        self.calls.append(request)
        if len(self.calls) == self.dies_at:
            raise KeyboardInterrupt
        response = self._reasoner.complete(request)
        usage = response.usage
        cost = (10 * usage.prompt_tokens + 30 * usage.completion_tokens) / 1e6
        return replace(
            response, model=self._name, usage=Usage(usage.prompt_tokens, usage.completion_tokens, cost)
        )
