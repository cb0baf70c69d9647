"""`adhoc merge DIR`: the shards of a run as one run folder."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from pathlib import Path

from adhoc.core.errors import ConfigurationError
from adhoc.experiments.folder_lock import locked
from adhoc.experiments.merging import merge_folders

_SHARD = re.compile(r"shard-(\d+)-of-(\d+)")


def main(arguments: Sequence[str]) -> int:
    """Merge, and say what is there now. Raises RecordError for what does not belong together."""
    parser = argparse.ArgumentParser(
        prog="adhoc merge",
        description="Put the parts of a run together: the shards in DIR, or the run folders that are named. "
        "The parts stay as they are; merging again adds what is new.",
    )
    parser.add_argument("folder", metavar="DIR", type=Path, help="where the whole run is to be")
    parser.add_argument("parts", nargs="*", metavar="PART", type=Path, help="(shard-*-of-* in DIR)")
    options = parser.parse_args(list(arguments))
    parts = options.parts or shards_in(options.folder)
    options.folder.mkdir(parents=True, exist_ok=True)
    with locked(options.folder):
        merged = merge_folders(options.folder, parts)
    failed = f"; {merged.failures} failed and are not recorded" if merged.failures else ""
    sys.stdout.write(
        f"{options.folder}: {merged.records} episodes of {len(parts)} parts, "
        f"{merged.new} of them new{failed}\n"
    )
    return 0


def shards_in(folder: Path) -> list[Path]:
    """The shards of a run, all of them. Raises ConfigurationError if there are none, if one is missing, or if
    they are of several partitions."""
    found = {
        path: (int(match[1]), int(match[2]))
        for path in sorted(folder.glob("shard-*"))
        if (match := _SHARD.fullmatch(path.name))
    }
    if not found:
        raise ConfigurationError(f"{folder}: there are no shards (shard-1-of-N); name the parts to merge")
    counts = sorted({count for _, count in found.values()})
    if len(counts) > 1:
        raise ConfigurationError(
            f"{folder}: there are shards of {counts[0]} and of {counts[1]} parts; name those to merge"
        )
    missing = sorted(set(range(1, counts[0] + 1)) - {number for number, _ in found.values()})
    if missing:
        raise ConfigurationError(
            f"{folder}: shard {missing[0]}/{counts[0]} is missing; name the parts to merge without it"
        )
    return [path for path, _ in sorted(found.items(), key=lambda it: it[1])]
