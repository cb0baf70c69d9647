"""Putting the parts of a run together in one folder."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from adhoc.core.errors import RecordError
from adhoc.core.whole_file import write_whole
from adhoc.evaluation.records import UNFINISHED_NAME, Record, RecordFile, checked_part, writing
from adhoc.experiments.failures import FailureFile
from adhoc.experiments.folder import RunFolder, group_of
from adhoc.experiments.provenance.file import merge_provenance, provenance_files

BESIDE = ("settings", "pictures", "transcripts", "sessions")
"""Folders whose files are copied as they are: those of one name are the same in all parts."""
LEDGER = "ledger"


@dataclass(frozen=True)
class Merged:
    """What came of it."""

    records: int
    """That are in the folder now."""
    new: int
    failures: int


def merge_folders(folder: str | Path, parts: Sequence[str | Path]) -> Merged:
    """Bring the episodes of run folders into another one, which may hold some already.

    The parts stay as they are. Records are written at once: after a crash the folder has the old or the new.
    Recorded calls are copied, each part's file under its own name, and stay one ledger.

    Args:
        folder: Where to; made if need be. Its lock is held by the caller.
        parts: Run folders of the same configuration.

    Raises:
        RecordError: A part is damaged or was never run, an episode is in two folders and differs, or a
            policy was run with several configurations.
    """
    target = Path(folder)
    owners: dict[str, tuple[Path, Record]] = {
        it["episode_id"]: (target, it) for it in RecordFile(target).read()
    }
    before = len(owners)
    for part in map(Path, parts):
        records = RecordFile(part).read()
        if not records and not provenance_files(part):
            raise RecordError(f"{part}: there are no episode records to merge")
        for record in records:
            _add(owners, part, record)
    _check_configurations(owners.values())
    for part in map(Path, parts):
        for name in BESIDE:
            _copy(part / name, target / name)
        _copy_ledger(part / LEDGER, target / LEDGER)
    merge_provenance(target, parts)
    RecordFile(target).replace([record for _, record in owners.values()])
    _merge_unfinished(target, parts, owners)
    failures = _merge_failures(target, parts, owners)
    return Merged(len(owners), len(owners) - before, failures)


def _add(owners: dict[str, tuple[Path, Record]], part: Path, record: Record) -> None:
    there = owners.setdefault(record["episode_id"], (part, record))
    if checked_part(there[1]) != checked_part(record):
        raise RecordError(
            f"{part}: episode {record['episode_id']!r} came out otherwise in {there[0]}; "
            "they cannot be merged"
        )


def _check_configurations(owned: Iterable[tuple[Path, Record]]) -> None:
    """A policy in a folder has one configuration, as in a run (see `RunFolder.recorded`)."""
    first: dict[tuple[str, str, str | None], tuple[Path, Record]] = {}
    for part, record in owned:
        there = first.setdefault(group_of(record), (part, record))
        if there[1]["config_hash"] != record["config_hash"]:
            raise RecordError(
                f"{part}: was made with another configuration of team={record['team']} "
                f"policy={record['policy']} than {there[0]} (config_hash {record['config_hash']} and "
                f"{there[1]['config_hash']}, see their settings folders); they cannot be merged"
            )


def _merge_failures(target: Path, parts: Sequence[str | Path], recorded: Iterable[str]) -> int:
    """Failures of episodes that are recorded nowhere."""
    known, kept = set(recorded), FailureFile(target)
    for part in parts:
        for failure in RunFolder(part).failures:
            if failure.episode_id not in known:
                kept.add(failure)
    for episode_id in known:
        kept.drop(episode_id)
    return len(kept.failures)


def _merge_unfinished(target: Path, parts: Sequence[str | Path], recorded: Iterable[str]) -> None:
    """What became of episodes that a cap cut short and that are recorded nowhere."""
    known = set(recorded)
    kept = {
        str(record["episode_id"]): record
        for folder in (target, *parts)
        for record in RunFolder(folder).unfinished
        if record["episode_id"] not in known
    }
    RecordFile(target, UNFINISHED_NAME).replace(list(kept.values()))


def _copy(source: Path, target: Path) -> None:
    """Files that are not there yet."""
    for path in sorted(source.glob("*")) if source.is_dir() else ():
        to = target / path.name
        if path.is_file() and not to.exists():
            with writing(to):
                write_whole(to, path.read_bytes())


def _copy_ledger(source: Path, target: Path) -> None:
    """A part's ledger files, under names that tell the part."""
    for path in sorted(source.glob("*.jsonl")) if source.is_dir() else ():
        to = target / f"{source.parent.name}-{path.name}"
        if not to.exists() or to.stat().st_size != path.stat().st_size:
            with writing(to):
                write_whole(to, path.read_bytes())
