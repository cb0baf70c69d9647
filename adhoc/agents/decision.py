"""What a decision looked like, for transcripts and inspectors; never an input to anything."""

from __future__ import annotations

from typing import Any

from adhoc.core.calls import Call
from adhoc.core.plans import Candidate, Plan


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
        "replies": [{"sender": reply.sender, "text": reply.text} for reply in plan.replies],
        "verdicts": [
            {"sub_task": str(candidate.sub_task), "feasible": verdict.feasible, "reason": verdict.reason}
            for candidate, verdict in plan.verdicts
        ],
    }


def skill_trace(call: Call, fallback: str | None) -> dict[str, Any]:
    """A sub-skill decision as JSON values."""
    return {"chosen": str(call), "fallback": fallback}


def _candidate(candidate: Candidate) -> dict[str, Any]:
    return {
        "sub_task": str(candidate.sub_task),
        "rationale": candidate.rationale,
        "score": candidate.score,
    }
