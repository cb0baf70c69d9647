"""Whether records are of the runs that the folder's provenance describes, and are all that were planned."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from adhoc.core.errors import AdhocError, RecordError
from adhoc.evaluation.records import FILE_NAME, Record
from adhoc.experiments.provenance.file import (
    FOLDER_NAME,
    Provenance,
    provenance_files,
    read_provenance,
)
from adhoc.experiments.verifying.finding import Finding, NumberedRecord, Trouble, expected

SHOWN = 3


@dataclass(frozen=True)
class PlannedEpisode:
    """What the record of an episode must say by the configuration of its run."""

    task_id: str
    fields: Mapping[str, Any]


@dataclass(frozen=True)
class RunPlan:
    """The episodes of a run by its configuration."""

    possible: Mapping[str, PlannedEpisode]
    """All its episodes by their ids."""
    wanted: frozenset[str]
    """Those of them that its sessions were to run: they may have been limited, or parts of the whole."""


MakePlan = Callable[[Provenance], RunPlan]
"""Plans a run again from what its provenance says; raises AdhocError if that cannot be done here."""


def origin_findings(
    folder: Path, records: Sequence[NumberedRecord], failed: Sequence[str], make_plan: MakePlan
) -> Iterator[Finding]:
    """What is wrong with provenance, and with the records by it.

    Args:
        folder: The run folder.
        records: The intact ones.
        failed: The ids of episodes whose failure the folder tells already.
        make_plan: Called once for every run.
    """
    yield from _without_origin(records)
    runs: dict[str, Provenance | None] = {}
    for path in provenance_files(folder):
        runs[path.stem] = None
        try:
            runs[path.stem] = read_provenance(folder, path.stem)
        except RecordError as error:
            yield Finding(f"{FOLDER_NAME}/{path.name}", None, "", _after_path(error, path))
    for it in records:
        run = it.record.get("run")
        if run is not None and run not in runs:
            yield it.finding(("run", f"is {run!r}; there is no provenance/{run}.json in this folder"))
    there = {it.record["episode_id"] for it in records}
    known = {run: facts for run, facts in runs.items() if facts is not None}
    yield from _states(known)
    for run, facts in known.items():
        mine = [it for it in records if it.record.get("run") == run]
        yield from _by_plan(run, facts, mine, there, frozenset(failed), make_plan)


def _without_origin(records: Sequence[NumberedRecord]) -> Iterator[Finding]:
    without = [it.line for it in records if it.record.get("run") is None]
    if without:
        yield Finding(
            FILE_NAME,
            without[0],
            "run",
            f"{len(without)} records do not say which run they are of; nobody can tell whether they are all",
        )


def _states(runs: Mapping[str, Provenance]) -> Iterator[Finding]:
    """Several states of the code are no fault: a study is run over weeks."""
    states: dict[str, list[str]] = {}
    for run, facts in runs.items():
        git = facts.code.get("git") or {}
        state = f"version {facts.code.get('library_version')}"
        if git:
            changes = git.get("changes_sha256")
            state += f", commit {str(git.get('commit'))[:12]}" + (
                f" with changes {changes[:12]}" if changes else ""
            )
        states.setdefault(state, []).append(run)
    if len(states) > 1:
        told = "; ".join(f"{state} ({_some(runs)})" for state, runs in sorted(states.items()))
        yield Finding(
            FOLDER_NAME, None, "code", f"the runs are of {len(states)} states of the code: {told}", False
        )


def _by_plan(
    run: str,
    facts: Provenance,
    records: Sequence[NumberedRecord],
    there: set[str],
    failed: frozenset[str],
    make_plan: MakePlan,
) -> Iterator[Finding]:
    file = f"{FOLDER_NAME}/{run}.json"
    try:
        plan = make_plan(facts)
    except AdhocError as error:
        yield Finding(file, None, "config", f"the run cannot be planned again here: {error}")
        return
    for it in records:
        yield from map(it.finding, _against(it.record, plan, run))
    if not plan.wanted:
        yield Finding(
            file, None, "", "only parts of the run were run; merged, they show whether all is there", False
        )
    missing = sorted(plan.wanted - there - failed)
    if missing:
        yield Finding(
            file,
            None,
            "",
            f"{len(missing)} of {len(plan.wanted)} planned episodes are missing: {_some(missing)}",
        )


def _against(record: Record, plan: RunPlan, run: str) -> Iterator[Trouble]:
    planned = plan.possible.get(record["episode_id"])
    if planned is None:
        yield "episode_id", f"is none of the episodes of run {run}"
        return
    for field, wanted in (("task_id", planned.task_id), *planned.fields.items()):
        yield from expected(field, record.get(field), wanted, f"by the configuration of run {run} it")


def _some(names: Sequence[str]) -> str:
    return ", ".join(names[:SHOWN]) + (f" and {len(names) - SHOWN} more" if len(names) > SHOWN else "")


def _after_path(error: Exception, path: Path) -> str:
    return str(error).removeprefix(f"{path}: ")
