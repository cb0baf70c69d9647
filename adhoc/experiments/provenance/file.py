"""The provenance file of a run: one JSON file that is written whole, and only added to."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from adhoc.core.errors import RecordError
from adhoc.core.whole_file import write_whole
from adhoc.evaluation.records import writing

FOLDER_NAME = "provenance"
FORMAT, VERSION = "adhoc provenance", 1
HASH_LENGTH = 16
CHECKSUM = "sha256"
"""The field with the hash of all others, but for the names of hosts, which one may want to take out."""
NOT_DECIDING = (
    "out",
    "workers",
    "executor",
    "shard",
    "limit",
    "progress",
    "dry_run",
    "pictures",
    "transcript",
    "fail_on_error",
    "ledger",
    "retry",
    "rate",
    "budget.run",
)
"""Keys of a configuration that decide where, how fast and how much is run, but not what becomes of an
episode."""
_WHOLE = "1/1"
_PARTS = ("config", "code", "data")


@dataclass(frozen=True)
class Provenance:
    """What decided the records whose field `run` names this file."""

    config: Mapping[str, Any]
    """The composed configuration, plain values; paths below the home folder begin with `~`."""
    code: Mapping[str, Any]
    """See `code_state.code_state`; `modules` are hashes of code outside the library."""
    data: Mapping[str, Any]
    """`prompts`, and what the components say of themselves (`benchmark`, checkpoints); `files` are those
    outside the library that the configuration names."""
    sessions: Sequence[Mapping[str, Any]] = ()
    """When, where and by which command it was run, one entry for each time."""

    @property
    def run(self) -> str:
        """The run's id: a hash of what decides its episodes. No time, no host and no run folder is in it, so
        the same run on another machine has the same id."""
        git = self.code.get("git")
        deciding = {
            "config": _without(self.config, NOT_DECIDING),
            "code": {**self.code, "git": git and {name: git[name] for name in ("commit", "changes_sha256")}},
            "data": {**self.data, "files": {name: it["sha256"] for name, it in self.data["files"].items()}},
        }
        text = json.dumps(deciding, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:HASH_LENGTH]


def provenance_path(folder: str | Path, run: str) -> Path:
    """Where the provenance of a run is."""
    return Path(folder) / FOLDER_NAME / f"{run}.json"


def read_provenance(folder: str | Path, run: str) -> Provenance:
    """The provenance of a run. Raises RecordError, naming file and field, if it is missing, damaged, of
    another version, or not what its name says."""
    path = provenance_path(folder, run)
    try:
        value = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise RecordError(f"{path}: there is no such file; it should say what decided run {run!r}") from None
    except (OSError, ValueError, RecursionError) as error:
        raise RecordError(f"{path}: cannot be read as JSON: {error}") from error
    found = _checked(value, path)
    if found.run != run or value.get("run") != run:
        raise RecordError(
            f"{path}: run: what it says has the hash {found.run}; by its name it is {run}: it was edited"
        )
    if value.get(CHECKSUM) != _checksum(value):
        raise RecordError(f"{path}: {CHECKSUM}: is not that of what it says: it was edited, or is damaged")
    return found


def provenance_files(folder: str | Path) -> list[Path]:
    """The provenance files of a run folder, sorted."""
    return sorted((Path(folder) / FOLDER_NAME).glob("*.json"))


def unfinished_runs(folder: str | Path) -> list[str]:
    """The runs of a folder whose latest session did not do all that it was to do, sorted; of a run in shards,
    if one of them did not. Records of older releases may not tell, and count as finished."""
    return [
        path.stem for path in provenance_files(folder) if not _is_finished(read_provenance(folder, path.stem))
    ]


def _is_finished(facts: Provenance) -> bool:
    latest: dict[str, Mapping[str, Any]] = {}
    for session in sorted(facts.sessions, key=lambda it: str(it["started"])):
        options = session.get("options")
        shard = str(options.get("shard", _WHOLE)) if isinstance(options, Mapping) else _WHOLE
        latest[shard] = session
        if shard == _WHOLE:
            latest = {shard: session}
    return all(session.get("complete", True) is True for session in latest.values())


def write_provenance(folder: str | Path, facts: Provenance) -> str:
    """Write the provenance of a run, and return the run's id.

    If there is a file of that run already, the sessions that it lacks are added to it; nothing else in it
    changes. After a kill the file is the old one or the new one. Hold the lock of the run folder meanwhile
    (`folder_lock.locked`): of two processes that write at once one may lose a session.

    Raises:
        RecordError: A file is there that is not of this run, or none can be written.
    """
    path = provenance_path(folder, facts.run)
    if path.exists():
        there = read_provenance(folder, facts.run)
        new = [session for session in facts.sessions if session not in there.sessions]
        facts = replace(there, sessions=[*there.sessions, *new])
    _write(path, facts)
    return facts.run


def update_last_session(folder: str | Path, run: str, changes: Mapping[str, Any]) -> None:
    """Set fields of the latest session of a run. Raises RecordError as `write_provenance` does."""
    there = read_provenance(folder, run)
    *earlier, last = there.sessions
    _write(provenance_path(folder, run), replace(there, sessions=[*earlier, {**last, **changes}]))


def merge_provenance(folder: str | Path, others: Sequence[str | Path]) -> None:
    """Bring the provenance of all runs of other folders into one, where their records are merged. Raises
    RecordError if a file of them is damaged."""
    for other in others:
        for path in provenance_files(other):
            write_provenance(folder, read_provenance(other, path.stem))


def _write(path: Path, facts: Provenance) -> None:
    content = {
        "format": FORMAT,
        "version": VERSION,
        "run": facts.run,
        **{part: getattr(facts, part) for part in _PARTS},
        "sessions": list(facts.sessions),
    }
    content[CHECKSUM] = _checksum(content)
    text = json.dumps(content, indent=1, allow_nan=False) + "\n"
    with writing(path):
        write_whole(path, text.encode())


def _checksum(content: Mapping[str, Any]) -> str:
    told = {name: value for name, value in content.items() if name != CHECKSUM}
    told["sessions"] = [
        {**session, "machine": _without(session.get("machine") or {}, ("host",))}
        for session in told["sessions"]
    ]
    text = json.dumps(told, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _checked(value: Any, path: Path) -> Provenance:
    if not isinstance(value, dict) or value.get("format") != FORMAT:
        raise RecordError(f"{path}: format: should be {FORMAT!r}; this is another file")
    if value.get("version") != VERSION:
        raise RecordError(
            f"{path}: version: is {value.get('version')!r}; this release reads version {VERSION}"
        )
    for part in _PARTS:
        if not isinstance(value.get(part), dict):
            raise RecordError(f"{path}: {part}: is {value.get(part)!r}; it should be an object")
    sessions, files = value.get("sessions"), value["data"].get("files")
    if not isinstance(sessions, list) or not all(isinstance(it, dict) for it in sessions):
        raise RecordError(f"{path}: sessions: should be a list of objects")
    if not isinstance(files, dict) or not all(
        isinstance(it, dict) and "sha256" in it for it in files.values()
    ):
        raise RecordError(f"{path}: data.files: should be an object of files with their sha256")
    return Provenance(value["config"], value["code"], value["data"], sessions)


def _without(config: Mapping[str, Any], keys: Sequence[str]) -> dict[str, Any]:
    """The configuration but for some keys, of which those with a dot are in a group."""
    kept = {name: value for name, value in config.items() if name not in keys}
    for key in keys:
        group, _, name = key.partition(".")
        if name and isinstance(kept.get(group), Mapping):
            kept[group] = {inner: value for inner, value in kept[group].items() if inner != name}
    return kept
