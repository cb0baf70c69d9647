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
from hydra.types import RunMode
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from adhoc.cli.config_checks import check_config, no_folder
from adhoc.cli.config_errors import one_line
from adhoc.cli.experiment_overrides import is_experiment, with_swept
from adhoc.cli.hydra_arguments import overrides_first, own_folders
from adhoc.cli.replaced import drop_foreign_settings
from adhoc.cli.run_configs import run_configs
from adhoc.cli.run_help import GROUPS
from adhoc.cli.schema import register_schema
from adhoc.core.errors import AdhocError, ConfigurationError
from adhoc.core.resources import data_dir

SWEEP = ("-m", "--multirun")
HERE = "hydra._internal.core_plugins.basic_launcher.BasicLauncher"
OWN_FOLDERS = ("hydra/launcher=", "hydra.run.dir=", "hydra.sweep.dir=")
SWEPT = (*GROUPS, "join_step", "seed", "max_steps")
"""Keys whose values are no lists, and that people sweep."""


def run_with_hydra(arguments: Sequence[str]) -> int:
    """Run with Hydra overrides (`policy=irot join_step=50 -m ...`), one job or a sweep of several.

    The jobs of a sweep are composed first and then run as one: planned together, in shuffled order, by the
    same workers. Only where another launcher (`hydra/launcher=...`) takes jobs elsewhere, each is run there
    by itself.

    Returns the exit code. Raises AdhocError for whatever is wrong with the input; it ends a sweep.
    """
    _check_sweep(arguments)
    arguments = with_swept(arguments, [*own_folders(arguments), data_dir("configs")])
    register_schema()
    make_importable(Path.cwd())
    failures: list[AdhocError] = []
    composed: list[DictConfig] = []
    begun: list[DictConfig] = []

    def job(config: DictConfig) -> int:
        begun.append(config)
        try:
            drop_foreign_settings(config, HydraConfig.get().overrides.task)
            OmegaConf.resolve(config)  # what refers to Hydra's own settings can be looked up here alone
            check_config(config)
            if not _is_launched_here():
                return run_configs([config])
        except AdhocError as error:
            # Hydra would print a trace and go on; a wrong value ends the whole sweep instead.
            failures.append(error)
            raise SystemExit(2) from error
        composed.append(config)
        return 0

    decorated = hydra.main(version_base="1.3", config_path=str(data_dir("configs")), config_name="run")(job)
    with _elsewhere(arguments) as elsewhere, _hydra_arguments([*elsewhere, *arguments]):
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
            text = no_folder(error.filename, error) if isinstance(error, OSError) else str(error)
            raise ConfigurationError(text) from error
    if failures:
        raise failures[0]
    return run_configs(composed)


def _is_launched_here() -> bool:
    """Whether the job of this moment runs in the process that composes all of them."""
    settings = HydraConfig.get()
    return settings.mode is RunMode.RUN or settings.launcher._target_ == HERE


def _check_sweep(arguments: Sequence[str]) -> None:
    """Several values of one key make a sweep, which has to be asked for."""
    if any(argument in SWEEP for argument in arguments) or is_experiment(arguments):
        return
    for argument in arguments:
        key, _, value = argument.partition("=")
        if key in SWEPT and "," in value and value[:1] not in "[{'\"":
            raise ConfigurationError(f"{argument}: several values need -m: adhoc run -m {argument}")


def make_importable(folder: Path) -> None:
    """Let `_target_` name a module in the folder that the command is given in; installed ones go first."""
    if str(folder) not in sys.path:
        sys.path.append(str(folder))


@contextmanager
def _elsewhere(arguments: Sequence[str]) -> Iterator[list[str]]:
    """Overrides that keep Hydra from making folders and files of its own in the run folder: what it writes of
    a sweep holds the command line, and with it perhaps a key. Other launchers need their folder."""
    sweeps = any(argument in SWEEP for argument in arguments) or is_experiment(arguments)
    is_dry = any(it.startswith("dry_run=") and it.lower() != "dry_run=false" for it in arguments)
    if not (sweeps or is_dry) or any(argument.startswith(OWN_FOLDERS) for argument in arguments):
        yield []
        return
    with TemporaryDirectory(prefix="adhoc-") as folder:
        yield [f"hydra.run.dir='{folder}'", f"hydra.sweep.dir='{folder}'"]


@contextmanager
def _hydra_arguments(arguments: Sequence[str]) -> Iterator[None]:
    """Hydra reads `sys.argv`, and raises instead of printing traces only if its environment says so."""
    argv, full = sys.argv, os.environ.get("HYDRA_FULL_ERROR")
    program = "adhoc" if "-sc" in arguments else "adhoc run"  # what a shell is told to complete
    sys.argv = [program, *overrides_first(arguments)]
    os.environ["HYDRA_FULL_ERROR"] = "1"
    try:
        yield
    finally:
        sys.argv = argv
        if full is None:
            del os.environ["HYDRA_FULL_ERROR"]
        else:
            os.environ["HYDRA_FULL_ERROR"] = full
