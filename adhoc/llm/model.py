"""The contract of a language model: one request, one response."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

from adhoc.core.chat import ChatMessage

__all__ = ["ChatMessage", "LMRequest", "LMResponse", "LanguageModel", "Usage"]


@dataclass(frozen=True)
class LMRequest:
    """Everything that a model is given."""

    messages: tuple[ChatMessage, ...]
    stage: str
    """What the call is for: `generate`, `evaluate`, `reflect`, `sub_skill`, ... ; for counting only."""
    max_tokens: int = 1024
    sample: int = 0
    """Distinguishes repeated samples of an otherwise equal request."""


@dataclass(frozen=True)
class Usage:
    """Tokens and money of one call; money in US dollars, 0 where the price is unknown."""

    prompt_tokens: int = 0
    completion_tokens: int = 0
    cost_usd: float = 0.0


@dataclass(frozen=True)
class LMResponse:
    """What a model answered."""

    text: str
    model: str
    usage: Usage = Usage()
    finish_reason: str = "stop"


class LanguageModel(ABC):
    """Anything that continues a conversation."""

    @property
    @abstractmethod
    def name(self) -> str:
        """The name that records, tables and pictures carry."""

    @abstractmethod
    def complete(self, request: LMRequest) -> LMResponse:
        """Answer one request.

        Raises ModelError if the model cannot be used at all (missing key, unknown model, unreachable
        endpoint), ReplyError if it answered with nothing usable (no content, cut off).
        """

    def note_invalid(self, stage: str, outcome: str) -> None:  # noqa: B027
        """Told by planners that the last reply of `stage` was of no use (`ReplyError.outcome`).

        Does nothing here; wrappers count it and pass it on.
        """

    def note_repaired(self, stage: str) -> None:  # noqa: B027
        """Told by planners that asking `stage` again after an invalid reply gave a valid one."""
