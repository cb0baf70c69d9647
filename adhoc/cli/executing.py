"""Carrying out the plan of a run: in this process, in processes of this machine, or on a cluster."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from enum import Enum
from functools import partial

from omegaconf import DictConfig, OmegaConf

from adhoc.cli.comparing import comparisons_of, make_comparisons, provider_of
from adhoc.cli.model_chain import caps_of, is_offline
from adhoc.cli.sessions import Sessions
from adhoc.core.errors import ConfigurationError
from adhoc.experiments.comparison import MakeComparisons
from adhoc.experiments.folder import RunFolder
from adhoc.experiments.plan import Shard, make_plan
from adhoc.experiments.progress import Progress, RunSummary
from adhoc.experiments.run import run_plan
from adhoc.experiments.workers.crew import SpawnedWorker
from adhoc.experiments.workers.parent import Hire, run_in_workers

CALLS_OF_A_WORKER = 4
"""Threads beside those for calls under way: recorded answers need not wait for the provider's."""
UNRECORDED = ("auto", "off")
"""Ledger modes in which the offline reasoner is not recorded."""


class Executor(str, Enum):
    """Where episodes are run."""

    LOCAL = "local"
    """In this process with one worker, else in processes of this machine."""
    SERIAL = "serial"
    """In this process."""
    PROCESSES = "processes"
    """In processes of this machine."""
    RAY = "ray"
    """In tasks of a Ray cluster."""


def executor_of(config: DictConfig) -> Executor:
    """Where a run's episodes are run. Raises ConfigurationError if that is unknown, or does not fit."""
    try:
        executor = Executor(config.executor.name)
    except ValueError as error:
        known = ", ".join(it.value for it in Executor)
        raise ConfigurationError(f"executor.name={config.executor.name}: must be one of {known}") from error
    if executor is Executor.SERIAL and config.workers > 1:
        raise ConfigurationError(f"executor=serial has no workers={config.workers}; use executor=processes")
    if executor is Executor.LOCAL:
        return Executor.SERIAL if config.workers == 1 else Executor.PROCESSES
    return executor


def execute(
    configs: Sequence[DictConfig], folder: RunFolder, shard: Shard | None, progress: Progress
) -> RunSummary:
    """Plan a run and carry it out. Raises AdhocError for whatever is wrong.

    Workers share the language model of this process. Only the offline reasoner, where nothing counts or
    records its calls, is built by each of them: it costs nothing but time.

    Args:
        configs: Composed; they differ in what is compared alone.
        folder: Where records are and go.
        shard: Which part of the plan.
        progress: Is told what happens.
    """
    first = configs[0]
    executor = executor_of(first)
    provider = provider_of(first)
    with Sessions(folder.path, configs) as sessions:
        comparisons = comparisons_of(configs, provider, sessions.begin)
        try:
            plan = make_plan(comparisons, folder, first.seed, shard)
            if executor is Executor.SERIAL:
                summary = run_plan(plan, comparisons, folder, progress)
        finally:
            comparisons.close()
        if executor is not Executor.SERIAL:
            make = partial(make_comparisons, sessions.configs, sessions.runs, _is_free(first))
            calls = first.rate.concurrent + CALLS_OF_A_WORKER * first.workers
            with _crew(executor, first, make) as hire:
                summary = run_in_workers(plan, hire, provider, first.workers, folder, progress, calls)
        sessions.complete = not summary.failed
    return summary


@contextmanager
def _crew(executor: Executor, config: DictConfig, make: MakeComparisons) -> Iterator[Hire]:
    """Who starts the workers."""
    if executor is Executor.RAY:
        from adhoc.experiments.workers.ray_crew import ray_crew

        with ray_crew(make, config.executor.address, config.executor.cpus) as crew:
            yield crew.hire
    else:
        yield partial(SpawnedWorker, make=make)


def _is_free(config: DictConfig) -> bool:
    llm = OmegaConf.to_container(config.llm, resolve=True)
    offline = isinstance(llm, dict) and is_offline({str(name): value for name, value in llm.items()})
    return offline and config.ledger.mode in UNRECORDED and not caps_of(config, "run")
