"""Stage 1 of IRoT, Generation of Candidate Sub-Tasks; with n = 1 also the CoT-LLM and Naive-LLM baselines."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.core.errors import ConfigurationError
from adhoc.core.plans import Candidate, Context
from adhoc.llm.model import LanguageModel
from adhoc.planning.inquiry import Inquiry
from adhoc.planning.interfaces import SubTaskGenerator
from adhoc.prompting.library import PromptLibrary
from adhoc.prompting.parse import read_sub_tasks
from adhoc.prompting.stage import StageInput


class LLMGenerator(SubTaskGenerator):
    """Lets the language model propose `n` different sub-tasks in one reply.

    Args:
        model: The language model.
        n: How many sub-tasks to ask for: the paper's n_irot, which it leaves open; its figures show 3.
        template: `generate`; `cot` or `naive` with n = 1 are the paper's baselines of those names.
        prompts: Where templates come from; the shipped ones by default.
        repairs: See `Inquiry`.
        max_tokens: The longest reply.
    """

    def __init__(
        self,
        model: LanguageModel,
        n: int = 3,
        template: str = "generate",
        prompts: PromptLibrary | None = None,
        repairs: int = 1,
        max_tokens: int = 1024,
    ) -> None:
        if n < 1:
            raise ConfigurationError(f"LLMGenerator: n is {n}, it must be at least 1")
        self._count = n
        self._inquiry = Inquiry(model, template, prompts, repairs, max_tokens)

    def generate(self, context: Context) -> Sequence[Candidate]:
        """See `SubTaskGenerator`. At most n candidates; duplicates and illegal ones are dropped."""
        stage = StageInput(count=self._count)
        return self._inquiry.ask(context, stage, lambda text: read_sub_tasks(text, context, self._count))
