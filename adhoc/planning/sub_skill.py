"""The dynamic sub-skill planner (paper, section Dynamic Sub-skill Planner)."""

from __future__ import annotations

from adhoc.core.calls import Call
from adhoc.core.plans import Assessment, Context
from adhoc.llm.model import LanguageModel
from adhoc.planning.inquiry import Inquiry
from adhoc.planning.interfaces import SubSkillPlanner
from adhoc.planning.legality import Legal, refusal_by
from adhoc.prompting.library import PromptLibrary
from adhoc.prompting.reply_forms import sub_skill_form
from adhoc.prompting.stage import StageInput


class LLMSubSkillPlanner(SubSkillPlanner):
    """Lets the language model choose the next sub-skill.

    Args:
        model: The language model.
        template: `sub_skill`; with `direct_sub_skill` the current sub-task is not in the prompt, which is the
            paper's 'w/o STP.' together with `planning.direct.DirectPlanner`.
        prompts: Where templates come from; the shipped ones by default.
        repairs: See `Inquiry`.
        max_tokens: The longest reply.
        legal_skill: The task's own check, `Task.legal_skill`. None: only the vocabulary's need for
            manipulation is checked.
    """

    def __init__(
        self,
        model: LanguageModel,
        template: str = "sub_skill",
        prompts: PromptLibrary | None = None,
        repairs: int = 1,
        max_tokens: int = 512,
        legal_skill: Legal | None = None,
    ) -> None:
        self._legal_skill = legal_skill
        self._inquiry = Inquiry(model, template, prompts, repairs, max_tokens)

    def next_skill(self, context: Context, sub_task: Call, last: Assessment | None) -> Call:
        """See `SubSkillPlanner`."""
        stage = StageInput(sub_task=sub_task, last=last)
        refusal = refusal_by(self._legal_skill, context.task.sub_skills, context.capability)
        call: Call = self._inquiry.ask(
            context, stage, lambda prompt: sub_skill_form(prompt, context, refusal)
        )
        return call
