"""Making the ceilings of a split: the oracle tries every task, house by house, in several processes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from adhoc.core.errors import ConfigurationError
from adhoc.dataset.files.ceiling_file import write_ceilings
from adhoc.dataset.files.dataset_folder import DatasetSplit, writable_folder
from adhoc.dataset.making.parallel import Progress, in_processes
from adhoc.dataset.oracle.ceilings import Ceiling, ceiling
from adhoc.worlds.pybullet_world import PyBulletWorld

MAX_STEPS = 500
"""The paper's step limit."""


@dataclass(frozen=True)
class CeilingPlan:
    """What one process does at a time: all tasks of one house."""

    folder: Path
    split: str
    house_id: str
    tasks: tuple[str, ...]
    max_steps: int


def make_ceilings(
    folder: Path,
    split: str,
    workers: int = 2,
    progress: Progress = lambda done, total, latest: None,
    max_steps: int = MAX_STEPS,
) -> list[Ceiling]:
    """Let the oracle try every task of a split, write its verdicts beside the tasks, and return them.

    Equal tasks give equal bytes, whatever the number of processes.

    Raises:
        ConfigurationError: `workers` is below 1.
        DatasetError: The files of the split cannot be read.
    """
    if workers < 1:
        raise ConfigurationError(f"workers={workers}: must be at least 1")
    data = DatasetSplit(writable_folder(folder), split)
    by_house: dict[str, list[str]] = {house_id: [] for house_id in data.header.houses}
    for task_id in data.ids:
        by_house[data.task(task_id).house_id].append(task_id)
    plans = [
        CeilingPlan(folder, split, house_id, tuple(tasks), max_steps) for house_id, tasks in by_house.items()
    ]
    found = in_processes(
        ceilings_of, plans, workers, lambda plan: len(plan.tasks), lambda plan: plan.house_id, progress
    )
    ceilings = [verdict for group in found for verdict in group]
    write_ceilings(data.files, ceilings, max_steps)
    return ceilings


def ceilings_of(plan: CeilingPlan) -> list[Ceiling]:
    """The verdicts on the tasks of one house."""
    data = DatasetSplit(plan.folder, plan.split)
    world = PyBulletWorld()
    try:
        return [ceiling(world, data.scenario(task_id), plan.max_steps) for task_id in plan.tasks]
    finally:
        world.close()
