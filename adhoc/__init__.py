"""adhoc: heterogeneous ad hoc teamwork with language models.

Everything that a researcher imports is here, loaded when it is first used:

    from adhoc import Task, CallSpec, LLMAgent, StagedPlanner, run_episode
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_HOMES = {
    "adhoc.core.calls": (
        "Call",
        "CallSpec",
        "Parameter",
        "ParameterKind",
        "SubSkill",
        "SubTask",
        "TaskBrief",
    ),
    "adhoc.core.errors": ("AdhocError", "ModelError", "ReplyError"),
    "adhoc.core.messages": ("Message", "MessageKind", "TeammateView"),
    "adhoc.core.plans": (
        "Assessment",
        "Candidate",
        "Context",
        "Event",
        "Objection",
        "Plan",
        "Proposal",
        "Replan",
        "Verdict",
    ),
    "adhoc.core.streams": ("stream",),
    "adhoc.core.values": (
        "Action",
        "ActionName",
        "ActionResult",
        "Camera",
        "Capability",
        "Failure",
        "Label",
        "ObjectRecord",
        "Observation",
        "Place",
        "Pose",
        "RoomRecord",
    ),
    "adhoc.houses.house": ("House", "HouseObject", "Room"),
    "adhoc.houses.procthor": ("parse_house", "read_house", "read_houses"),
    "adhoc.houses.samples": ("sample_house", "sample_names"),
    "adhoc.llm.counting": ("CountingModel",),
    "adhoc.llm.litellm_model": ("LiteLLMModel",),
    "adhoc.llm.model": ("LanguageModel", "LMRequest", "LMResponse"),
    "adhoc.llm.offline.reasoner": ("OfflineReasoner",),
    "adhoc.llm.scripted": ("ScriptedModel",),
    "adhoc.tasks.common_sense": ("CommonSense",),
    "adhoc.tasks.llm_common_sense": ("LLMCommonSense",),
    "adhoc.tasks.placement": ("PlacementCommonSense", "placement_table"),
    "adhoc.tasks.task": ("Task",),
    "adhoc.tasks.tidying_up": ("TidyingUp",),
    "adhoc.worlds.pybullet_world": ("PyBulletWorld",),
    "adhoc.worlds.world": ("AgentTruth", "ObjectTruth", "World"),
    "adhoc.perception.perception": ("Perception", "PerceptionSettings"),
    "adhoc.skills.library": ("standard_skills",),
    "adhoc.skills.skill": ("Skill", "SkillView"),
    "adhoc.planning.interfaces": (
        "Evaluator",
        "Negotiator",
        "Planner",
        "Reflector",
        "SubSkillPlanner",
        "SubTaskGenerator",
    ),
    "adhoc.planning.evaluate": ("KeepOrder", "LLMEvaluator"),
    "adhoc.planning.generate": ("LLMGenerator",),
    "adhoc.planning.negotiate": ("LLMNegotiator",),
    "adhoc.planning.reflect": ("AcceptFirst", "LLMReflector"),
    "adhoc.planning.staged": ("StagedPlanner",),
    "adhoc.planning.sub_skill": ("LLMSubSkillPlanner",),
    "adhoc.agents.dialects.dialect": ("Adapter", "Dialect"),
    "adhoc.agents.dialects.listening": ("Listener",),
    "adhoc.agents.dialects.speaking": ("Speaking",),
    "adhoc.agents.heuristic": ("HeuristicPolicy",),
    "adhoc.agents.human.policy": ("HumanPolicy",),
    "adhoc.agents.idle": ("IdlePolicy",),
    "adhoc.agents.llm_agent": ("LLMAgent",),
    "adhoc.agents.llm_teammate": ("LLMTeammate",),
    "adhoc.agents.policy": ("Policy", "Turn"),
    "adhoc.agents.random_policy": ("RandomPolicy",),
    "adhoc.evaluation.benchmark": ("Benchmark", "SampleBenchmark"),
    "adhoc.evaluation.contender": ("Conditions", "Contender"),
    "adhoc.evaluation.episode": ("run_episode",),
    "adhoc.evaluation.episode_result": ("EpisodeResult",),
    "adhoc.evaluation.referee": ("PlacementReferee", "Referee"),
    "adhoc.evaluation.ranges": ("Ranges",),
    "adhoc.evaluation.sampling": ("sample_scenario",),
    "adhoc.evaluation.records": ("RecordFile",),
    "adhoc.evaluation.scenario": ("Displacement", "Member", "Scenario"),
    "adhoc.statistics.intervals": ("Interval", "clustered_interval"),
    "adhoc.statistics.many": ("holm",),
    "adhoc.statistics.paired_tests": ("PairedTest", "paired_test"),
    "adhoc.reporting.folders": ("read_folders",),
    "adhoc.reporting.report": ("Report", "make_report"),
    "adhoc.reporting.results": ("Results",),
    "adhoc.experiments.comparison": ("Comparison", "Entrant"),
    "adhoc.experiments.folder": ("RunFolder",),
    "adhoc.experiments.run": ("run_comparison",),
    "adhoc.cli.contestants": ("Components",),
    "adhoc.cli.hydra_groups": ("register_groups",),
    "adhoc.cli.hydra_application": ("run_config",),
}
_HOME_OF = {name: module for module, names in _HOMES.items() for name in names}

__all__ = ["__version__", *sorted(_HOME_OF)]


def __getattr__(name: str) -> Any:
    if name not in _HOME_OF:
        raise AttributeError(f"module 'adhoc' has no attribute {name!r}")
    return getattr(import_module(_HOME_OF[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
