"""Counting what a language model was asked, what it cost, and how its replies were judged."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from threading import Lock

from adhoc.core.errors import BudgetReached, ReplyError
from adhoc.core.replies import Outcome
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Wrapper
from adhoc.llm.prefixes import SharedPrefixes


@dataclass
class Counts:
    """What happened in one stage, or in all. Money in US dollars."""

    calls: int = 0
    replayed: int = 0
    """Calls that were answered from a ledger."""
    prompt_tokens: int = 0
    prefix_tokens: int = 0
    """Those of them that begin the prompt just as the previous one of the same stage and agent began (see
    `llm.prefixes`): what a provider's prompt cache can spare."""
    left_out_messages: int = 0
    """Communication messages that prompts lack because the model's window would have been passed, in sum."""
    completion_tokens: int = 0
    cost_usd: float = 0.0
    latency_s: float = 0.0
    outcomes: Counter[str] = field(default_factory=Counter)
    """By `Outcome` and by `ReplyError.outcome`."""

    @property
    def repaired(self) -> int:
        """Questions that asking again made good."""
        return self.outcomes[Outcome.REPAIRED.value]

    @property
    def invalid(self) -> int:
        """Questions without a usable reply."""
        return self.outcomes[Outcome.INVALID.value]

    def add(self, other: Counts) -> None:
        """Add another's counts to these."""
        self.calls += other.calls
        self.replayed += other.replayed
        self.prompt_tokens += other.prompt_tokens
        self.prefix_tokens += other.prefix_tokens
        self.left_out_messages += other.left_out_messages
        self.completion_tokens += other.completion_tokens
        self.cost_usd += other.cost_usd
        self.latency_s += other.latency_s
        self.outcomes.update(other.outcomes)


class CountingModel(Wrapper):
    """A language model that counts for the record, per stage, and is otherwise `inner`.

    Wrappers are language models around a language model (see `llm.model.Wrapper`); each has one duty. It
    counts one episode at a time: `begin_episode` begins anew.
    """

    def __init__(self, inner: LanguageModel) -> None:
        super().__init__(inner)
        self._stages: dict[str, Counts] = {}
        self._prefixes = SharedPrefixes()
        self._lock = Lock()

    @property
    def stages(self) -> Mapping[str, Counts]:
        """The counts of each stage since the episode began."""
        return self._stages

    @property
    def total(self) -> Counts:
        """The counts of all stages since the episode began."""
        total = Counts()
        for counts in self._stages.values():
            total.add(counts)
        return total

    def begin_episode(self, episode: str, seed: int) -> None:
        """See `LanguageModel`."""
        self._stages, self._prefixes = {}, SharedPrefixes()
        super().begin_episode(episode, seed)

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`. A call that raises is counted as a call, with what a reply of no use took, if
        that is known; one that a budget did not allow is none."""
        with self._lock:
            self._of(request.stage).calls += 1
            shared = self._prefixes.share(request)
        try:
            response = self._inner.complete(request)
        except BudgetReached:
            with self._lock:
                self._of(request.stage).calls -= 1
            raise
        except ReplyError as error:
            if isinstance(error.response, LMResponse):
                self._add(request, error.response, shared)
            raise
        self._add(request, response, shared)
        return response

    def _add(self, request: LMRequest, response: LMResponse, shared: float) -> None:
        with self._lock:
            counts = self._of(request.stage)
            counts.replayed += response.replayed
            counts.prompt_tokens += response.usage.prompt_tokens
            counts.prefix_tokens += int(shared * response.usage.prompt_tokens)
            counts.left_out_messages += request.left_out_messages
            counts.completion_tokens += response.usage.completion_tokens
            counts.cost_usd += response.usage.cost_usd
            counts.latency_s += response.latency_s

    def note(self, stage: str, outcome: str) -> None:
        """See `LanguageModel`."""
        with self._lock:
            self._of(stage).outcomes[outcome] += 1
        super().note(stage, outcome)

    def _of(self, stage: str) -> Counts:
        return self._stages.setdefault(stage, Counts())
