"""Trying beliefs: which type does PLASTIC take a team for, in houses that took no part in the training."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from adhoc.agents.plastic.plastic_policy import PlasticPolicy
from adhoc.dataset.making.parallel import Progress, in_processes
from adhoc.evaluation.episode import run_episode
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.training.plastic_teams import TeamType
from adhoc.training.training_houses import HouseDraw, scenarios_of
from adhoc.worlds.pybullet_world import PyBulletWorld
from adhoc.worlds.world import World

LOOK_ALIKES = frozenset({"heuristic", "learned"})
"""The learned team imitates an expert that divides the work as the heuristic team does: what its members do
in public is the same. Trials are counted with and without telling the two apart."""


@dataclass(frozen=True)
class Trial:
    """One episode beside a team of a known type."""

    true_type: str
    beliefs: Mapping[str, float]
    """At the end."""
    steps: int
    """Since the newcomer joined."""
    success: bool

    @property
    def taken_for(self) -> str:
        """The type believed in most at the end."""
        return max(self.beliefs, key=self.beliefs.__getitem__)

    @property
    def found(self) -> bool:
        """Whether that is the true type."""
        return self.taken_for == self.true_type

    @property
    def nearly_found(self) -> bool:
        """The same, but for look-alikes."""
        return self.found or {self.taken_for, self.true_type} <= LOOK_ALIKES


@dataclass(frozen=True)
class TrialSettings:
    """How trials are run: with which library and learned team, and how long."""

    checkpoints: str | None = None
    team_checkpoints: str | None = None
    eta: float = 0.5
    max_steps: int = 500


def try_beliefs(
    types: Mapping[str, TeamType],
    draws: Sequence[HouseDraw],
    settings: TrialSettings,
    workers: int,
    progress: Progress,
) -> list[Trial]:
    """One episode in each house beside each type; the newcomer is there from the first step."""
    work = partial(_trials_in, types, settings)
    parts = in_processes(work, draws, workers, lambda it: it.rooms, lambda it: it.house_id, progress)
    return [trial for part in parts for trial in part]


def run_trial(
    world: World, draw: HouseDraw, name: str, team: TeamType, settings: TrialSettings
) -> Iterable[Trial]:
    """The trial of one type in one house; none where the house has no room for a task."""
    for scenario in scenarios_of(world, draw, 1):
        newcomer = PlasticPolicy(None, settings.eta, settings.checkpoints, None, settings.team_checkpoints)
        members = [team.make() for _ in scenario.team]
        result = run_episode(world, scenario, TidyingUp(), members, newcomer, max_steps=settings.max_steps)
        yield Trial(name, newcomer.beliefs, result.steps, result.success)


def report_of(trials: Sequence[Trial], types: Iterable[str], long: int = 100) -> dict[str, Any]:
    """For a model card: how often the true type was believed in most, and what it was taken for.

    `known` are the types of the library: `types`, and others whose files were there already. Episodes of at
    least `long` steps are counted apart: short ones show little.
    """
    types = tuple(types)
    others = {name for trial in trials for name in trial.beliefs} - set(types)
    known = (*types, *sorted(others))
    confusion = {
        true: {taken: sum(it.true_type == true and it.taken_for == taken for it in trials) for taken in known}
        for true in types
    }
    patient = [trial for trial in trials if trial.steps >= long]
    return {
        "known": list(known),
        "episodes": len(trials),
        "found": _mean([it.found for it in trials]),
        "nearly_found": _mean([it.nearly_found for it in trials]),
        "belief_in_true_type": _mean([it.beliefs[it.true_type] for it in trials]),
        "long": long,
        "long_episodes": len(patient),
        "found_in_long": _mean([it.found for it in patient]),
        "nearly_found_in_long": _mean([it.nearly_found for it in patient]),
        "successes": sum(it.success for it in trials),
        "confusion": confusion,
    }


def _trials_in(types: Mapping[str, TeamType], settings: TrialSettings, draw: HouseDraw) -> list[Trial]:
    world = PyBulletWorld()
    try:
        return [
            trial for name, team in types.items() for trial in run_trial(world, draw, name, team, settings)
        ]
    finally:
        world.close()


def _mean(numbers: Sequence[float]) -> float | None:
    return round(sum(numbers) / len(numbers), 4) if numbers else None
