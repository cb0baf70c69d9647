"""Reading the records of run folders, and the settings that they were made with."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from adhoc.core.errors import RecordError
from adhoc.evaluation.records import FILE_NAME, Record, RecordFile
from adhoc.evaluation.settings_files import Settings, read_settings


def read_folders(folders: Iterable[str | Path]) -> list[Record]:
    """The records of all folders. Raises RecordError if a folder has none, one is damaged, or the same
    episode is in two folders."""
    records: dict[str, Record] = {}
    for folder in folders:
        found = RecordFile(folder).read()
        if not found:
            raise RecordError(f"{Path(folder) / FILE_NAME}: no episode records; is it the out=... of a run?")
        for record in found:
            if record["episode_id"] in records:
                raise RecordError(f"{folder}: episode {record['episode_id']!r} is in another folder as well")
            records[record["episode_id"]] = record
    return list(records.values())


def folder_settings(folders: Iterable[str | Path]) -> dict[str, Settings]:
    """What the `config_hash`es of the folders' records stand for, as far as it was kept."""
    return {name: settings for folder in folders for name, settings in read_settings(folder).items()}
