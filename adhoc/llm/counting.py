"""Counting what a language model was asked and what it cost."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

from adhoc.llm.model import LanguageModel, LMRequest, LMResponse


@dataclass
class Counts:
    """What happened in one stage, or in all. Money in US dollars."""

    calls: int = 0
    prompt_tokens: int = 0
    completion_tokens: int = 0
    cost_usd: float = 0.0
    repaired: int = 0
    """Invalid replies that asking again made good."""
    outcomes: Counter[str] = field(default_factory=Counter)
    """Invalid replies by `ReplyError.outcome`."""

    @property
    def invalid(self) -> int:
        """All invalid replies, repaired ones included."""
        return sum(self.outcomes.values())

    def add(self, other: Counts) -> None:
        """Add another's counts to these."""
        self.calls += other.calls
        self.prompt_tokens += other.prompt_tokens
        self.completion_tokens += other.completion_tokens
        self.cost_usd += other.cost_usd
        self.repaired += other.repaired
        self.outcomes.update(other.outcomes)


class CountingModel(LanguageModel):
    """A language model that counts for the record, per stage, and is otherwise `inner`.

    Wrappers (counting, ledger, budget, retrying) are language models around a language model and nest in
    any order; each passes `note_invalid` and `note_repaired` on.
    """

    def __init__(self, inner: LanguageModel) -> None:
        self._inner = inner
        self._stages: dict[str, Counts] = {}

    @property
    def name(self) -> str:
        """The inner model's name."""
        return self._inner.name

    @property
    def stages(self) -> Mapping[str, Counts]:
        """The counts of each stage so far."""
        return self._stages

    @property
    def total(self) -> Counts:
        """The counts of all stages so far."""
        total = Counts()
        for counts in self._stages.values():
            total.add(counts)
        return total

    def reset(self) -> None:
        """Begin to count anew, as for the next episode."""
        self._stages = {}

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`. A call that raises is counted as a call, without tokens."""
        counts = self._of(request.stage)
        counts.calls += 1
        response = self._inner.complete(request)
        counts.prompt_tokens += response.usage.prompt_tokens
        counts.completion_tokens += response.usage.completion_tokens
        counts.cost_usd += response.usage.cost_usd
        return response

    def note_invalid(self, stage: str, outcome: str) -> None:
        """See `LanguageModel`."""
        self._of(stage).outcomes[outcome] += 1
        self._inner.note_invalid(stage, outcome)

    def note_repaired(self, stage: str) -> None:
        """See `LanguageModel`."""
        self._of(stage).repaired += 1
        self._inner.note_repaired(stage)

    def _of(self, stage: str) -> Counts:
        return self._stages.setdefault(stage, Counts())
