"""The order in which the paper's tables name teams and policies, by their names in the configuration."""

from __future__ import annotations

from adhoc.evaluation.contender import NO_AD_HOC
from adhoc.reporting.contestants import Contestant, Team

TEAMS = ("heuristic", "learned", "llm")
POLICIES = (NO_AD_HOC, "random", "heuristic", "plastic", "naive", "gpl", "cot", "irot")
FULL_METHOD = "irot"
"""The paper's own policy, which ends its tables; an ablation takes parts of it away."""
ABLATIONS = (
    "no_subtask_planner",
    "irot_no_evaluation_no_reflection",
    "irot_no_evaluation",
    "irot_no_reflection",
)
"""The rows of the ablation table between the team alone and the whole method."""

Order = tuple[int, str, str, str]


def team_order(team: Team) -> Order:
    """Sorts teams: the paper's, then others by name."""
    return (_place(TEAMS, team.name), team.name, team.label, str(team.model))


def policy_order(row: Contestant) -> Order:
    """Sorts the policies of a team: the paper's, then ablations, then others by name."""
    return (_place((*POLICIES, *ABLATIONS), row.policy), row.policy, row.label, str(row.model))


def ablation_order(row: Contestant) -> Order:
    """Sorts the rows of the ablation table, the whole method last."""
    return (_place((*ABLATIONS, FULL_METHOD), row.policy), row.policy, row.label, str(row.model))


def _place(names: tuple[str, ...], name: str) -> int:
    return names.index(name) if name in names else len(names)
