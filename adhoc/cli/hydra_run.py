"""Composing the configuration of a run with Hydra, and running it."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import hydra
from hydra.core.hydra_config import HydraConfig
from hydra.errors import HydraException
from omegaconf import DictConfig
from omegaconf.errors import OmegaConfBaseException

from adhoc.cli.artifacts import artifacts_for
from adhoc.cli.config_errors import one_line
from adhoc.cli.contestants import Components
from adhoc.cli.replaced import drop_foreign_settings
from adhoc.cli.schema import register_schema
from adhoc.core.errors import AdhocError, ConfigurationError
from adhoc.core.resources import data_dir
from adhoc.evaluation.folder import RunFolder
from adhoc.evaluation.progress import ConsoleProgress
from adhoc.evaluation.run import RunSummary, run_comparison

SWEEP = ("-m", "--multirun")


def run_with_hydra(arguments: Sequence[str]) -> None:
    """Run with Hydra overrides (`policy=irot join_step=50 -m ...`), one job or a sweep of several.

    Raises AdhocError for whatever is wrong with the input; it ends a sweep.
    """
    register_schema()
    _make_importable(Path.cwd())
    failures: list[AdhocError] = []
    begun: list[str] = []

    def job(config: DictConfig) -> None:
        begun.append(config.out)
        try:
            drop_foreign_settings(config, HydraConfig.get().overrides.task)
            run_config(config)
        except AdhocError as error:
            # Hydra would print a trace and go on; a wrong value ends the whole sweep instead.
            failures.append(error)
            raise SystemExit(2) from error

    decorated = hydra.main(version_base="1.3", config_path=str(data_dir("configs")), config_name="run")(job)
    with _hydra_arguments(arguments):
        try:
            decorated()
        except SystemExit:
            if not failures:
                raise
        except (HydraException, OmegaConfBaseException) as error:
            raise ConfigurationError(one_line(error)) from error
        except (OSError, ValueError) as error:
            if begun:
                raise
            # Before the first job Hydra makes the run folder, and refuses groups that are no names.
            text = _no_folder(error.filename, error) if isinstance(error, OSError) else str(error)
            raise ConfigurationError(text) from error
    if failures:
        raise failures[0]


def run_config(config: DictConfig) -> RunSummary:
    """Run one composed configuration."""
    _check_numbers(config)
    _check_out(config.out)
    folder = RunFolder(config.out)
    components = Components(config)
    conditions, newcomer = components.conditions, components.newcomer
    world = components.world
    try:
        scenarios = components.benchmark.scenarios(world, config.seed, config.limit)
        with ConsoleProgress() as progress:
            return run_comparison(
                world,
                scenarios,
                conditions,
                newcomer,
                config.join_step,
                folder,
                progress,
                artifacts_for(Path(config.out), config.pictures, config.transcript),
            )
    finally:
        world.close()


def _make_importable(folder: Path) -> None:
    """Let `_target_` name a module in the folder that the command is given in; installed ones go first."""
    if str(folder) not in sys.path:
        sys.path.append(str(folder))


def _check_numbers(config: DictConfig) -> None:
    if config.max_steps < 1:
        raise ConfigurationError(f"max_steps={config.max_steps}: must be at least 1")
    if not 0 <= config.join_step < config.max_steps:
        raise ConfigurationError(
            f"join_step={config.join_step}: must be at least 0 and below max_steps={config.max_steps}"
        )
    if config.limit is not None and config.limit < 1:
        raise ConfigurationError(f"limit={config.limit}: must be at least 1")


def _check_out(out: str) -> None:
    """A run folder that cannot be written should not cost the first episode."""
    if not out.strip():
        raise ConfigurationError("out=: must name the run folder")
    try:
        Path(out).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ConfigurationError(_no_folder(out, error)) from error
    if not os.access(out, os.W_OK | os.X_OK):
        raise ConfigurationError(f"out={out}: may not be written to; name another folder")


def _no_folder(out: str | None, error: OSError) -> str:
    return (
        f"out={out or ''}: no run folder can be made there ({error.strerror or error}); name another folder"
    )


@contextmanager
def _hydra_arguments(arguments: Sequence[str]) -> Iterator[None]:
    """Hydra reads `sys.argv`, wants its flags before the overrides, and raises instead of printing traces
    only if its environment says so."""
    argv, full = sys.argv, os.environ.get("HYDRA_FULL_ERROR")
    sweep = [argument for argument in arguments if argument in SWEEP]
    sys.argv = ["adhoc run", *sweep, *(argument for argument in arguments if argument not in SWEEP)]
    os.environ["HYDRA_FULL_ERROR"] = "1"
    try:
        yield
    finally:
        sys.argv = argv
        if full is None:
            del os.environ["HYDRA_FULL_ERROR"]
        else:
            os.environ["HYDRA_FULL_ERROR"] = full
