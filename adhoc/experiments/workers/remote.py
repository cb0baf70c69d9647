"""What stands in a worker for the language model, the run folder and the progress of its parent."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from adhoc.core.chat import ChatMessage
from adhoc.evaluation.records import Record
from adhoc.experiments.failures import Failure
from adhoc.experiments.folder import FolderKey
from adhoc.experiments.plan import Plan
from adhoc.experiments.workers.line import Line
from adhoc.experiments.workers.messages import (
    AboutModel,
    AddFailure,
    AddRecord,
    BeginEpisode,
    Complete,
    CountTokens,
    FindRecord,
    MayGoTogether,
    ModelFacts,
    Note,
    Started,
    StoredKey,
    portable,
)
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse


class RemoteModel(LanguageModel):
    """The parent's language model: it alone records, counts against caps, and pays.

    Raises whatever that model raises.
    """

    def __init__(self, line: Line) -> None:
        self._line = line

    @property
    def name(self) -> str:
        """The name of the parent's model."""
        return self._facts.name

    @property
    def window(self) -> int | None:
        """See `LanguageModel`."""
        return self._facts.window

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`. The provider's raw answer stays with the parent."""
        response: LMResponse = self._line.ask(Complete(portable(request)))
        return response

    def count_tokens(self, messages: Sequence[ChatMessage]) -> int:
        """See `LanguageModel`."""
        tokens: int = self._line.ask(CountTokens(tuple(messages)))
        return tokens

    def may_go_together(self, requests: Sequence[LMRequest]) -> bool:
        """See `LanguageModel`."""
        may: bool = self._line.ask(MayGoTogether(tuple(map(portable, requests))))
        return may

    def begin_episode(self, episode: str, seed: int) -> None:
        """See `LanguageModel`."""
        self._line.ask(BeginEpisode(episode, seed))

    def note(self, stage: str, outcome: str) -> None:
        """See `LanguageModel`."""
        self._line.ask(Note(stage, outcome))

    @cached_property
    def _facts(self) -> ModelFacts:
        facts: ModelFacts = self._line.ask(AboutModel())
        return facts


@dataclass(frozen=True)
class RemoteFolder:
    """The parent's run folder; see `folder.RunFolder`."""

    line: Line

    def find(self, key: FolderKey) -> Record | None:
        """See `RunFolder`."""
        record: Record | None = self.line.ask(FindRecord(StoredKey.of(key)))
        return record

    def add(self, key: FolderKey, record: Record) -> None:
        """See `RunFolder`."""
        self.line.ask(AddRecord(StoredKey.of(key), record))

    def add_unfinished(self, key: FolderKey, record: Record) -> None:
        """See `RunFolder`."""
        self.line.ask(AddRecord(StoredKey.of(key), record, finished=False))

    def add_failure(self, failure: Failure) -> None:
        """See `RunFolder`."""
        self.line.ask(AddFailure(failure))


@dataclass(frozen=True)
class RemoteProgress:
    """Tells the parent what happens to episodes; see `progress.Progress`."""

    line: Line

    def begin(self, plan: Plan) -> None:
        """Says nothing: the parent made the plan."""

    def started(self, episode_id: str) -> None:
        """See `progress.Progress`."""
        self.line.ask(Started(episode_id))

    def finished(self, record: Record) -> None:
        """Says nothing: the parent is told when the record is stored."""

    def failed(self, failure: Failure) -> None:
        """Says nothing: the parent is told when the failure is stored."""
