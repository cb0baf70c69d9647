"""A run folder: its records by episode, and the rule that it belongs to one configuration."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

from adhoc.core.errors import EpisodesFailed, RecordError
from adhoc.core.whole_file import write_whole
from adhoc.evaluation.records import UNFINISHED_NAME, Record, RecordFile, writing
from adhoc.evaluation.settings_files import differing, read_settings, settings_path
from adhoc.experiments.failures import Failure, FailureFile, Tolerance


class FolderKind(Protocol):
    """The configuration of an episode; see `episode_key.EpisodeKind`, which is one."""

    @property
    def group(self) -> tuple[str, str, str | None]:
        """Names of team, policy and model."""

    @property
    def settings(self) -> Mapping[str, Any]:
        """Everything but the scenario and the joining step that decides what is recorded."""

    @property
    def config_hash(self) -> str:
        """A hash of `settings`."""


class FolderKey(Protocol):
    """What a run folder knows an episode by; see `episode_key.EpisodeKey`, which is one."""

    @property
    def id(self) -> str:
        """Unique in a run folder."""

    @property
    def kind(self) -> FolderKind:
        """Its configuration."""

    @property
    def scenario_id(self) -> str:
        """The id of the scenario."""

    @property
    def scenario_hash(self) -> str:
        """A hash of what the scenario is."""


class EpisodeStore(Protocol):
    """Where records are and go: a `RunFolder`, or what stands for one in another process."""

    def find(self, key: FolderKey) -> Record | None:
        """See `RunFolder`."""

    def add(self, key: FolderKey, record: Record) -> None:
        """See `RunFolder`."""

    def add_unfinished(self, key: FolderKey, record: Record) -> None:
        """See `RunFolder`."""

    def add_failure(self, failure: Failure) -> None:
        """See `RunFolder`."""


class RunFolder:
    """The finished episodes of one folder. Several policies, joining steps and scenarios may share it, and
    with them the episodes of the team alone; what else decides an episode must stay the same.

    Args:
        folder: Where it is; it need not exist.
        tolerance: How many failures of episodes it bears in a run; none by default.

    Raises:
        RecordError: The records are damaged.
    """

    def __init__(self, folder: str | Path, tolerance: Tolerance | None = None) -> None:
        self.path = Path(folder)
        self._tolerance = tolerance or Tolerance()
        self._expected = self._failed = 0
        self._failures = FailureFile(folder)
        self._kept: set[str] = set()
        self._file = RecordFile(folder)
        self._records = {str(record["episode_id"]): record for record in self._file.read()}
        self._unfinished_file = RecordFile(folder, UNFINISHED_NAME)
        self._unfinished = {
            str(record["episode_id"]): record
            for record in self._unfinished_file.read()
            if record["episode_id"] not in self._records
        }
        self._hashes = {group_of(record): str(record["config_hash"]) for record in self._records.values()}

    @property
    def records(self) -> list[Record]:
        """Those of all finished episodes, in the order in which they were finished."""
        return list(self._records.values())

    @property
    def failures(self) -> tuple[Failure, ...]:
        """The episodes whose latest attempt failed. A process that was killed between writing a record and
        dropping what failed before leaves both; the record counts."""
        return tuple(it for it in self._failures.failures if it.episode_id not in self._records)

    @property
    def unfinished(self) -> list[Record]:
        """What became of episodes that a cap of the run cut short."""
        return list(self._unfinished.values())

    def expect(self, episodes: int) -> None:
        """A run of so many episodes begins."""
        self._expected, self._failed = episodes, 0

    def recorded(self, episode_id: str, kind: FolderKind) -> Record | None:
        """The record of an episode that was run before, or None; its scenario is not looked at.

        Raises RecordError if the folder belongs to another configuration.
        """
        record = self._records.get(episode_id)
        group_hash = self._hashes.get(kind.group, kind.config_hash)
        recorded = group_hash if record is None else str(record["config_hash"])
        if recorded != kind.config_hash:
            raise RecordError(
                f"{self._file.path}: was made with another configuration of team={kind.group[0]} "
                f"policy={kind.group[1]} ({self._differences(recorded, kind)}); "
                "use another folder (out=...) or the old configuration"
            )
        return record

    def find(self, key: FolderKey) -> Record | None:
        """The record of an episode that was run before, or None.

        Raises RecordError if the folder belongs to another configuration or to other scenarios.
        """
        record = self.recorded(key.id, key.kind)
        if record is not None and record["scenario_hash"] != key.scenario_hash:
            raise RecordError(
                f"{self._file.path}: episode {key.id!r} was run in another version of scenario "
                f"{key.scenario_id!r} (house, objects or robots differ); use another folder (out=...)"
            )
        return record

    def add(self, key: FolderKey, record: Record) -> None:
        """Store the record of an episode, and the settings behind its `config_hash`."""
        if key.id in self._records:
            raise RecordError(f"{self._file.path}: episode {key.id!r} is there already; it was run twice")
        self._keep_settings(key.kind)
        self._file.append(record)
        self._records[key.id] = record
        self._hashes[key.kind.group] = key.kind.config_hash
        if self._unfinished.pop(key.id, None) is not None:
            self._unfinished_file.replace(list(self._unfinished.values()))
        self._failures.drop(key.id)

    def add_failure(self, failure: Failure) -> None:
        """Keep what went wrong in an episode. Raises EpisodesFailed if these are too many."""
        self._failures.add(failure)
        self._failed += 1
        if self._tolerance.is_passed(self._failed, self._expected):
            raise EpisodesFailed(
                f"{self._failed} of {self._expected} episodes failed, the last of them "
                f"{failure.episode_id!r}: {failure.error}: {failure.message} (see {self._failures.path}; "
                f"fail_on_error={_plainly(self._tolerance.most)})"
            )

    def add_unfinished(self, key: FolderKey, record: Record) -> None:
        """Keep what became of an episode that has to be run again, in place of what was kept of it before."""
        self._keep_settings(key.kind)
        self._unfinished[key.id] = record
        self._unfinished_file.replace(list(self._unfinished.values()))

    def _keep_settings(self, kind: FolderKind) -> None:
        if kind.config_hash in self._kept:
            return
        path = settings_path(self.path, kind.config_hash)
        content = (json.dumps(kind.settings, indent=2, sort_keys=True) + "\n").encode()
        with writing(path):
            if not path.exists() or path.read_bytes() != content:
                write_whole(path, content)
        self._kept.add(kind.config_hash)

    def _differences(self, recorded: str, kind: FolderKind) -> str:
        before = read_settings(self.path).get(recorded)
        if before is None:
            return f"config_hash {recorded} there, {kind.config_hash} here"
        return differing(before, kind.settings)


def _plainly(most: float | None) -> str:
    return "null" if most is None else f"{most:g}"


def group_of(record: Record) -> tuple[str, str, str | None]:
    """See `FolderKind.group`."""
    return (record["team"], record["policy"], record["model"])
