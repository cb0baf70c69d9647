"""Reading the records of run folders, and the settings that they were made with."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from adhoc.core.errors import RecordError
from adhoc.evaluation.records import FILE_NAME, Record, RecordFile
from adhoc.evaluation.settings_files import Settings, read_settings


def records_of(folders: Iterable[str | Path]) -> Iterator[tuple[str, Record]]:
    """The records of all folders, each with its folder. Raises RecordError if a folder has none, one is
    damaged, or the same episode is in two folders."""
    seen: set[str] = set()
    for folder in folders:
        found = RecordFile(folder).read()
        if not found:
            raise RecordError(f"{Path(folder) / FILE_NAME}: no episode records; is it the out=... of a run?")
        for record in found:
            if record["episode_id"] in seen:
                raise RecordError(f"{folder}: episode {record['episode_id']!r} is in another folder as well")
            seen.add(record["episode_id"])
            yield str(folder), record


def read_folders(folders: Iterable[str | Path]) -> list[Record]:
    """The records of `records_of`, without their folders."""
    return [record for _, record in records_of(folders)]


def folder_settings(folders: Iterable[str | Path]) -> dict[str, Settings]:
    """What the `config_hash`es of the folders' records stand for, as far as it was kept."""
    return {name: settings for folder in folders for name, settings in read_settings(folder).items()}
