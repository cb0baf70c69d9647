"""From the configuration of a run to its comparison, in this process and in workers."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

from omegaconf import DictConfig, OmegaConf

from adhoc.cli.artifacts import artifacts_for
from adhoc.cli.build import TARGET
from adhoc.cli.contestants import Components
from adhoc.cli.model_chain import caps_of
from adhoc.core.errors import AdhocError
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.run import Progress, RunSummary
from adhoc.experiments.workers.comparison import Comparison
from adhoc.experiments.workers.parent import run_in_workers
from adhoc.llm.model import LanguageModel
from adhoc.llm.offline.reasoner import OfflineReasoner

CALLS_OF_A_WORKER = 4
"""Threads beside those for calls under way: recorded answers need not wait for the provider's."""
UNRECORDED = ("auto", "off")
"""Ledger modes in which the offline reasoner is not recorded."""


def run_here(config: DictConfig, folder: RunFolder, progress: Progress) -> RunSummary:
    """Run all episodes in this process. Raises AdhocError for whatever is wrong."""
    comparison = _comparison(config, Components(config))
    try:
        return comparison.run(folder, progress)
    finally:
        comparison.world.close()


def run_by_workers(config: DictConfig, folder: RunFolder, progress: Progress) -> RunSummary:
    """Run the episodes in `config.workers` processes, which share the language model of this one.

    Only the offline reasoner, where nothing counts or records its calls, is built by each of them: it costs
    nothing but time.
    """
    plain = OmegaConf.to_container(config, resolve=True)
    return run_in_workers(
        partial(make_comparison, plain, _is_free(config)),
        lambda: Components(config).provider,
        config.workers,
        folder,
        progress,
        calls=config.rate.concurrent + CALLS_OF_A_WORKER * config.workers,
    )


def make_comparison(config: Mapping[str, Any], own_model: bool, model: LanguageModel) -> Comparison:
    """The comparison of a run around a model of another process, or one of its own; `config` has plain
    values."""
    composed = OmegaConf.create(dict(config))
    return _comparison(composed, Components(composed, None if own_model else model))


def _is_free(config: DictConfig) -> bool:
    target = OmegaConf.to_container(config.llm, resolve=True).get(TARGET)
    is_offline = target == f"{OfflineReasoner.__module__}.{OfflineReasoner.__qualname__}"
    return is_offline and config.ledger.mode in UNRECORDED and not caps_of(config, "run")


def _comparison(config: DictConfig, components: Components) -> Comparison:
    conditions, newcomer = components.conditions, components.newcomer
    world = components.world
    try:
        scenarios = components.benchmark.scenarios(world, config.seed, config.limit)
    except AdhocError:
        world.close()
        raise
    artifacts = artifacts_for(Path(config.out), config.pictures, config.transcript)
    return Comparison(world, scenarios, conditions, newcomer, config.join_step, artifacts)
