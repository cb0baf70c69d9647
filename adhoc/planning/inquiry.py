"""Asking a language model one question of one stage."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.core.plans import Context
from adhoc.core.replies import ReplyFormat
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse
from adhoc.llm.together import ask_together
from adhoc.llm.validating import ValidatingModel, fits_window
from adhoc.prompting.library import PromptLibrary, shipped_prompts
from adhoc.prompting.stage import StageInput

FormOf = Callable[[Sequence[ChatMessage]], ReplyFormat]
"""Makes the form of a reply for a rendered prompt: what it may name is what the prompt names."""


class Inquiry:
    """Renders a template, asks the model, and has the reply validated; every stage of planning has one.

    Args:
        model: The language model; share one among all stages.
        template: Name of the prompt template.
        prompts: Where templates come from; the shipped ones by default.
        repairs: See `ValidatingModel`.
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
        if max_tokens < 1:
            raise ConfigurationError(f"template {template!r}: max_tokens={max_tokens} must be at least 1")
        self._model = ValidatingModel(model, repairs)
        self._template, self._max_tokens = template, max_tokens
        self._prompts = prompts or shipped_prompts()
        self._prompts.check(template)

    def ask(self, context: Context, stage: StageInput, form_of: FormOf) -> Any:
        """What the form that `form_of` makes of the prompt reads from the model's reply.

        Raises:
            ReplyError: no usable reply, after all repairs.
            ModelError: the model cannot be used at all.
        """
        return self._model.complete(self._request(context, stage, form_of)).parsed

    def ask_samples(self, context: Context, stage: StageInput, form_of: FormOf, samples: int) -> list[Any]:
        """What is read from several replies to the same question, which are independent samples and are
        asked for together; those that are of no use are left out.

        Raises what `ask` raises, ReplyError only if no reply is usable.
        """
        request = self._request(context, stage, form_of)
        answers = ask_together(self._model, [replace(request, sample=it) for it in range(samples)])
        read = [answer.parsed for answer in answers if isinstance(answer, LMResponse)]
        if not read:
            raise next(answer for answer in answers if isinstance(answer, ReplyError))
        return read

    def _request(self, context: Context, stage: StageInput, form_of: FormOf) -> LMRequest:
        prompt = self._prompts.fit(self._template, context, stage, self._fits)
        return LMRequest(
            prompt.messages,
            self._template,
            self._max_tokens,
            reply=form_of(prompt.messages),
            template=self._prompts.fingerprint,
            agent=context.me,
            left_out_messages=prompt.left_out_messages,
        )

    def _fits(self, messages: Sequence[ChatMessage]) -> bool:
        return fits_window(self._model, messages, self._max_tokens)
