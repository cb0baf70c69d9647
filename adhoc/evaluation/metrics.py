"""The paper's five metrics (section Evaluation Metrics), from finished episodes to a row of a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum

from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.episode_result import EpisodeResult


class FailedShare(str, Enum):
    """What a failed episode counts for the newcomer's share of #AS.

    The paper says 'the action step of each agent is the maximum number of steps' and leaves open what
    that is for a robot that came later. Its tables fall by 30 action steps for every 50 steps of later
    joining, with a team that fails 85% of the time: far more than counting every failure in full would
    allow. So the default counts the newcomer's steps from its joining here too.
    """

    FROM_JOINING = "from_joining"
    """`max_steps - join_step`"""
    FULL = "full"
    """`max_steps`, whenever it joined"""


@dataclass(frozen=True)
class EpisodeScore:
    """One episode's terms of the five averages."""

    success: bool
    """R of %Suc: all misplaced objects re-placed."""
    partial_success: float
    """K_suc / K of %PS, in 0..1."""
    temporal_steps: int
    """TS of #TS: steps until success, `max_steps` if there was none."""
    action_steps: int
    """AS of #AS: battery steps of all robots until success; for a failure `max_steps` for each."""
    efficiency: float | None
    """The term of %SE, in 0..1; None for the team alone."""


@dataclass(frozen=True)
class Scores:
    """One row of a table: means over `episodes` episodes, the percentages in 0..100."""

    episodes: int
    success: float
    partial_success: float
    temporal_steps: float
    action_steps: float
    efficiency: float | None


@dataclass(frozen=True)
class Improvement:
    """What the brackets of the paper's tables hold: percent of the team's own value.

    Positive is better: the rise of %Suc and %PS, the decline of #TS and #AS. None where the team's own
    value is zero and the new one is not.
    """

    success: float | None
    partial_success: float | None
    temporal_steps: float | None
    action_steps: float | None


def score(
    result: EpisodeResult,
    reference_temporal_steps: int | None = None,
    failed_share: FailedShare = FailedShare.FROM_JOINING,
) -> EpisodeScore:
    """Score one episode; `reference_temporal_steps` is TS of the team alone in the same scenario.

    A newcomer that never joined has no share in #AS.
    """
    steps = temporal_steps(result.success, result.steps, result.max_steps)
    return EpisodeScore(
        success=result.success,
        partial_success=partial_success(len(result.replaced), len(result.watched)),
        temporal_steps=steps,
        action_steps=action_steps(
            result.success,
            result.agent_steps,
            len(result.scenario.team),
            result.max_steps,
            result.join_step if result.joined else None,
            failed_share,
        ),
        efficiency=None
        if reference_temporal_steps is None
        else efficiency(reference_temporal_steps, steps, result.success),
    )


def partial_success(replaced: int, misplaced: int) -> float:
    """The %PS term: the share of the misplaced objects that were re-placed."""
    return replaced / misplaced


def temporal_steps(success: bool, steps: int, max_steps: int) -> int:
    """The #TS term: the steps that were run until success, `max_steps` if there was none."""
    return steps if success else max_steps


def action_steps(
    success: bool,
    agent_steps: Mapping[str, int],
    teammates: int,
    max_steps: int,
    joined_at: int | None,
    failed_share: FailedShare,
) -> int:
    """The #AS term: the battery steps of all robots until success; for a failure `max_steps` for each.

    `joined_at` is the step at which the newcomer joined, None if it did not; `failed_share` says what a
    failure counts for it.
    """
    if success:
        return sum(agent_steps.values())
    total = max_steps * teammates
    if joined_at is not None:
        total += max_steps - (joined_at if failed_share is FailedShare.FROM_JOINING else 0)
    return total


def efficiency(team_steps: int, ad_hoc_steps: int, success: bool) -> float:
    """The SE term: max(0, TS_team - TS_adhoc) / TS_team * R_adhoc; 0 if the team had nothing to do."""
    if not success or team_steps == 0:
        return 0.0
    return max(0, team_steps - ad_hoc_steps) / team_steps


def average(scores: Sequence[EpisodeScore]) -> Scores:
    """The means over episodes; %SE over those that have a term. Raises ConfigurationError if empty."""
    return average_columns(
        [one.success for one in scores],
        [one.partial_success for one in scores],
        [one.temporal_steps for one in scores],
        [one.action_steps for one in scores],
        [one.efficiency for one in scores],
    )


def average_columns(
    success: Sequence[bool],
    partial_success: Sequence[float],
    temporal_steps: Sequence[int],
    action_steps: Sequence[int],
    efficiency: Sequence[float | None],
) -> Scores:
    """The same of episodes' terms metric by metric, each in the order of the episodes."""
    if not success:
        raise ConfigurationError("no episodes to average")
    terms = [term for term in efficiency if term is not None]
    return Scores(
        episodes=len(success),
        success=100 * _mean(success),
        partial_success=100 * _mean(partial_success),
        temporal_steps=_mean(temporal_steps),
        action_steps=_mean(action_steps),
        efficiency=100 * _mean(terms) if terms else None,
    )


def improvement(team: Scores, ad_hoc: Scores) -> Improvement:
    """The bracketed percentages of one row, over the same scenarios with and without the newcomer."""
    return Improvement(
        success=_rise(team.success, ad_hoc.success),
        partial_success=_rise(team.partial_success, ad_hoc.partial_success),
        temporal_steps=_decline(team.temporal_steps, ad_hoc.temporal_steps),
        action_steps=_decline(team.action_steps, ad_hoc.action_steps),
    )


def _rise(before: float, after: float) -> float | None:
    if before == 0:
        return 0.0 if after == 0 else None
    return 100 * (after - before) / before


def _decline(before: float, after: float) -> float | None:
    rise = _rise(before, after)
    return None if rise is None else 0.0 - rise


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values)
