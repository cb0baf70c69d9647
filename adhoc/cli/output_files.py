"""Where commands may write what they make of a run: never over what the run itself wrote."""

from __future__ import annotations

from pathlib import Path

from adhoc.core.errors import ConfigurationError

OF_A_RUN = (".jsonl", ".json", ".lock", ".png", ".svg")
"""Endings of what runs and figures consist of, which no report, table or page has."""


def check_output(option: str, path: Path | None) -> None:
    """Raise ConfigurationError if a file that was asked for would replace a file of a run."""
    if path is not None and path.suffix.lower() in OF_A_RUN:
        raise ConfigurationError(f"{option} {path}: a run keeps its {path.suffix} files; name another file")
