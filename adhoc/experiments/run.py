"""Running a comparison: every scenario with the team alone and with a newcomer, each episode once."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.contender import Conditions, Contender, EpisodeKey
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.lazy_scenarios import scenario_ids
from adhoc.evaluation.llm_field import stage_counts
from adhoc.evaluation.recording import make_record, unpack_history
from adhoc.evaluation.records import Record
from adhoc.evaluation.scenario import Scenario
from adhoc.experiments.folder import EpisodeStore
from adhoc.llm.counting import CountingModel
from adhoc.worlds.world import World

Artifact = Callable[[EpisodeKey, EpisodeResult, Record], None]
"""Draws or writes something of a fresh episode; called before its record is stored."""


class Progress(Protocol):
    """What is told while episodes are run."""

    def begin(self, episodes: int) -> None:
        """So many episodes will be run or skipped."""

    def skipped(self, record: Record) -> None:
        """An episode was run before."""

    def started(self, episode_id: str) -> None:
        """An episode is being run."""

    def finished(self, record: Record) -> None:
        """It is done, and its record stored."""


@dataclass(frozen=True)
class RunSummary:
    """What one call of `run_comparison` did."""

    run: int
    skipped: int


def run_comparison(
    world: World,
    scenarios: Sequence[Scenario],
    conditions: Conditions,
    newcomer: Contender | None,
    join_step: int,
    folder: EpisodeStore,
    progress: Progress,
    artifacts: Sequence[Artifact] = (),
) -> RunSummary:
    """Run what `folder` does not hold yet: in each scenario the team alone, then the team and the newcomer.

    The episode of the team alone is run once and serves every newcomer and every joining step, also those
    of later calls. An episode with a newcomer is checked to share its past (EpisodeError if not).

    Args:
        world: Any world; it is reset for every episode.
        scenarios: What to run, in order; lazy ones are loaded one at a time.
        conditions: Task, team and limits.
        newcomer: The ad hoc policy; None runs the team alone only.
        join_step: When the newcomer joins.
        folder: Where records are and go.
        progress: Is told what happens.
        artifacts: Called with every fresh episode.

    Raises:
        ConfigurationError: No scenarios, or two of one id.
        RecordError: The folder is damaged or belongs to another configuration.
        BudgetReached: A cap of the run was reached. What became of the episode is in `unfinished.jsonl`;
            it is run again by a later call.
    """
    check_ids(scenario_ids(scenarios))
    run = 0

    def perform(key: EpisodeKey, alone: Record | None) -> Record:
        nonlocal run
        record = folder.find(key)
        if record is not None:
            progress.skipped(record)
            return record
        progress.started(key.id)
        record = _run_one(world, key, alone, folder, artifacts)
        progress.finished(record)
        run += 1
        return record

    planned = len(scenarios) * (1 if newcomer is None else 2)
    progress.begin(planned)
    for scenario in scenarios:
        alone = perform(EpisodeKey(scenario, conditions), None)
        if newcomer is not None:
            perform(EpisodeKey(scenario, conditions, newcomer, join_step), alone)
    return RunSummary(run, planned - run)


def _run_one(
    world: World,
    key: EpisodeKey,
    alone: Record | None,
    folder: EpisodeStore,
    artifacts: Sequence[Artifact],
) -> Record:
    conditions, scenario = key.conditions, key.scenario
    started = time.perf_counter()
    _begin(key)
    result = run_episode(
        world,
        scenario,
        conditions.task,
        [conditions.team.make(seat) for seat in range(len(scenario.team))],
        None if key.newcomer is None else key.newcomer.make(len(scenario.team)),
        0 if key.join_step is None else key.join_step,
        conditions.max_steps,
        conditions.referee,
        None if alone is None else unpack_history(alone["history"]),
        conditions.imperfections,
    )
    wall = time.perf_counter() - started
    record = make_record(key, result, alone, stage_counts(_models(key)), wall)
    if result.budget is not None and result.budget.scope == "run":
        folder.add_unfinished(key, record)
        raise result.budget
    for artifact in artifacts:
        artifact(key, result, record)
    folder.add(key, record)
    return record


def _models(key: EpisodeKey) -> list[CountingModel]:
    """The models of team, newcomer and task; a shared one once."""
    contenders = [key.conditions.team, *([] if key.newcomer is None else [key.newcomer])]
    asked = [key.conditions.model, *(one.model for one in contenders)]
    return list({id(model): model for model in asked if model is not None}.values())


def _begin(key: EpisodeKey) -> None:
    for model in _models(key):
        model.begin_episode(key.id, key.scenario.seed)


def check_ids(ids: Sequence[str]) -> None:
    """Raise ConfigurationError if there are no scenarios, or two of one id."""
    if not ids:
        raise ConfigurationError("there are no scenarios to run: the benchmark is empty, or limit is 0")
    if len(set(ids)) != len(ids):
        raise ConfigurationError(f"scenario ids must be unique: {_repeated(ids)}")


def _repeated(ids: Sequence[str]) -> str:
    return ", ".join(repr(name) for name, count in sorted(Counter(ids).items()) if count > 1)
