"""From an episode to its record."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from adhoc import __version__
from adhoc.evaluation.common_sense import judgement_counts
from adhoc.evaluation.contender import EpisodeKey
from adhoc.evaluation.episode_result import EpisodeResult
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
