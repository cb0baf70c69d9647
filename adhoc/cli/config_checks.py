"""What a run refuses before it begins."""

from __future__ import annotations

import os
import re
from pathlib import Path

from omegaconf import DictConfig

from adhoc.cli.executing import executor_of
from adhoc.cli.model_chain import check_values
from adhoc.cli.person import asks_person
from adhoc.cli.shards import shard_of
from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.contender import NO_AD_HOC
from adhoc.experiments.failures import Tolerance

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+ -]*")


def check_config(config: DictConfig) -> None:
    """Raise ConfigurationError for a value that does not fit, or a run folder that cannot be written."""
    _check_numbers(config)
    _check_names(config)
    Tolerance(config.fail_on_error)
    shard_of(config)
    executor_of(config)
    asks_person(config)
    if not config.dry_run:
        _check_out(config.out)


def _check_names(config: DictConfig) -> None:
    """Names tell episodes apart and become file names; labels may be anything."""
    for group in ("policy", "team"):
        name = config[group].get("name")
        if not isinstance(name, str) or not _NAME.fullmatch(name):
            raise ConfigurationError(
                f"{group}.name={name}: must begin with an ASCII letter or digit and go on with these, "
                f"spaces, '.', '_', '-' or '+'; {group}.label may be anything"
            )
    if config.policy.name == NO_AD_HOC and "agent" in config.policy:
        raise ConfigurationError(f"policy.name={NO_AD_HOC}: is the name of no policy; use another one")


def _check_numbers(config: DictConfig) -> None:
    if config.max_steps < 1:
        raise ConfigurationError(f"max_steps={config.max_steps}: must be at least 1")
    if not 0 <= config.join_step < config.max_steps:
        raise ConfigurationError(
            f"join_step={config.join_step}: must be at least 0 and below max_steps={config.max_steps}"
        )
    if config.limit is not None and config.limit < 1:
        raise ConfigurationError(f"limit={config.limit}: must be at least 1")
    if config.predicted_within < 1:
        raise ConfigurationError(f"predicted_within={config.predicted_within}: must be at least 1")
    if config.workers < 1:
        raise ConfigurationError(f"workers={config.workers}: must be at least 1")
    check_values(config)


def _check_out(out: str) -> None:
    """A run folder that cannot be written should not cost the first episode."""
    if not out.strip():
        raise ConfigurationError("out=: must name the run folder")
    try:
        Path(out).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ConfigurationError(no_folder(out, error)) from error
    if not os.access(out, os.W_OK | os.X_OK):
        raise ConfigurationError(f"out={out}: may not be written to; name another folder")


def no_folder(out: str | None, error: OSError) -> str:
    """What to say when the run folder cannot be made."""
    return (
        f"out={out or ''}: no run folder can be made there ({error.strerror or error}); name another folder"
    )
