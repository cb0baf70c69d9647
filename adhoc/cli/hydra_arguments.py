"""The words of a command line as Hydra wants them: it takes overrides in one piece only."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

FOLDER = ("--config-dir", "-cd")
WITH_VALUE = (*FOLDER, "--config-path", "-cp", "--config-name", "-cn", "--cfg", "-c", "--package", "-p")
INFO = ("--info", "-i")
ABOUT = ("all", "config", "defaults", "defaults-tree", "plugins", "searchpath")
"""What `--info` may be about; it need not say."""


def overrides_first(arguments: Sequence[str]) -> list[str]:
    """The overrides, then Hydra's options with their values, each in their order."""
    overrides: list[str] = []
    options: list[str] = []
    for words in _together(arguments):
        (options if words[0].startswith("-") else overrides).extend(words)
    return [*overrides, *options]


def own_folders(arguments: Sequence[str]) -> list[Path]:
    """The folders of configurations that the command line names."""
    found = []
    for option, *value in _together(arguments):
        name, _, joined = option.partition("=")
        if name in FOLDER:
            found += [Path(it) for it in (*value, *([joined] if joined else ()))]
    return found


def _together(arguments: Sequence[str]) -> Iterator[list[str]]:
    """Each override, and each option with its value."""
    words = iter(arguments)
    waiting: str | None = None
    for word in words:
        if waiting is not None:
            is_value = waiting in WITH_VALUE or word in ABOUT
            yield [waiting, word] if is_value else [waiting]
            waiting = None
            if is_value:
                continue
        if word in WITH_VALUE or word in INFO:
            waiting = word
        else:
            yield [word]
    if waiting is not None:
        yield [waiting]
