"""Every policy keeps the contract of policies."""

from __future__ import annotations

from adhoc import (
    HeuristicPolicy,
    IdlePolicy,
    LLMAgent,
    LLMEvaluator,
    LLMGenerator,
    LLMNegotiator,
    LLMReflector,
    LLMSubSkillPlanner,
    LLMTeammate,
    OfflineReasoner,
    RandomPolicy,
    StagedPlanner,
    TidyingUp,
    placement_table,
)
from adhoc.testing.policy_contract import PolicyContract


def irot() -> LLMAgent:
    model = OfflineReasoner(placement_table())
    planner = StagedPlanner(LLMGenerator(model), LLMEvaluator(model), LLMReflector(model), TidyingUp().legal)
    return LLMAgent(planner, LLMSubSkillPlanner(model))


def llm_teammate() -> LLMTeammate:
    model = OfflineReasoner(placement_table())
    return LLMTeammate(LLMNegotiator(model, legal=TidyingUp().legal), LLMSubSkillPlanner(model))


class TestIdlePolicy(PolicyContract):
    make = IdlePolicy


class TestRandomPolicy(PolicyContract):
    make = RandomPolicy


class TestHeuristicMember(PolicyContract):
    make = HeuristicPolicy


class TestHeuristicNewcomer(PolicyContract):
    make = staticmethod(lambda: HeuristicPolicy(member=False))


class TestLLMAgent(PolicyContract):
    make = staticmethod(irot)


class TestLLMTeammate(PolicyContract):
    make = staticmethod(llm_teammate)
