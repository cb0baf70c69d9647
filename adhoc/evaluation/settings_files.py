"""What the `config_hash` of a record stands for: one JSON file for each in the run folder."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

Settings = Mapping[str, Any]
FOLDER = "settings"
MOST_NAMED = 5


def settings_path(folder: str | Path, config_hash: str) -> Path:
    """Where the settings behind a hash are kept."""
    return Path(folder) / FOLDER / f"{config_hash}.json"


def read_settings(folder: str | Path) -> dict[str, Settings]:
    """All settings that a run folder keeps, by their hash; what cannot be read is left out, since settings
    only explain and nothing is derived from them."""
    found: dict[str, Settings] = {}
    for path in sorted((Path(folder) / FOLDER).glob("*.json")):
        try:
            settings = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError):
            continue
        if isinstance(settings, dict):
            found[path.stem] = settings
    return found


def differing(before: Settings, now: Settings, there: str = "there", here: str = "here") -> str:
    """Which settings differ, and how, the first few of them; empty if none does."""
    flat_before, flat_now = dict(_flat(before)), dict(_flat(now))
    names = sorted(name for name in {*flat_before, *flat_now} if flat_before.get(name) != flat_now.get(name))
    changes = [f"{name}: {flat_before.get(name)!r} {there}, {flat_now.get(name)!r} {here}" for name in names]
    more = [f"and {len(changes) - MOST_NAMED} more"] if len(changes) > MOST_NAMED else []
    return "; ".join([*changes[:MOST_NAMED], *more])


def _flat(settings: Settings, prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in settings.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value
