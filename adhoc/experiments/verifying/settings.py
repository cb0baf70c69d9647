"""Whether `config_hash` follows from the settings that a run folder keeps."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from adhoc.evaluation.episode_key import settings_hash
from adhoc.evaluation.settings_files import settings_path
from adhoc.experiments.verifying.finding import Finding, NumberedRecord, Trouble, expected

COPIED = ("max_steps", "failed_share")
"""Settings that records repeat."""


def settings_findings(folder: Path, records: Sequence[NumberedRecord]) -> Iterator[Finding]:
    """What is wrong with the settings of every `config_hash`, and with what records repeat of them."""
    known: dict[str, Mapping[str, Any] | None] = {}
    for it in records:
        name = it.record["config_hash"]
        if name not in known:
            known[name] = None
            path = settings_path(folder, name)
            problem = _problem(path, name)
            if problem is None:
                known[name] = json.loads(path.read_text(encoding="utf-8"))
            else:
                yield Finding(
                    path.relative_to(folder).as_posix(), None, "", f"{problem} (first in line {it.line})"
                )
        settings = known[name]
        if settings is not None:
            yield from map(it.finding, _against(it, settings))


def _problem(path: Path, name: str) -> str | None:
    try:
        settings = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return "there is no such file; it should hold the settings behind a config_hash"
    except (OSError, ValueError, RecursionError) as error:
        return f"cannot be read as JSON: {error}"
    found = settings_hash(settings)
    return None if found == name else f"its content has the hash {found}; by its name it should be {name}"


def _against(it: NumberedRecord, settings: Mapping[str, Any]) -> Iterator[Trouble]:
    for field in COPIED:
        yield from expected(
            field, it.record[field], settings.get(field), f"by settings {it.record['config_hash']}"
        )
    if (it.record["join_step"] is None) != ("policy" not in settings):
        yield (
            "config_hash",
            "is that of settings with" + ("" if "policy" in settings else "out") + " an ad hoc policy",
        )
