"""Speaking for a robot whose team agrees on its sub-tasks (paper, appendix 'Teammates with the LLM')."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from adhoc.core.calls import Call
from adhoc.core.plans import Context, Objection, Proposal
from adhoc.llm.model import LanguageModel
from adhoc.planning.inquiry import Inquiry
from adhoc.planning.interfaces import Negotiator
from adhoc.planning.legality import Legal, refusal_by
from adhoc.prompting.library import PromptLibrary
from adhoc.prompting.reply_forms import proposal_form
from adhoc.prompting.stage import StageInput


class LLMNegotiator(Negotiator):
    """Lets the language model say in one reply whether it agrees with the plans so far, and what to do next.

    The reply is a chain of thought, as in the paper. One that gives a sub-task which the robot is not able
    to do is not usable.

    Args:
        model: The language model.
        template: Name of the prompt template.
        prompts: Where templates come from; the shipped ones by default.
        repairs: See `Inquiry`.
        max_tokens: The longest reply.
        legal: See `StagedPlanner`.
    """

    def __init__(
        self,
        model: LanguageModel,
        template: str = "negotiate",
        prompts: PromptLibrary | None = None,
        repairs: int = 1,
        max_tokens: int = 1024,
        legal: Legal | None = None,
    ) -> None:
        self._legal = legal
        self._inquiry = Inquiry(model, template, prompts, repairs, max_tokens)

    def propose(
        self,
        context: Context,
        plans: Mapping[str, Call],
        objections: Sequence[Objection] = (),
        changes: Sequence[str] = (),
    ) -> Proposal:
        """See `Negotiator`."""
        stage = StageInput(plans=plans, objections=tuple(objections), changes=tuple(changes))
        refusal = refusal_by(self._legal, context.task.sub_tasks, context.capability)
        proposal: Proposal = self._inquiry.ask(
            context, stage, lambda prompt: proposal_form(prompt, context, plans, refusal)
        )
        return proposal
