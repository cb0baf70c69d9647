"""The contract of `Planner` as tests that every implementation inherits.

Subclass `PlannerContract` and implement `planner` and `context`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

import pytest

from adhoc.core.calls import Call
from adhoc.core.errors import ModelError, ReplyError
from adhoc.core.plans import Context, Plan
from adhoc.llm.model import LanguageModel
from adhoc.llm.scripted import ScriptedModel
from adhoc.planning.interfaces import Consult, Consultation, Planner

NONSENSE = (
    "",
    "no idea",
    "{",
    '{"sub_tasks": [{"name": "Nonsense"}]}',
    '{"sub_tasks": NaN}',
    '{"sub_tasks": [], "sub_tasks": []}',
    '{"sub_tasks": ' + "[" * 10_000,
    "nothing " * 100_000,
)
"""Replies of which nothing can be made."""


def told_nothing(context: Context) -> Consult:
    """A consultation to which nobody replies."""
    return lambda _: Consultation((), context)


class PlannerContract(ABC):
    """Inherit as `class TestMine(PlannerContract)`."""

    asks_the_model = True
    """Whether the planner needs its language model at all."""

    @abstractmethod
    def planner(self, model: LanguageModel) -> Planner:
        """A fresh planner around `model`."""

    @abstractmethod
    def context(self) -> Context:
        """A situation in which there is something to do."""

    @abstractmethod
    def good_model(self) -> LanguageModel:
        """A model that answers well in `context`."""

    def neutral(self) -> tuple[str, ...]:
        """Names outside of the vocabulary that the planner may return."""
        return ()

    def test_the_sub_task_is_of_the_vocabulary(self) -> None:
        plan = self.planner(self.good_model()).plan(self.context(), told_nothing(self.context()))
        assert isinstance(plan, Plan)
        names = {spec.name for spec in self.context().task.sub_tasks}
        assert plan.sub_task.name in names | set(self.neutral())
        assert plan.rounds >= 1

    def test_only_candidates_are_shared_and_none_twice(self) -> None:
        asked: list[Call] = []

        def consult(intention: Call) -> Consultation:
            asked.append(intention)
            return Consultation((), self.context())

        plan = self.planner(self.good_model()).plan(self.context(), consult)
        assert len(set(asked)) == len(asked)
        assert set(asked) <= {candidate.sub_task for candidate, _ in plan.verdicts}

    def test_the_context_stays_as_it_is(self) -> None:
        context = self.context()
        before = repr(context)
        self.planner(self.good_model()).plan(context, told_nothing(context))
        assert repr(context) == before

    @pytest.mark.parametrize("reply", NONSENSE)
    def test_a_model_that_talks_nonsense_ends_in_a_stated_fallback(self, reply: str) -> None:
        model = ScriptedModel([reply] * 50)
        plan = self.planner(model).plan(self.context(), told_nothing(self.context()))
        if self.asks_the_model:
            assert plan.fallback
            assert plan.sub_task == self.context().task.fallback
        else:
            self._assert_untouched(plan, model)

    def test_a_model_that_is_cut_off_is_no_error_either(self) -> None:
        model = ScriptedModel([ReplyError("cut off", "truncated")] * 50)
        plan = self.planner(model).plan(self.context(), told_nothing(self.context()))
        assert bool(plan.fallback) is self.asks_the_model

    def test_a_model_that_cannot_be_used_is_an_error(self) -> None:
        model = ScriptedModel([ModelError("no key")] * 50)
        planner = self.planner(model)
        if self.asks_the_model:
            with pytest.raises(ModelError, match="no key"):
                planner.plan(self.context(), told_nothing(self.context()))
        else:
            self._assert_untouched(planner.plan(self.context(), told_nothing(self.context())), model)

    def _assert_untouched(self, plan: Plan, model: ScriptedModel) -> None:
        """What the model says makes no difference to a planner that does not ask it."""
        assert model.requests == []
        assert plan.fallback is None
        assert plan.sub_task.name in self.neutral()
