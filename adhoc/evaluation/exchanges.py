"""What was said to a language model and what it answered, kept for transcripts."""

from __future__ import annotations

from collections import deque
from dataclasses import asdict
from itertools import groupby
from typing import Any

from adhoc.core.errors import ReplyError
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage, Wrapper

MAX_EXCHANGES = 64


class TranscribingModel(Wrapper):
    """A language model that is otherwise `inner`, and remembers the latest exchanges."""

    def __init__(self, inner: LanguageModel) -> None:
        super().__init__(inner)
        self._exchanges: dict[str, deque[tuple[int, dict[str, Any]]]] = {}
        """Of each robot, with the number of the sample."""

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`."""
        try:
            response = self._inner.complete(request)
        except ReplyError as error:
            paid = error.response if isinstance(error.response, LMResponse) else None
            self._note(request, f"(no usable reply: {error})", paid)
            raise
        self._note(request, response.text, response)
        return response

    def take(self, agent: str) -> list[dict[str, Any]]:
        """The robot's exchanges since the last call for it, as `{stage, prompt: [{role, content}], reply,
        model, prompt_tokens, completion_tokens, cost_usd}`; the latest 64 at most. Samples of one question,
        which are asked for together, are in their own order.
        """
        taken = []
        for _, together in groupby(self._exchanges.pop(agent, ()), key=lambda entry: entry[1]["stage"]):
            taken += [exchange for _, exchange in sorted(together, key=lambda entry: entry[0])]
        return taken

    def _note(self, request: LMRequest, reply: str, response: LMResponse | None) -> None:
        prompt = [{"role": message.role, "content": message.content} for message in request.messages]
        usage = Usage() if response is None else response.usage
        exchange = {
            "stage": request.stage,
            "prompt": prompt,
            "reply": reply,
            "model": self.name if response is None else response.model,
            **asdict(usage),
        }
        of_robot = self._exchanges.setdefault(request.agent, deque(maxlen=MAX_EXCHANGES))
        of_robot.append((request.sample, exchange))
