"""Reading every reply as what was asked for, and asking once more where it cannot be used."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.core.replies import Outcome, Reading
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Wrapper

MAX_SHOWN_REPLY = 4000
"""Characters of a bad reply that the model is shown again; what a longer one got wrong shows in these."""
MAX_SHOWN_PROBLEM = 1000
"""Characters of the sentence that says what was wrong."""


class ValidatingModel(Wrapper):
    """Reads replies by `LMRequest.reply` into `LMResponse.parsed`; the outermost wrapper.

    A reply that cannot be used is shown to the model again with what was wrong about it, `repairs` times at
    most, and no more often than that fits into the model's window. Every reply's fate is noted on `inner`
    (`LanguageModel.note`): each question ends in one of VALID, REPAIRED and INVALID, each unusable reply in
    its `ReplyError.outcome` besides, and each entry that a usable reply lost in the outcome of its `Fault`.
    Requests without a `reply` pass as they are.

    Args:
        inner: The model that is asked.
        repairs: How often a question is asked again. The paper is silent; one repair catches most slips and
            bounds the cost.

    Raises:
        ConfigurationError: repairs is negative.
    """

    def __init__(self, inner: LanguageModel, repairs: int = 1) -> None:
        if repairs < 0:
            raise ConfigurationError(f"ValidatingModel: repairs={repairs} must not be negative")
        super().__init__(inner)
        self._repairs = repairs

    def complete(self, request: LMRequest) -> LMResponse:
        """See `LanguageModel`. Raises the ReplyError of the last reply if none could be used."""
        form = request.reply
        if form is None:
            return self._inner.complete(request)
        asked = request
        for attempt in range(self._repairs + 1):
            text = ""
            try:
                response = self._inner.complete(asked)
                text = response.text
                reading = form.read(text)
            except ReplyError as error:
                self._inner.note(request.stage, error.outcome)
                asked, problem = _once_more(request, text, error), error
                if not fits_window(self._inner, asked.messages, asked.max_tokens):
                    break
                continue
            self._accept(request.stage, reading, repaired=attempt > 0)
            return replace(response, parsed=reading.value)
        self._inner.note(request.stage, Outcome.INVALID.value)
        raise problem

    def _accept(self, stage: str, reading: Reading, repaired: bool) -> None:
        for fault in reading.faults:
            self._inner.note(stage, fault.outcome)
        self._inner.note(stage, (Outcome.REPAIRED if repaired else Outcome.VALID).value)


def fits_window(model: LanguageModel, messages: Sequence[ChatMessage], max_tokens: int) -> bool:
    """Whether a conversation and the longest reply fit into the model's window."""
    return model.window is None or model.count_tokens(messages) + max_tokens <= model.window


def _once_more(request: LMRequest, text: str, error: ReplyError) -> LMRequest:
    """The question with the bad reply and what was wrong about it; an empty reply is not shown."""
    shown = _bounded(text, MAX_SHOWN_REPLY)
    correction = ChatMessage(
        "user",
        f"Your reply could not be used ({error.outcome}): {_bounded(str(error), MAX_SHOWN_PROBLEM)}\n"
        "Answer again with exactly one JSON object of the form given under 'Output format'.",
    )
    reply = (ChatMessage("assistant", shown),) if shown.strip() else ()
    return replace(request, messages=(*request.messages, *reply, correction))


def _bounded(text: str, characters: int) -> str:
    """The beginning of the text, as far as it can be sent as UTF-8: a reply may hold half characters."""
    kept = text if len(text) <= characters else text[: characters - 1] + "…"
    return kept.encode("utf-8", "replace").decode("utf-8")
