"""Composing the configuration of a run with Hydra, and running it."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import hydra
from hydra.core.hydra_config import HydraConfig
from hydra.errors import HydraException
from omegaconf import DictConfig
from omegaconf.errors import OmegaConfBaseException

from adhoc.cli.comparing import run_by_workers, run_here
from adhoc.cli.config_errors import one_line
from adhoc.cli.dry_run import dry_run
from adhoc.cli.model_chain import check_values
from adhoc.cli.person import asks_person
from adhoc.cli.replaced import drop_foreign_settings
from adhoc.cli.run_help import GROUPS
from adhoc.cli.schema import register_schema
from adhoc.cli.table_console import table_console
from adhoc.core.errors import AdhocError, ConfigurationError
from adhoc.core.resources import data_dir
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.folder_lock import locked
from adhoc.experiments.progress import ConsoleProgress
from adhoc.reporting.cost_table import cost_table

SWEEP = ("-m", "--multirun")
SWEPT = (*GROUPS, "join_step", "seed", "max_steps")
"""Keys whose values are no lists, and that people sweep."""


def run_with_hydra(arguments: Sequence[str]) -> None:
    """Run with Hydra overrides (`policy=irot join_step=50 -m ...`), one job or a sweep of several.

    Raises AdhocError for whatever is wrong with the input; it ends a sweep.
    """
    _check_sweep(arguments)
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
    with _elsewhere(arguments) as elsewhere, _hydra_arguments([*arguments, *elsewhere]):
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


def run_config(config: DictConfig) -> None:
    """Run one composed configuration, or estimate what it would ask of a model."""
    _check_numbers(config)
    live = not asks_person(config)
    if config.dry_run:
        dry_run(config)
        return
    _check_out(config.out)
    run = run_here if config.workers == 1 else run_by_workers
    with locked(config.out):
        folder = RunFolder(config.out)
        try:
            with ConsoleProgress(live=live) as progress:
                run(config, folder, progress)
        finally:
            _print_costs(config, folder)


def _print_costs(config: DictConfig, folder: RunFolder) -> None:
    """What the episodes of this configuration cost, also those that were recorded before."""
    mine = [
        record
        for record in folder.records
        if record["join_step"] is None
        or (record["policy"], record["join_step"]) == (config.policy.name, config.join_step)
    ]
    table = cost_table(mine)
    if table is not None:
        table_console().print(table)


def _check_sweep(arguments: Sequence[str]) -> None:
    """Several values of one key make a sweep, which has to be asked for."""
    if any(argument in SWEEP for argument in arguments):
        return
    for argument in arguments:
        key, _, value = argument.partition("=")
        if key in SWEPT and "," in value and value[:1] not in "[{'\"":
            raise ConfigurationError(f"{argument}: several values need -m: adhoc run -m {argument}")


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
        raise ConfigurationError(_no_folder(out, error)) from error
    if not os.access(out, os.W_OK | os.X_OK):
        raise ConfigurationError(f"out={out}: may not be written to; name another folder")


def _no_folder(out: str | None, error: OSError) -> str:
    return (
        f"out={out or ''}: no run folder can be made there ({error.strerror or error}); name another folder"
    )


@contextmanager
def _elsewhere(arguments: Sequence[str]) -> Iterator[list[str]]:
    """Overrides that keep Hydra, which makes folders by itself, from making the run folder for a dry run."""
    if not any(it.startswith("dry_run=") and it.lower() != "dry_run=false" for it in arguments):
        yield []
        return
    with TemporaryDirectory(prefix="adhoc-") as folder:
        yield [f"hydra.run.dir='{folder}'", f"hydra.sweep.dir='{folder}'"]


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
