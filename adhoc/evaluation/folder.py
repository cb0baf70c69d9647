"""A run folder: its records by episode, and the rule that it belongs to one configuration."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from adhoc.core.errors import RecordError
from adhoc.evaluation.contender import EpisodeKey
from adhoc.evaluation.records import Record, RecordFile


class RunFolder:
    """The finished episodes of one folder. Several policies, joining steps and scenarios may share it, and
    with them the episodes of the team alone; what else decides an episode must stay the same.

    Raises RecordError if the records are damaged.
    """

    def __init__(self, folder: str | Path) -> None:
        self.path = Path(folder)
        self._file = RecordFile(folder)
        self._records = {str(record["episode_id"]): record for record in self._file.read()}
        self._hashes = {_group(record): str(record["config_hash"]) for record in self._records.values()}

    def find(self, key: EpisodeKey) -> Record | None:
        """The record of an episode that was run before, or None.

        Raises RecordError if the folder belongs to another configuration or to other scenarios.
        """
        recorded = self._hashes.get(key.group, key.config_hash)
        if recorded != key.config_hash:
            raise RecordError(
                f"{self._file.path}: was made with another configuration of team={key.group[0]} "
                f"policy={key.group[1]} ({self._differences(recorded, key)}); "
                "use another folder (out=...) or the old configuration"
            )
        record = self._records.get(key.id)
        if record is not None and record["scenario_hash"] != key.scenario.content_hash():
            raise RecordError(
                f"{self._file.path}: episode {key.id!r} was run in another version of scenario "
                f"{key.scenario.id!r} (house, objects or robots differ); use another folder (out=...)"
            )
        return record

    def add(self, key: EpisodeKey, record: Record) -> None:
        """Store the record of an episode, and the settings behind its `config_hash`."""
        self._keep_settings(key)
        self._file.append(record)
        self._records[key.id] = record
        self._hashes[key.group] = key.config_hash

    def _keep_settings(self, key: EpisodeKey) -> None:
        path = self._settings_path(key.config_hash)
        if not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(json.dumps(key.settings, indent=2, sort_keys=True) + "\n", encoding="utf-8")

    def _settings_path(self, config_hash: str) -> Path:
        return self.path / "settings" / f"{config_hash}.json"

    def _differences(self, recorded: str, key: EpisodeKey) -> str:
        path = self._settings_path(recorded)
        try:
            before = dict(_flat(json.loads(path.read_text(encoding="utf-8"))))
        except (OSError, ValueError):
            return f"config_hash {recorded} there, {key.config_hash} here"
        now = dict(_flat(key.settings))
        names = sorted(name for name in {*before, *now} if before.get(name) != now.get(name))
        changes = [f"{name}: {before.get(name)!r} there, {now.get(name)!r} here" for name in names]
        return "; ".join(changes[:5])


def _group(record: Record) -> tuple[str, str, str | None]:
    return (record["team"], record["policy"], record["model"])


def _flat(settings: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in settings.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value
