"""Asking a language model one question of one stage, with a bounded number of repairs."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.core.plans import Context
from adhoc.llm.model import LanguageModel, LMRequest
from adhoc.prompting.library import PromptLibrary, shipped_prompts
from adhoc.prompting.stage import StageInput

Value = TypeVar("Value")


class Inquiry:
    """Renders a template, asks the model, and reads the reply; every stage of planning has one.

    Args:
        model: The language model; share one among all stages.
        template: Name of the prompt template.
        prompts: Where templates come from; the shipped ones by default.
        repairs: How often a reply that cannot be used is shown to the model again with what is wrong about
            it. The paper is silent; one repair catches most slips and bounds the cost.
        max_tokens: The longest reply.

    Raises:
        ConfigurationError: a number is out of range.
        PromptError: there is no such template.
    """

    def __init__(
        self,
        model: LanguageModel,
        template: str,
        prompts: PromptLibrary | None = None,
        repairs: int = 1,
        max_tokens: int = 1024,
    ) -> None:
        if repairs < 0 or max_tokens < 1:
            raise ConfigurationError(
                f"template {template!r}: repairs={repairs} must not be negative and max_tokens={max_tokens} "
                "must be at least 1"
            )
        self._model, self._template, self._repairs, self._max_tokens = model, template, repairs, max_tokens
        self._prompts = prompts or shipped_prompts()
        self._prompts.check(template)

    def ask(self, context: Context, stage: StageInput, read: Callable[[str], Value]) -> Value:
        """What `read` makes of the model's reply.

        Every reply that cannot be used is noted on the model (`note_invalid`), so that wrappers count it.

        Raises:
            ReplyError: no usable reply, after all repairs.
            ModelError: the model cannot be used at all.
        """
        asked = self._prompts.render(self._template, context, stage)
        messages = asked
        for attempt in range(self._repairs + 1):
            text = ""
            try:
                request = LMRequest(messages, self._template, self._max_tokens, attempt)
                text = self._model.complete(request).text
                value = read(text)
            except ReplyError as error:
                self._model.note_invalid(self._template, error.outcome)
                messages, problem = (*asked, *_repair(text, error)), error
            else:
                if attempt:
                    self._model.note_repaired(self._template)
                return value
        raise problem


def _repair(text: str, error: ReplyError) -> tuple[ChatMessage, ...]:
    """The end of the conversation that asks again; an empty reply is not shown."""
    request = ChatMessage(
        "user",
        f"Your reply could not be used ({error.outcome}): {error}\n"
        "Answer again with exactly one JSON object of the form given under 'Output format'.",
    )
    return (ChatMessage("assistant", text), request) if text else (request,)
