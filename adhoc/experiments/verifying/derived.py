"""Whether the numbers of one record follow from its other fields, by the definitions of the metrics."""

from __future__ import annotations

import math
from collections.abc import Iterator

from adhoc.evaluation.episode_result import Ending
from adhoc.evaluation.metrics import FailedShare, action_steps, partial_success, temporal_steps
from adhoc.evaluation.recording import HASH_LENGTH, unpack_history
from adhoc.evaluation.records import Record
from adhoc.evaluation.scenario import difficulty_of
from adhoc.experiments.verifying.finding import Trouble, expected
from adhoc.experiments.verifying.form import LLM_SUMS

CENT = 1e-9
"""US dollars by which a sum may differ from its terms, which are rounded."""


def derived_troubles(record: Record) -> Iterator[Trouble]:
    """What does not follow. The record has the form that it should have (`form`)."""
    yield from _ending(record)
    yield from _scores(record)
    yield from _joining(record)
    yield from _history(record)
    yield from _models(record)
    rooms = record["rooms"]
    yield from expected(
        "difficulty", record["difficulty"], difficulty_of(rooms).value, f"that of {rooms} rooms"
    )


def _ending(record: Record) -> Iterator[Trouble]:
    ending, steps, most = Ending(record["ending"]), record["steps"], record["max_steps"]
    replaced, misplaced = record["replaced"], record["misplaced"]
    if replaced > misplaced:
        yield "replaced", f"is {replaced}; there were {misplaced} misplaced objects"
    if steps > most:
        yield "steps", f"is {steps}; max_steps is {most}"
    if ending is Ending.MAX_STEPS and steps < most:
        yield "ending", f"is {ending.value!r} after {steps} of {most} steps"
    all_replaced = replaced == misplaced
    if all_replaced != (ending is Ending.REPLACED) and not (all_replaced and ending is Ending.BUDGET):
        yield "ending", f"is {ending.value!r} with {replaced} of {misplaced} objects re-placed"
    yield from expected(
        "success", record["success"], ending is Ending.REPLACED, f"by ending {ending.value!r} it"
    )
    if (record.get("reached_cap") is not None) != (ending is Ending.BUDGET):
        yield "reached_cap", f"is {record.get('reached_cap')!r} with ending {ending.value!r}"


def _scores(record: Record) -> Iterator[Trouble]:
    success, most = record["success"], record["max_steps"]
    share = partial_success(record["replaced"], record["misplaced"])
    yield from expected("partial_success", float(record["partial_success"]), share, "replaced / misplaced")
    steps = temporal_steps(success, record["steps"], most)
    yield from expected("temporal_steps", record["temporal_steps"], steps, "by steps, success, max_steps it")
    sum_of_steps = action_steps(
        success,
        record["agent_steps"],
        record["teammates"],
        most,
        record["join_step"] if record["joined"] else None,
        FailedShare(record["failed_share"]),
    )
    yield from expected("action_steps", record["action_steps"], sum_of_steps, "the sum over all robots")


def _joining(record: Record) -> Iterator[Trouble]:
    join_step, joined, steps = record["join_step"], record["joined"], record["steps"]
    robots = record["agent_steps"]
    if (join_step is None) != (record["policy"] == "none"):
        yield "join_step", f"is {join_step!r} with policy {record['policy']!r}"
    if joined and (join_step is None or steps < join_step):
        yield "joined", f"is True; join_step is {join_step!r} of {steps} steps"
    if not joined and join_step is not None and steps > join_step:
        yield "joined", f"is False; the episode ran {steps} steps, past join_step {join_step}"
    yield from expected(
        "agent_steps",
        len(robots),
        record["teammates"] + joined,
        "robots by teammates and joined: their number",
    )
    for name, used in robots.items():
        if used > steps:
            yield f"agent_steps.{name}", f"is {used}; the episode ran {steps} steps"
    if (join_step is None) != (record.get("newcomer") is None) and "newcomer" in record:
        yield "newcomer", f"is {record['newcomer']!r}; join_step is {join_step!r}"
    first = record.get("first_help")
    if first is not None and not (joined and 1 <= first <= steps - join_step):
        yield "first_help", f"is {first}; the newcomer was there for {steps - (join_step or 0)} steps"


def _history(record: Record) -> Iterator[Trouble]:
    history = record["history"]
    if (history is None) != (record["join_step"] is not None):
        yield "history", "is kept of the team alone, and of no other episode"
    elif history is not None:
        links = unpack_history(history)
        length = len(history) / HASH_LENGTH
        yield from expected(
            "history", length, record["steps"] + 1, "links, one a step and the first: their number"
        )
        last = links[-1] if links else ""
        yield from expected("history_hash", record["history_hash"], last, "the last link of history")


def _models(record: Record) -> Iterator[Trouble]:
    llm = record["llm"]
    for field in LLM_SUMS:
        total = math.fsum(stage[field] for stage in llm["stages"].values())
        if abs(llm[field] - total) > (CENT if field == "cost_usd" else 0):
            yield f"llm.{field}", f"is {llm[field]!r}; the sum over its stages is {total:g}"
    if llm["calls"] and record["model"] is None:
        yield "model", f"is None; {llm['calls']} calls were made"
