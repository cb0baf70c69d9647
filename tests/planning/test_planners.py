"""The planner variants of the paper, each held to the contract of planners with the offline reasoner."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from fake_situation import CONTEXT, KNOWLEDGE

from adhoc.core.calls import Call
from adhoc.core.errors import ConfigurationError
from adhoc.core.plans import Context
from adhoc.llm.counting import CountingModel
from adhoc.llm.model import LanguageModel
from adhoc.llm.offline.reasoner import OfflineReasoner
from adhoc.llm.scripted import ScriptedModel
from adhoc.planning.direct import DirectPlanner
from adhoc.planning.evaluate import KeepOrder, LLMEvaluator
from adhoc.planning.generate import LLMGenerator
from adhoc.planning.gpl import GPLEvaluator, GPLGenerator
from adhoc.planning.interfaces import Consultation, Planner
from adhoc.planning.reflect import AcceptFirst, LLMReflector
from adhoc.planning.staged import StagedPlanner
from adhoc.planning.sub_skill import LLMSubSkillPlanner
from adhoc.testing.planner_contract import PlannerContract, told_nothing

DELIVERY = Call("Deliver", ("Letter|1", "Tray", "Office"))
Stage = Callable[[LanguageModel], Any]


def _keep_order(model: LanguageModel) -> KeepOrder:
    return KeepOrder()


def _accept_first(model: LanguageModel) -> AcceptFirst:
    return AcceptFirst()


VARIANTS: dict[str, tuple[Stage, Stage, Stage]] = {
    "irot": (LLMGenerator, LLMEvaluator, LLMReflector),
    "irot_no_evaluation": (LLMGenerator, _keep_order, LLMReflector),
    "irot_no_reflection": (LLMGenerator, LLMEvaluator, _accept_first),
    "irot_no_evaluation_no_reflection": (LLMGenerator, _keep_order, _accept_first),
    "cot": (partial(LLMGenerator, n=1, template="cot"), _keep_order, _accept_first),
    "naive": (partial(LLMGenerator, n=1, template="naive"), _keep_order, _accept_first),
    "gpl": (GPLGenerator, GPLEvaluator, _accept_first),
}
CALLS = {
    "irot": {"generate": 1, "evaluate": 1, "reflect": 1},
    "irot_no_evaluation": {"generate": 1, "reflect": 1},
    "irot_no_reflection": {"generate": 1, "evaluate": 1},
    "irot_no_evaluation_no_reflection": {"generate": 1},
    "cot": {"cot": 1},
    "naive": {"naive": 1},
    "gpl": {"gpl_predict": 1, "gpl_generate": 1, "gpl_score": 1},
}


def flawless() -> OfflineReasoner:
    return OfflineReasoner(KNOWLEDGE, forget_capability=0.0, ignore_teammate=0.0, ignore_reply=0.0)


class VariantContract(PlannerContract):
    variant = ""

    def planner(self, model: LanguageModel) -> Planner:
        return StagedPlanner(*(stage(model) for stage in VARIANTS[self.variant]))

    def context(self) -> Context:
        return CONTEXT

    def good_model(self) -> LanguageModel:
        return flawless()

    def test_the_model_is_called_as_often_as_the_variant_says(self) -> None:
        model = CountingModel(flawless())
        plan = self.planner(model).plan(CONTEXT, told_nothing(CONTEXT))
        assert plan.sub_task == Call("Deliver", ("Letter|1", "Tray", "Office"))
        assert plan.fallback is None
        assert {stage: counts.calls for stage, counts in model.stages.items()} == CALLS[self.variant]

    def test_teammates_are_asked_only_where_there_is_reflection(self) -> None:
        asked: list[Call] = []

        def consult(intention: Call) -> Consultation:
            asked.append(intention)
            return Consultation((), CONTEXT)

        self.planner(flawless()).plan(CONTEXT, consult)
        assert bool(asked) is ("reflect" in CALLS[self.variant])


class TestIRoT(VariantContract):
    variant = "irot"


class TestIRoTWithoutEvaluation(VariantContract):
    variant = "irot_no_evaluation"


class TestIRoTWithoutReflection(VariantContract):
    variant = "irot_no_reflection"


class TestIRoTWithoutBoth(VariantContract):
    variant = "irot_no_evaluation_no_reflection"


class TestCoT(VariantContract):
    variant = "cot"


class TestNaive(VariantContract):
    variant = "naive"


class TestGPL(VariantContract):
    variant = "gpl"

    def test_predicts_then_generates_then_scores(self) -> None:
        """The order of the paper (section GPL-LLM Policy); stages are kept in the order of their calls."""
        model = CountingModel(flawless())
        self.planner(model).plan(CONTEXT, told_nothing(CONTEXT))
        assert list(model.stages) == ["gpl_predict", "gpl_generate", "gpl_score"]


class TestDirect(PlannerContract):
    asks_the_model = False

    def planner(self, model: LanguageModel) -> Planner:
        return DirectPlanner()

    def context(self) -> Context:
        return CONTEXT

    def good_model(self) -> LanguageModel:
        return flawless()

    def neutral(self) -> tuple[str, ...]:
        return ("Act",)


class TestFreshContext:
    """What the teammates reply counts in the very step in which it is told."""

    NOTHING_KNOWN = replace(
        CONTEXT, objects=CONTEXT.objects[4:], rooms=CONTEXT.rooms[:2], teammates=CONTEXT.teammates[1:]
    )

    def test_a_robot_that_is_told_of_a_misplaced_object_does_not_rest(self) -> None:
        told = replace(self.NOTHING_KNOWN, objects=(CONTEXT.objects[0], *self.NOTHING_KNOWN.objects))
        plan = _reflecting().plan(self.NOTHING_KNOWN, lambda _: Consultation((), told))
        assert [(str(it.sub_task), verdict.feasible) for it, verdict in plan.verdicts] == [
            ("Rest", False),
            (str(DELIVERY), True),
        ]
        assert (plan.sub_task, plan.rounds, plan.fallback) == (DELIVERY, 2, None)

    def test_a_robot_that_is_told_of_nothing_rests(self) -> None:
        plan = _reflecting().plan(self.NOTHING_KNOWN, told_nothing(self.NOTHING_KNOWN))
        assert (plan.sub_task, plan.rounds, plan.fallback) == (Call("Rest"), 1, None)


def _reflecting() -> StagedPlanner:
    model = flawless()
    return StagedPlanner(LLMGenerator(model), LLMEvaluator(model), LLMReflector(model))


class TestArguments:
    def test_impossible_numbers_are_refused(self) -> None:
        for arguments in ({"n": 0}, {"repairs": -1}, {"max_tokens": 0}):
            with pytest.raises(ConfigurationError):
                LLMGenerator(flawless(), **arguments)
            with pytest.raises(ConfigurationError):
                GPLGenerator(flawless(), **arguments)
        with pytest.raises(ConfigurationError, match="max_rounds"):
            StagedPlanner(LLMGenerator(flawless()), KeepOrder(), AcceptFirst(), max_rounds=0)


class TestSubSkills:
    def test_follows_the_sub_task(self) -> None:
        planner = LLMSubSkillPlanner(flawless())
        assert planner.next_skill(CONTEXT, Call("Search", ("room|3",)), None) == Call("WalkTo", ("room|3",))

    def test_without_the_sub_task_planner_it_sees_the_situation_alone(self) -> None:
        planner = LLMSubSkillPlanner(flawless(), template="direct_sub_skill")
        assert planner.next_skill(CONTEXT, Call("Act"), None) == Call("Approach", ("Letter|1",))

    def test_the_model_s_words_decide(self) -> None:
        model = ScriptedModel(['{"analysis": "", "sub_skill": {"name": "LookAround", "args": []}}'])
        planner = LLMSubSkillPlanner(model)
        assert planner.next_skill(CONTEXT, Call("Search", ("room|3",)), None) == Call("LookAround")
        assert "- sub-task: Search room|3" in model.requests[0].messages[1].content
