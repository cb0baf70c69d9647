"""Overrides of what an experiment sweeps: `experiment=table1 policy=none,irot` sweeps these two instead."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from omegaconf import OmegaConf

from adhoc.core.errors import ConfigurationError

EXPERIMENT = "experiment"
PARAMS = "hydra.sweeper.params"


def is_experiment(arguments: Sequence[str]) -> bool:
    """Whether the arguments name an experiment, which sweeps by itself."""
    return any(argument.startswith(f"{EXPERIMENT}=") for argument in arguments)


def with_swept(arguments: Sequence[str], folders: Sequence[Path]) -> list[str]:
    """The arguments with those put into the sweep whose keys the named experiment sweeps.

    Hydra would sweep over both, the file's values and those of the command line.

    Args:
        arguments: Overrides and options.
        folders: Where configurations are, in the order in which they are looked up.

    Raises:
        ConfigurationError: Several experiments are named: each has a sweep of its own.
    """
    for argument in arguments:
        group, _, name = argument.partition("=")
        if group == EXPERIMENT and "," in name:
            raise ConfigurationError(f"{argument}: one at a time, since each sweeps by itself")
    swept = set(_swept(arguments, folders))
    return [
        _as_swept(argument) if argument.partition("=")[0] in swept else argument for argument in arguments
    ]


def _as_swept(argument: str) -> str:
    key, _, value = argument.partition("=")
    escaped = value.replace("\\", "\\\\").replace("'", "\\'")
    return f"{PARAMS}={{{key}:'{escaped}'}}"  # keys may have dots


def _swept(arguments: Sequence[str], folders: Sequence[Path]) -> Iterator[str]:
    for argument in arguments:
        group, _, name = argument.partition("=")
        paths = (folder / EXPERIMENT / f"{name}.yaml" for folder in folders)
        path = next((it for it in paths if it.is_file()), None)
        if group == EXPERIMENT and path is not None:
            params: Any = OmegaConf.select(OmegaConf.load(path), PARAMS)
            yield from (str(key) for key in params or ())
