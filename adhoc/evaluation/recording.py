"""From an episode to its record."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from adhoc import __version__
from adhoc.evaluation.common_sense import judgement_counts
from adhoc.evaluation.contender import ALONE, Contender
from adhoc.evaluation.episode_key import EpisodeKey
from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.first_help import first_help
from adhoc.evaluation.llm_field import llm_field
from adhoc.evaluation.metrics import score
from adhoc.evaluation.records import Record
from adhoc.llm.counting import Counts

HASH_LENGTH = 16


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
    scenario, kind = key.scenario, key.kind
    reference = None if alone is None else int(alone["temporal_steps"])
    scored = score(result, reference, kind.conditions.failed_share)
    return {
        "episode_id": key.id,
        "task_id": scenario.id,
        "house_id": scenario.house.id,
        "rooms": len(scenario.house.rooms),
        "difficulty": scenario.difficulty.value,
        "teammates": len(scenario.team),
        "misplaced": len(result.watched),
        "team": kind.conditions.team_name,
        "team_label": kind.conditions.team_label,
        "imperfections": kind.conditions.imperfections.settings or None,
        "broke_down": dict(result.broke_down),
        "left": dict(result.left),
        "policy": kind.policy,
        "policy_label": newcomer_label(kind.newcomer),
        "join_step": kind.join_step,
        "joined": result.joined,
        "joined_at": None if result.joined_at is None else [result.joined_at.x, result.joined_at.y],
        "joined_elsewhere": result.moved,
        "newcomer": None if kind.newcomer is None else asdict(scenario.newcomer.capability),
        "first_help": _first_help(result),
        "seed": scenario.seed,
        "model": kind.model,
        "team_model": kind.team_model,
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
        "predictions": result.trace.foresight.counts(kind.newcomer is None, kind.conditions.predicted_within),
        "person": asdict(result.trace.people),
        "common_sense": judgement_counts(kind.conditions.task.common_sense),
        "history_hash": result.history_hash,
        "history": pack_history(result.history) if kind.newcomer is None else None,
        "scenario_hash": scenario.content_hash(),
        "config_hash": kind.config_hash,
        "failed_share": kind.conditions.failed_share.value,
        "library_version": __version__,
        "run": kind.run,
        "wall_s": round(wall_s, 3),
    }


def _first_help(result: EpisodeResult) -> int | None:
    if not result.joined or result.join_step is None:
        return None
    return first_help(result.trace.events, result.scenario.newcomer.name, result.join_step)


def newcomer_label(newcomer: Contender | None) -> str:
    """The `policy_label` of an episode with that newcomer, or of the team alone."""
    return ALONE if newcomer is None else newcomer.label


def pack_history(links: Sequence[str]) -> str:
    """The hashes of all steps as one string: records of the team alone keep them for later newcomers."""
    return "".join(links)


def unpack_history(packed: str) -> list[str]:
    """The inverse of `pack_history`."""
    return [packed[start : start + HASH_LENGTH] for start in range(0, len(packed), HASH_LENGTH)]
