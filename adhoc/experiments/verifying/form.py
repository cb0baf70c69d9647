"""Whether a record has all fields that numbers are derived from, in a form in which they can be."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from adhoc.evaluation.episode_result import Ending
from adhoc.evaluation.metrics import FailedShare
from adhoc.evaluation.records import Record
from adhoc.experiments.verifying.finding import Trouble

COUNTS = ("rooms", "teammates", "misplaced", "max_steps")
"""Whole numbers of at least 1."""
AMOUNTS = ("replaced", "steps", "temporal_steps", "action_steps", "messages")
"""Whole numbers of at least 0."""
TEXTS = ("team_label", "policy_label", "history_hash", "scenario_hash")
CHOICES: Mapping[str, tuple[str, ...]] = {
    "ending": tuple(ending.value for ending in Ending),
    "failed_share": tuple(share.value for share in FailedShare),
}
LLM_SUMS = ("calls", "prompt_tokens", "prefix_tokens", "completion_tokens", "cost_usd", "repaired", "invalid")
"""Sums over all stages in the field `llm`."""


def form_troubles(record: Record) -> Iterator[Trouble]:
    """What of a record cannot be what a run writes. Nothing else can be checked of such a record."""
    for field in (*COUNTS, *AMOUNTS):
        least = 1 if field in COUNTS else 0
        if not _is_whole(record.get(field), least):
            yield field, _told(record, field, f"a whole number of at least {least}")
    for field in TEXTS:
        if not isinstance(record.get(field), str):
            yield field, _told(record, field, "a text")
    for field, choices in CHOICES.items():
        if record.get(field) not in choices:
            yield field, _told(record, field, f"one of {', '.join(choices)}")
    if not isinstance(record.get("joined"), bool):
        yield "joined", _told(record, "joined", "true or false")
    if not isinstance(record.get("history"), (str, type(None))):
        yield "history", _told(record, "history", "a text or null")
    if not _is_whole(record["join_step"], 0) and record["join_step"] is not None:
        yield "join_step", _told(record, "join_step", "a whole number of at least 0 or null")
    robots = record.get("agent_steps")
    if not isinstance(robots, Mapping) or not all(_is_whole(steps, 0) for steps in robots.values()):
        yield "agent_steps", _told(record, "agent_steps", "the steps of every robot")
    if not isinstance(record.get("newcomer"), (Mapping, type(None))):
        yield "newcomer", _told(record, "newcomer", "what the newcomer can do, or null")
    if record.get("first_help") is not None and not _is_whole(record["first_help"], 0):
        yield "first_help", _told(record, "first_help", "a whole number or null")
    yield from _llm_troubles(record["llm"])


def _llm_troubles(llm: Mapping[str, Any]) -> Iterator[Trouble]:
    stages = llm.get("stages")
    if not isinstance(stages, Mapping) or not all(isinstance(it, Mapping) for it in stages.values()):
        yield "llm.stages", f"is {stages!r}; it should be the counts of every stage"
        return
    for name, counts in (("llm", llm), *((f"llm.stages.{stage}", it) for stage, it in stages.items())):
        for field in LLM_SUMS:
            value = counts.get(field)
            if not isinstance(value, (int, float)) or isinstance(value, bool) or value < 0:
                yield f"{name}.{field}", f"is {value!r}; it should be a number of at least 0"


def _told(record: Record, field: str, wanted: str) -> str:
    found = f"is {record[field]!r}" if field in record else "is missing"
    return f"{found}; it should be {wanted}"


def _is_whole(value: object, least: int) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= least
