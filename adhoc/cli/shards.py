"""Parts of a run, each in a folder of its own."""

from __future__ import annotations

from pathlib import Path

from omegaconf import DictConfig

from adhoc.core.errors import ConfigurationError
from adhoc.experiments.plan import Shard


def folder_of(config: DictConfig) -> Path:
    """The run folder, or the shard's own in it."""
    shard = shard_of(config)
    return Path(config.out) if shard is None else Path(config.out) / shard_name(shard)


def shard_name(shard: Shard) -> str:
    """The name of a shard's folder."""
    return f"shard-{shard.number}-of-{shard.count}"


def shard_of(config: DictConfig) -> Shard | None:
    """Which part of the run; None for the whole of it."""
    number, slash, count = str(config.shard).partition("/")
    if not (slash and number.isdecimal() and count.isdecimal()):
        raise ConfigurationError(f"shard={config.shard}: must be i/n with i from 1 to n")
    shard = Shard(int(number), int(count))
    return shard if shard.count > 1 else None
