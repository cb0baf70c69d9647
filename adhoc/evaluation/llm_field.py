"""What a record tells about the language model: calls, tokens, money, and how its replies were judged."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from adhoc.core.replies import DUPLICATE, EMPTY, ILLEGAL, TRUNCATED, UNKNOWN_ID, UNREADABLE, Outcome
from adhoc.llm.counting import CountingModel, Counts

JUDGED = (Outcome.VALID.value, Outcome.REPAIRED.value, Outcome.INVALID.value)
"""Every question ends in exactly one of these."""
DIGITS_OF_COST = 12
"""Of US dollars: more than any price of a token has, so that sums of the same costs, added up in the order in
which answers arrived, are never rounded apart."""
_REPORTED = (*JUDGED, ILLEGAL, DUPLICATE, UNKNOWN_ID, EMPTY, TRUNCATED, UNREADABLE)


def stage_counts(models: Iterable[CountingModel]) -> Mapping[str, Counts]:
    """What several models counted since the episode began, by stage."""
    stages: dict[str, Counts] = {}
    for model in models:
        for stage, counts in model.stages.items():
            stages.setdefault(stage, Counts()).add(counts)
    return stages


def llm_field(stages: Mapping[str, Counts]) -> dict[str, Any]:
    """The record's field `llm`: sums over all stages, and each stage of its own.

    `replayed` tells which part of the calls a ledger answered. It is no part of the stages: all that they
    hold is the same when a run is resumed or replayed.
    """
    total = Counts()
    for counts in stages.values():
        total.add(counts)
    return {
        **_usage(total),
        "left_out_messages": total.left_out_messages,
        "replayed": total.replayed,
        "repaired": total.repaired,
        "invalid": total.invalid,
        "outcomes": dict(sorted(total.outcomes.items())),
        "stages": {stage: {**_usage(it), **_judged(it)} for stage, it in sorted(stages.items())},
    }


def _usage(counts: Counts) -> dict[str, Any]:
    return {
        "calls": counts.calls,
        "prompt_tokens": counts.prompt_tokens,
        "prefix_tokens": counts.prefix_tokens,
        "completion_tokens": counts.completion_tokens,
        "cost_usd": round(counts.cost_usd, DIGITS_OF_COST),
    }


def _judged(counts: Counts) -> dict[str, int]:
    return {outcome.replace(" ", "_"): counts.outcomes[outcome] for outcome in _REPORTED}
