"""What a worker and the process that started it say to each other. All of it can be pickled.

A worker asks, and is answered; the parent never speaks first.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import AdhocError
from adhoc.core.replies import Reading
from adhoc.evaluation.records import Record
from adhoc.experiments.failures import Failure
from adhoc.experiments.folder import FolderKey
from adhoc.llm.model import LMRequest


@dataclass(frozen=True)
class NextUnit:
    """Answered by the unit to run next, or None if there is nothing left to do."""


@dataclass(frozen=True)
class AboutModel:
    """Answered by `ModelFacts`."""


@dataclass(frozen=True)
class ModelFacts:
    """What does not change about a language model."""

    name: str
    window: int | None


@dataclass(frozen=True)
class CountTokens:
    """Answered by the number of tokens."""

    messages: tuple[ChatMessage, ...]


@dataclass(frozen=True)
class BeginEpisode:
    """Answered by None."""

    episode: str
    seed: int


@dataclass(frozen=True)
class Complete:
    """Answered by an `LMResponse`."""

    request: LMRequest


@dataclass(frozen=True)
class Note:
    """How a reply was judged. Answered by None."""

    stage: str
    outcome: str


@dataclass(frozen=True)
class MayGoTogether:
    """Answered by whether the requests may be made at once."""

    requests: tuple[LMRequest, ...]


ModelQuestion = AboutModel | CountTokens | BeginEpisode | Complete | Note | MayGoTogether
"""What is answered by the language model, and may take long."""


@dataclass(frozen=True)
class StoredKind:
    """A `FolderKind` that can be pickled."""

    group: tuple[str, str, str | None]
    settings: Mapping[str, Any]
    config_hash: str


@dataclass(frozen=True)
class StoredKey:
    """A `FolderKey` that can be pickled."""

    id: str
    kind: StoredKind
    scenario_id: str
    scenario_hash: str

    @staticmethod
    def of(key: FolderKey) -> StoredKey:
        """The values of another key."""
        kind = StoredKind(key.kind.group, key.kind.settings, key.kind.config_hash)
        return StoredKey(key.id, kind, key.scenario_id, key.scenario_hash)


@dataclass(frozen=True)
class FindRecord:
    """Answered by a record or None."""

    key: StoredKey


@dataclass(frozen=True)
class AddRecord:
    """Answered by None when the record is on the disk."""

    key: StoredKey
    record: Record
    finished: bool = True
    """Whether the episode was played to its end; if not, it will be run again."""


@dataclass(frozen=True)
class AddFailure:
    """An episode failed. Answered by None when that is on the disk."""

    failure: Failure


@dataclass(frozen=True)
class Started:
    """See `progress.Progress`. Answered by None."""

    episode_id: str


@dataclass(frozen=True)
class Raised:
    """An error of the library instead of an answer, or the last word of a worker.

    Taken apart, because an exception whose constructor wants more than its text cannot be pickled.
    """

    kind: type[AdhocError]
    arguments: tuple[Any, ...]
    fields: Mapping[str, Any]

    @staticmethod
    def of(error: AdhocError) -> Raised:
        """The parts of an error."""
        return Raised(type(error), error.args, dict(vars(error)))

    def error(self) -> AdhocError:
        """The error again."""
        error = self.kind.__new__(self.kind, *self.arguments)
        error.args = self.arguments
        vars(error).update(self.fields)
        return error


def portable(request: LMRequest) -> LMRequest:
    """The request without the function that reads its reply: replies are read where they were asked for."""
    if request.reply is None:
        return request
    return replace(request, reply=replace(request.reply, read=_unread))


def _unread(text: str) -> Reading:
    return Reading(text)
