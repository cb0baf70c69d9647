"""What was said to a language model and what it answered, kept for transcripts."""

from __future__ import annotations

from collections import deque
from typing import Any

from adhoc.core.errors import ReplyError
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse

MAX_EXCHANGES = 64


class TranscribingModel(LanguageModel):
    """A language model that is otherwise `inner`, and remembers the latest exchanges."""

    def __init__(self, inner: LanguageModel) -> None:
        self._inner = inner
        self._exchanges: deque[dict[str, Any]] = deque(maxlen=MAX_EXCHANGES)

    @property
    def name(self) -> str:
        """The inner model's name."""
        return self._inner.name

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`."""
        try:
            response = self._inner.complete(request)
        except ReplyError as error:
            self._note(request, f"(no usable reply: {error})")
            raise
        self._note(request, response.text)
        return response

    def note_invalid(self, stage: str, outcome: str) -> None:
        """See `LanguageModel`."""
        self._inner.note_invalid(stage, outcome)

    def note_repaired(self, stage: str) -> None:
        """See `LanguageModel`."""
        self._inner.note_repaired(stage)

    def take(self) -> list[dict[str, Any]]:
        """The exchanges since the last call, as `{stage, prompt: [{role, content}], reply}`; the latest
        64 at most."""
        taken = list(self._exchanges)
        self._exchanges.clear()
        return taken

    def _note(self, request: LMRequest, reply: str) -> None:
        prompt = [{"role": message.role, "content": message.content} for message in request.messages]
        self._exchanges.append({"stage": request.stage, "prompt": prompt, "reply": reply})
