"""A language model that answers from a script, for tests and for documentation."""

from __future__ import annotations

from collections.abc import Iterable

from adhoc.core.errors import ModelError
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage


class ScriptedModel(LanguageModel):
    """Gives `replies` one after the other; a reply that is an exception is raised.

    Args:
        replies: What to answer, in order.
        name: What records say.
    """

    def __init__(self, replies: Iterable[str | Exception], name: str = "scripted") -> None:
        self._replies = list(replies)
        self._name = name
        self.requests: list[LMRequest] = []
        """Everything that was asked so far."""

    @property
    def name(self) -> str:
        """The name given at construction."""
        return self._name

    def complete(self, request: LMRequest) -> LMResponse:
        """The next reply. Usage counts words. Raises ModelError when the script is used up."""
        self.requests.append(request)
        if len(self.requests) > len(self._replies):
            raise ModelError(
                f"the script of {len(self._replies)} replies is used up at stage {request.stage!r}"
            )
        reply = self._replies[len(self.requests) - 1]
        if isinstance(reply, Exception):
            raise reply
        asked = sum(len(message.content.split()) for message in request.messages)
        return LMResponse(reply, self._name, Usage(asked, len(reply.split())))
