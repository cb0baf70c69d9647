"""Stage 1 of IRoT, Generation of Candidate Sub-Tasks; with n = 1 also the CoT-LLM and Naive-LLM baselines."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.core.calls import Call
from adhoc.core.errors import ConfigurationError
from adhoc.core.plans import Candidate, Context
from adhoc.llm.model import LanguageModel
from adhoc.planning.inquiry import Inquiry
from adhoc.planning.interfaces import SubTaskGenerator
from adhoc.planning.legality import Legal, refusal_by
from adhoc.prompting.library import PromptLibrary
from adhoc.prompting.reply_forms import sub_tasks_form
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
        samples: How many replies to the same question, asked for together; what most of them propose comes
            first. The paper takes one.
        legal: See `StagedPlanner`; a reply without anything that is legal for the robot is not usable.
    """

    def __init__(
        self,
        model: LanguageModel,
        n: int = 3,
        template: str = "generate",
        prompts: PromptLibrary | None = None,
        repairs: int = 1,
        max_tokens: int = 1024,
        samples: int = 1,
        legal: Legal | None = None,
    ) -> None:
        if n < 1 or samples < 1:
            raise ConfigurationError(f"LLMGenerator: n={n} and samples={samples} must be at least 1")
        self._count, self._samples, self._legal = n, samples, legal
        self._inquiry = Inquiry(model, template, prompts, repairs, max_tokens)

    def generate(self, context: Context) -> Sequence[Candidate]:
        """See `SubTaskGenerator`. At most n candidates; duplicates and illegal ones are dropped."""
        refusal = refusal_by(self._legal, context.task.sub_tasks, context.capability)
        proposals: list[tuple[Candidate, ...]] = self._inquiry.ask_samples(
            context,
            StageInput(count=self._count),
            lambda prompt: sub_tasks_form(prompt, context, self._count, refusal),
            self._samples,
        )
        return most_proposed(proposals)[: self._count]


def most_proposed(proposals: Sequence[Sequence[Candidate]]) -> tuple[Candidate, ...]:
    """All proposed sub-tasks, each once, with the reason that came first: those of most proposals first,
    then those with the best place in one, then the earliest."""
    votes: dict[Call, int] = {}
    found: dict[Call, tuple[int, Candidate]] = {}
    for proposal in proposals:
        for place, candidate in enumerate(proposal):
            call = candidate.sub_task
            votes[call] = votes.get(call, 0) + 1
            best, first = found.get(call, (place, candidate))
            found[call] = min(best, place), first
    order = sorted(found, key=lambda call: (-votes[call], found[call][0]))
    return tuple(found[call][1] for call in order)
