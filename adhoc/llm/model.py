"""The contract of a language model: one request, one response."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from adhoc.core.chat import ChatMessage
from adhoc.core.replies import ReplyFormat

__all__ = ["ChatMessage", "LMRequest", "LMResponse", "LanguageModel", "Usage"]

CHARACTERS_PER_TOKEN = 3.5
"""For estimates; English prose has about 4, lists of ids and numbers about 3."""
TOKENS_PER_MESSAGE = 4
"""What a chat format adds to every message."""


@dataclass(frozen=True)
class LMRequest:
    """Everything that a model is given.

    Requests that are equal in `messages`, `reply.schema`, `model`, `temperature`, `max_tokens`, `seed`,
    `sample` and `template` may be answered by one recorded response; `stage`, `agent`, `episode` and
    `left_out_messages` are for records only.
    """

    messages: tuple[ChatMessage, ...]
    stage: str
    """What the call is for: `generate`, `evaluate`, `reflect`, `sub_skill`, ... ; for counting only."""
    max_tokens: int = 1024
    sample: int = 0
    """Distinguishes repeated samples of an otherwise equal request."""
    reply: ReplyFormat | None = None
    """What the reply must look like; None: any text."""
    template: str = ""
    """The hash of the prompt templates that made the messages."""
    agent: str = ""
    """The robot that asks."""
    episode: str = ""
    """The episode in which it asks."""
    left_out_messages: int = 0
    """How many communication messages were left out of the prompt so that it fits into the window."""
    model: str | None = None
    """None here and below: as the model is configured."""
    temperature: float | None = None
    seed: int | None = None


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
    latency_s: float = field(default=0.0, compare=False)
    """Seconds from the request to the answer, retries included; 0 where nobody measured."""
    raw: Mapping[str, Any] | None = None
    """The provider's answer as JSON values, without headers; None if there is none."""
    parsed: Any = None
    """What `LMRequest.reply` read from the text; None before validation."""
    replayed: bool = False
    """Whether it comes from a ledger and was paid before."""


class LanguageModel(ABC):
    """Anything that continues a conversation."""

    @property
    @abstractmethod
    def name(self) -> str:
        """The name that records, tables and pictures carry."""

    @abstractmethod
    def complete(self, request: LMRequest) -> LMResponse:
        """Answer one request. May be called from several threads at once.

        Raises ModelError if the model cannot be used at all (missing key, unknown model, unreachable
        endpoint), ReplyError if it answered with nothing usable (no content, cut off).
        """

    @property
    def window(self) -> int | None:
        """The longest prompt in tokens, the reply included; None if it is unknown or without bound."""
        return None

    def count_tokens(self, messages: Sequence[ChatMessage]) -> int:
        """About how many tokens a prompt has; never touches the network."""
        characters = sum(len(message.content) for message in messages)
        return round(characters / CHARACTERS_PER_TOKEN) + TOKENS_PER_MESSAGE * len(messages)

    def may_go_together(self, requests: Sequence[LMRequest]) -> bool:
        """Whether these requests can be asked at the same time without their order changing anything."""
        return True

    def begin_episode(self, episode: str, seed: int) -> None:  # noqa: B027
        """Told before the first request of an episode, also when it begins again.

        `seed` is that of the episode's scenario: episodes of one scenario and seed that ask the same are
        answered alike. Does nothing here; wrappers pass it on.
        """

    def note(self, stage: str, outcome: str) -> None:  # noqa: B027
        """Told how a reply of `stage` was judged: an `Outcome`'s value, or `ReplyError.outcome`.

        Does nothing here; wrappers count it and pass it on.
        """


class Wrapper(LanguageModel):
    """A language model around another one, which it is in everything that it does not change."""

    def __init__(self, inner: LanguageModel) -> None:
        self._inner = inner

    @property
    def name(self) -> str:
        """The inner model's name."""
        return self._inner.name

    @property
    def window(self) -> int | None:
        """See `LanguageModel`."""
        return self._inner.window

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`."""
        return self._inner.complete(request)

    def count_tokens(self, messages: Sequence[ChatMessage]) -> int:
        """See `LanguageModel`."""
        return self._inner.count_tokens(messages)

    def may_go_together(self, requests: Sequence[LMRequest]) -> bool:
        """See `LanguageModel`."""
        return self._inner.may_go_together(requests)

    def begin_episode(self, episode: str, seed: int) -> None:
        """See `LanguageModel`."""
        self._inner.begin_episode(episode, seed)

    def note(self, stage: str, outcome: str) -> None:
        """See `LanguageModel`."""
        self._inner.note(stage, outcome)
