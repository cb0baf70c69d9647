"""Stage 2 of IRoT, Evaluation and Ranking."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.core.plans import Candidate, Context
from adhoc.llm.model import LanguageModel
from adhoc.planning.inquiry import Inquiry
from adhoc.planning.interfaces import Evaluator
from adhoc.prompting.library import PromptLibrary
from adhoc.prompting.reply_forms import ranking_form
from adhoc.prompting.stage import StageInput


class LLMEvaluator(Evaluator):
    """Lets the language model rank the candidates by how well they serve the team.

    Args:
        model: The language model.
        template: Name of the prompt template.
        prompts: Where templates come from; the shipped ones by default.
        repairs: See `Inquiry`.
        max_tokens: The longest reply.
    """

    def __init__(
        self,
        model: LanguageModel,
        template: str = "evaluate",
        prompts: PromptLibrary | None = None,
        repairs: int = 1,
        max_tokens: int = 1024,
    ) -> None:
        self._inquiry = Inquiry(model, template, prompts, repairs, max_tokens)

    def rank(self, context: Context, candidates: Sequence[Candidate]) -> Sequence[Candidate]:
        """See `Evaluator`. A single candidate is its own ranking and is not sent to the model."""
        if len(candidates) < 2:
            return tuple(candidates)
        stage = StageInput(candidates=tuple(candidates))
        order = self._inquiry.ask(context, stage, lambda prompt: ranking_form(prompt, len(candidates)))
        return tuple(candidates[index] for index in order)


class KeepOrder(Evaluator):
    """No evaluation: the candidates in the order of generation (the paper's 'IRoT w/o Ev.')."""

    def rank(self, context: Context, candidates: Sequence[Candidate]) -> Sequence[Candidate]:
        """The candidates as they are."""
        return tuple(candidates)
