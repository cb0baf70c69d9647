"""The ablation without the sub-task planner (the paper's 'w/o STP.')."""

from __future__ import annotations

from adhoc.core.calls import Call
from adhoc.core.plans import Context, Plan
from adhoc.planning.interfaces import Consult, Planner


class DirectPlanner(Planner):
    """Chooses no sub-task: it always returns `neutral`, and asks neither the model nor the teammates.

    The sub-skills then come straight from the language model, by
    `LLMSubSkillPlanner(model, template="direct_sub_skill")`.

    Args:
        neutral: What stands in for a sub-task. It is in no task's vocabulary, so that nobody mistakes it
            for an intention; it never finishes.
    """

    def __init__(self, neutral: str = "Act") -> None:
        self._neutral = Call(neutral)

    def plan(self, context: Context, consult: Consult) -> Plan:
        """See `Planner`."""
        return Plan(self._neutral)
