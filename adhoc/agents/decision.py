"""What a decision looked like, for transcripts and inspectors; never an input to anything."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from adhoc.core.calls import Call
from adhoc.core.plans import Candidate, Objection, Plan


def decision_trace(plan: Plan, reason: str) -> dict[str, Any]:
    """A sub-task decision as JSON values: `reason` says what made the robot plan."""
    return {
        "reason": reason,
        "chosen": str(plan.sub_task),
        "fallback": plan.fallback,
        "degraded": list(plan.degraded),
        "rounds": plan.rounds,
        "candidates": [_candidate(candidate) for candidate in plan.candidates],
        "ranking": [_candidate(candidate) for candidate in plan.ranking],
        "predictions": [
            {"teammate": it.teammate, **doing_trace(it.sub_task, it.sub_skill)}
            for it in dict.fromkeys(it for candidate in plan.candidates for it in candidate.predictions)
        ],
        "replies": [{"sender": reply.sender, "text": reply.text} for reply in plan.replies],
        "verdicts": [
            {"sub_task": str(candidate.sub_task), "feasible": verdict.feasible, "reason": verdict.reason}
            for candidate, verdict in plan.verdicts
        ],
    }


def negotiation_trace(
    plan: Plan, raised: Sequence[Objection], against: Sequence[Objection], reason: str
) -> dict[str, Any]:
    """A decision of a team that plans in turn: what the robot objected to, and what it was objected to."""
    return {
        **decision_trace(plan, reason),
        "objections": [_objection(it) for it in raised],
        "objected": [_objection(it) for it in against],
    }


def skill_trace(call: Call, fallback: str | None) -> dict[str, Any]:
    """A sub-skill decision as JSON values."""
    return {"chosen": str(call), "fallback": fallback}


def doing_trace(sub_task: Call | None, sub_skill: Call | None) -> dict[str, str | None]:
    """What a robot is doing at the end of its turn, as JSON values, for `Turn.trace["doing"]`.

    Predictions of others are held against it (`evaluation.predictions`).
    """
    return {
        "sub_task": None if sub_task is None else str(sub_task),
        "sub_skill": None if sub_skill is None else str(sub_skill),
    }


def _objection(objection: Objection) -> dict[str, Any]:
    return {
        "objector": objection.objector,
        "planner": objection.planner,
        "sub_task": None if objection.sub_task is None else str(objection.sub_task),
        "reason": objection.reason,
    }


def _candidate(candidate: Candidate) -> dict[str, Any]:
    return {
        "sub_task": str(candidate.sub_task),
        "rationale": candidate.rationale,
        "score": candidate.score,
    }
