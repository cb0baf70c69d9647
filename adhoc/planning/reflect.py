"""Stage 3 of IRoT, Interactive Reflection."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.core.messages import Message
from adhoc.core.plans import Candidate, Context, Verdict
from adhoc.llm.model import LanguageModel
from adhoc.planning.inquiry import Inquiry
from adhoc.planning.interfaces import Reflector
from adhoc.prompting.library import PromptLibrary
from adhoc.prompting.reply_forms import verdict_form
from adhoc.prompting.stage import StageInput


class LLMReflector(Reflector):
    """Shares the candidate with the teammates and lets the language model judge it by their replies.

    Args:
        model: The language model.
        template: Name of the prompt template.
        prompts: Where templates come from; the shipped ones by default.
        repairs: See `Inquiry`.
        max_tokens: The longest reply.
    """

    consults = True

    def __init__(
        self,
        model: LanguageModel,
        template: str = "reflect",
        prompts: PromptLibrary | None = None,
        repairs: int = 1,
        max_tokens: int = 512,
    ) -> None:
        self._inquiry = Inquiry(model, template, prompts, repairs, max_tokens)

    def judge(self, context: Context, candidate: Candidate, replies: Sequence[Message]) -> Verdict:
        """See `Reflector`."""
        stage = StageInput(chosen=candidate, replies=tuple(replies))
        verdict: Verdict = self._inquiry.ask(context, stage, verdict_form)
        return verdict


class AcceptFirst(Reflector):
    """No reflection: takes the first legal candidate, asks nobody (the paper's 'IRoT w/o Rf.')."""

    consults = False

    def judge(self, context: Context, candidate: Candidate, replies: Sequence[Message]) -> Verdict:
        """Feasible."""
        return Verdict(True, "accepted without reflection")
