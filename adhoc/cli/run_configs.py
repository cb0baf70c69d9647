"""Running composed configurations: those that belong together as one run, in one folder."""

from __future__ import annotations

import json
import sys
import warnings
from collections.abc import Sequence
from contextlib import ExitStack

from omegaconf import DictConfig, OmegaConf

from adhoc import __version__
from adhoc.cli.dry_run import dry_runs
from adhoc.cli.executing import execute
from adhoc.cli.person import asks_person
from adhoc.cli.shards import folder_of, shard_of
from adhoc.cli.table_console import table_console
from adhoc.core.counting import counted
from adhoc.experiments.console_progress import ConsoleProgress
from adhoc.experiments.failures import Tolerance
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.folder_lock import locked
from adhoc.experiments.progress import RunSummary
from adhoc.reporting.cost_table import cost_table
from adhoc.reporting.rendering.terminal import terminal_table

COMPARED = (
    "policy",
    "team",
    "task",
    "world",
    "benchmark",
    "imperfections",
    "join_step",
    "seed",
    "limit",
    "max_steps",
    "failed_share",
    "predicted_within",
)
"""What may differ within a run. Whatever else does, such as the run folder or the model, makes another."""
SOME_FAILED = 1
"""The exit code of a run of which some episodes failed."""


def run_configs(configs: Sequence[DictConfig]) -> int:
    """Run composed and checked configurations, or estimate what they would ask of a model; returns the exit
    code. Raises AdhocError for whatever goes wrong."""
    code = 0
    runs = _runs(configs)
    dry_runs([run for run in runs if run[0].dry_run])
    for run in runs:
        if not run[0].dry_run and _run(run).failed:
            code = SOME_FAILED
    return code


def _runs(configs: Sequence[DictConfig]) -> list[list[DictConfig]]:
    """Those that can be planned and run together."""
    runs: dict[str, list[DictConfig]] = {}
    for config in configs:
        once = {str(name): config[name] for name in config if name not in COMPARED}
        plain = OmegaConf.to_container(OmegaConf.create(once), resolve=True)
        runs.setdefault(json.dumps(plain, sort_keys=True, default=str), []).append(config)
    return list(runs.values())


def _run(configs: Sequence[DictConfig]) -> RunSummary:
    first = configs[0]
    path = folder_of(first)
    path.mkdir(parents=True, exist_ok=True)
    live = not any(map(asks_person, configs))
    with ExitStack() as stack:
        stack.enter_context(locked(path))
        folder = RunFolder(path, Tolerance(first.fail_on_error))
        _warn_of_versions(folder)
        stack.callback(_tell_end, configs, folder)
        progress = stack.enter_context(ConsoleProgress(live=live))
        summary = execute(configs, folder, shard_of(first), progress)
    return summary


def _warn_of_versions(folder: RunFolder) -> None:
    versions = sorted({str(record["library_version"]) for record in folder.records} - {__version__})
    if versions:
        warnings.warn(
            f"{folder.path}: holds episodes of adhoc {', '.join(versions)}; this is {__version__}. Episodes "
            "of several versions in one table may not be comparable",
            stacklevel=2,
        )


def _tell_end(configs: Sequence[DictConfig], folder: RunFolder) -> None:
    """What the episodes of these configurations cost, also those recorded before, and how many failed."""
    joined = {(config.policy.name, config.join_step) for config in configs}
    mine = [
        record
        for record in folder.records
        if record["join_step"] is None or (record["policy"], record["join_step"]) in joined
    ]
    table = cost_table(mine)
    if table is not None:
        table_console().print(terminal_table(table), crop=False)
    if folder.records:
        sys.stdout.write(f"look into an episode: adhoc inspect {folder.path} EPISODE\n")
    if folder.failures:
        sys.stderr.write(
            f"adhoc run: {counted(len(folder.failures), 'episode')} failed, not recorded; what went wrong is "
            f"in {folder.path / 'failures.jsonl'}; the same command runs them again\n"
        )
