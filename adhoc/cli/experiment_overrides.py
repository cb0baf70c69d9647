"""Overrides of what an experiment sweeps: `experiment=table1 policy=none,irot` sweeps these two instead."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from omegaconf import OmegaConf

EXPERIMENT = "experiment"
PARAMS = "hydra.sweeper.params"


def is_experiment(arguments: Sequence[str]) -> bool:
    """Whether the arguments name an experiment, which sweeps by itself."""
    return any(argument.startswith(f"{EXPERIMENT}=") for argument in arguments)


def with_swept(arguments: Sequence[str], configs: Path) -> list[str]:
    """The arguments with those put into the sweep whose keys the named experiment sweeps.

    Hydra would sweep over both, the file's values and those of the command line.
    """
    swept = set(_swept(arguments, configs))
    return [
        _as_swept(argument) if argument.partition("=")[0] in swept else argument for argument in arguments
    ]


def _as_swept(argument: str) -> str:
    key, _, value = argument.partition("=")
    escaped = value.replace("\\", "\\\\").replace("'", "\\'")
    return f"{PARAMS}.{key}='{escaped}'"


def _swept(arguments: Sequence[str], configs: Path) -> Iterator[str]:
    for argument in arguments:
        group, _, name = argument.partition("=")
        path = configs / EXPERIMENT / f"{name}.yaml"
        if group == EXPERIMENT and path.is_file():
            params: Any = OmegaConf.select(OmegaConf.load(path), PARAMS)
            yield from (str(key) for key in params or ())
