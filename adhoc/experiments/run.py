"""Running a comparison: every scenario with the team alone and with a newcomer, each episode once."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Protocol

from adhoc import __version__
from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.common_sense import judgement_counts
from adhoc.evaluation.contender import Conditions, Contender, EpisodeKey
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.lazy_scenarios import scenario_ids
from adhoc.evaluation.llm_field import llm_field, stage_counts
from adhoc.evaluation.metrics import score
from adhoc.evaluation.records import Record
from adhoc.evaluation.scenario import Scenario
from adhoc.experiments.folder import EpisodeStore
from adhoc.llm.counting import CountingModel, Counts
from adhoc.worlds.world import World

Artifact = Callable[[EpisodeKey, EpisodeResult, Record], None]
"""Draws or writes something of a fresh episode; called before its record is stored."""

HASH_LENGTH = 16


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


def make_record(
    key: EpisodeKey,
    result: EpisodeResult,
    alone: Record | None,
    stages: Mapping[str, Counts],
    wall_s: float,
) -> dict[str, Any]:
    """The record of one episode.

    `alone` is the record of the team alone in the same scenario, `stages` what the language models counted.
    """
    scenario = key.scenario
    reference = None if alone is None else int(alone["temporal_steps"])
    scored = score(result, reference, key.conditions.failed_share)
    return {
        "episode_id": key.id,
        "task_id": scenario.id,
        "house_id": scenario.house.id,
        "rooms": len(scenario.house.rooms),
        "difficulty": scenario.difficulty.value,
        "teammates": len(scenario.team),
        "misplaced": len(result.watched),
        "team": key.conditions.team_name,
        "team_label": key.conditions.team_label,
        "imperfections": key.conditions.imperfections.settings or None,
        "broke_down": dict(result.broke_down),
        "left": dict(result.left),
        "policy": key.policy,
        "policy_label": "No ad hoc" if key.newcomer is None else key.newcomer.label,
        "join_step": key.join_step,
        "joined": result.joined,
        "joined_at": None if result.joined_at is None else [result.joined_at.x, result.joined_at.y],
        "joined_elsewhere": result.moved,
        "seed": scenario.seed,
        "model": key.model,
        "team_model": key.team_model,
        "max_steps": result.max_steps,
        "steps": result.steps,
        "ending": result.ending.value,
        "reached_cap": None if result.budget is None else result.budget.cap,
        "success": scored.success,
        "replaced": len(result.replaced),
        "partial_success": scored.partial_success,
        "temporal_steps": scored.temporal_steps,
        "action_steps": scored.action_steps,
        "agent_steps": dict(result.agent_steps),
        "reference_temporal_steps": reference,
        "efficiency": scored.efficiency,
        "messages": result.messages,
        "undeliverable": result.undeliverable,
        "deliveries": asdict(result.deliveries),
        "messages_understood": dict(sorted(result.understood.items())),
        "messages_not_understood": result.not_understood,
        "llm": llm_field(stages),
        "planning": asdict(result.trace.planning),
        "team_planning": asdict(result.trace.team_planning),
        "predictions": result.trace.foresight.counts(key.newcomer is None, key.conditions.predicted_within),
        "person": asdict(result.trace.people),
        "common_sense": judgement_counts(key.conditions.task.common_sense),
        "history_hash": result.history_hash,
        "history": pack_history(result.history) if key.newcomer is None else None,
        "scenario_hash": scenario.content_hash(),
        "config_hash": key.config_hash,
        "failed_share": key.conditions.failed_share.value,
        "library_version": __version__,
        "wall_s": round(wall_s, 3),
    }


def pack_history(links: Sequence[str]) -> str:
    """The hashes of all steps as one string: records of the team alone keep them for later newcomers."""
    return "".join(links)


def unpack_history(packed: str) -> list[str]:
    """The inverse of `pack_history`."""
    return [packed[start : start + HASH_LENGTH] for start in range(0, len(packed), HASH_LENGTH)]


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
