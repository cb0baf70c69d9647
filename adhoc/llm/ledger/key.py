"""What makes two requests the same call."""

from __future__ import annotations

import json
from collections import Counter, OrderedDict
from collections.abc import Mapping, Sequence
from hashlib import sha256
from threading import Lock
from typing import Any

from adhoc.llm.model import LMRequest

MOST_EPISODES = 256
"""So many episodes are counted at a time; the one that was quiet for longest is forgotten first."""


class CallKeys:
    """Gives every request its key: equal keys are one call, paid once.

    A key is made of everything that decides the answer: the messages, the reply's schema, the model and its
    settings, temperature, token limit, seed, sample and template, and how often the same robot asked the
    same before in this episode, so that asking again is another call. Stage, robot and episode are no part
    of it: episodes of one scenario that ask the same share their calls.

    Args:
        model: The model's name, for requests that name none.
        settings: How the model is set up, where that decides answers, e.g. its temperature.
    """

    def __init__(self, model: str, settings: Mapping[str, Any]) -> None:
        self._model, self._settings = model, dict(settings)
        self._episodes: OrderedDict[str, Counter[tuple[str, str]]] = OrderedDict()
        self._current = ""
        self._lock = Lock()

    def begin_episode(self, episode: str) -> None:
        """Count this episode's requests from 0; requests without an episode belong to it from now on."""
        with self._lock:
            self._current = episode
            self._episodes.pop(episode, None)

    def next(self, request: LMRequest) -> tuple[str, int]:
        """The key, and how many equal requests were counted before it; this one is counted."""
        digest = self._digest(request)
        with self._lock:
            counts = self._counts(request.episode or self._current)
            repeat = counts[(request.agent, digest)]
            counts[(request.agent, digest)] += 1
        return call_key(digest, repeat), repeat

    def are_different(self, requests: Sequence[LMRequest]) -> bool:
        """Whether no robot asks the same twice in these, so that their order does not decide any key."""
        asked = {(it.episode, it.agent, self._digest(it)) for it in requests}
        return len(asked) == len(requests)

    def _digest(self, request: LMRequest) -> str:
        return request_digest(request, request.model or self._model, self._settings)

    def _counts(self, episode: str) -> Counter[tuple[str, str]]:
        counts = self._episodes.setdefault(episode, Counter())
        self._episodes.move_to_end(episode)
        if len(self._episodes) > MOST_EPISODES:
            self._episodes.popitem(last=False)
        return counts


def request_digest(request: LMRequest, model: str, settings: Mapping[str, Any]) -> str:
    """The SHA-256 of what decides the answer, apart from repeats, as canonical JSON."""
    return _sha256_of(
        {
            "max_tokens": request.max_tokens,
            "messages": [[message.role, message.content] for message in request.messages],
            "model": model,
            "sample": request.sample,
            "schema": None if request.reply is None else request.reply.schema,
            "seed": request.seed,
            "settings": settings,
            "temperature": request.temperature,
            "template": request.template,
        }
    )


def call_key(digest: str, repeat: int) -> str:
    """The key of the request of this digest that was made `repeat` times before."""
    return _sha256_of([digest, repeat])


def text_hash(text: str) -> str:
    """The SHA-256 of a text; what UTF-8 cannot say is hashed as it stands."""
    return sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _sha256_of(value: Any) -> str:
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False, default=dict)
    return sha256(text.encode()).hexdigest()
