"""Running some episodes of a folder again, and comparing every field of their records."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from adhoc.cli.verify_plan import RebuiltRun
from adhoc.core.errors import AdhocError, RecordError
from adhoc.core.streams import stream
from adhoc.evaluation.episode_key import EpisodeKey
from adhoc.evaluation.keyed_episode import models_of, run_keyed
from adhoc.evaluation.llm_field import stage_counts
from adhoc.evaluation.recording import make_record
from adhoc.evaluation.records import FILE_NAME, Record, checked_part
from adhoc.experiments.verifying.finding import Finding, NumberedRecord
from adhoc.reporting.pairing import alone_records, pair_key

MOST_SHOWN = 5
SHOWN = 60

Rebuild = Callable[[str], RebuiltRun]
"""Builds a run of the folder again, by its id."""


def chosen(records: Sequence[NumberedRecord], count: int, seed: int) -> list[NumberedRecord]:
    """So many records drawn at random, in their order; all if there are no more."""
    generator = stream(seed, "verify", "replay")
    places = generator.permutation(len(records))[:count]
    return [records[place] for place in sorted(map(int, places))]


def replay_findings(
    folder: Path, picked: Sequence[NumberedRecord], records: Sequence[NumberedRecord], rebuild: Rebuild
) -> Iterator[Finding | None]:
    """What differs when the picked records' episodes are run again; None for each that is the same.

    A record must equal the new one in all fields that checksums cover.
    """
    alone = alone_records(it.record for it in records)
    for it in picked:
        try:
            now = _run_again(it.record, alone.get(pair_key(it.record)), rebuild)
        except AdhocError as error:
            yield it.finding(("", f"cannot be replayed: {str(error).removeprefix(f'{folder}/')}"))
            continue
        differences = list(_differences(checked_part(it.record), checked_part(now)))
        if not differences:
            yield None
        for field, text in differences[:MOST_SHOWN]:
            yield it.finding((field, text))
        if len(differences) > MOST_SHOWN:
            more = len(differences) - MOST_SHOWN
            yield Finding(FILE_NAME, it.line, "", f"{more} more fields differ when it is run again")


def _run_again(record: Record, alone: Record | None, rebuild: Rebuild) -> Record:
    run = record.get("run")
    if not isinstance(run, str):
        raise RecordError("the record does not say which run it is of (field 'run')")
    rebuilt = rebuild(run)
    task = record["task_id"]
    if task not in rebuilt.positions:
        raise RecordError(f"the benchmark of run {run} has no task {task!r} here")
    comparison = rebuilt.comparison
    kind = next((it for it in comparison.kinds if it.join_step == record["join_step"]), None)
    if kind is None:
        raise RecordError(f"run {run} has no newcomer that joins at step {record['join_step']}")
    if kind.newcomer is not None and alone is None:
        raise RecordError("there is no record of the team alone in the same scenario")
    key = EpisodeKey(comparison.scenarios[rebuilt.positions[task]], kind)
    reference = None if kind.newcomer is None else alone
    result = run_keyed(comparison.world, key, reference)
    return make_record(key, result, reference, stage_counts(models_of(key)), 0.0)


def _differences(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    for field in [*before, *(name for name in now if name not in before)]:
        one, other = before.get(field), now.get(field)
        if one == other and (field in before) == (field in now):
            continue
        if isinstance(one, Mapping) and isinstance(other, Mapping):
            yield from ((f"{field}.{name}", text) for name, text in _differences(one, other))
        else:
            yield field, f"is {_shown(one)}; run again it is {_shown(other)}"


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."
