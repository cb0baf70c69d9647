"""Demonstrations: (features, decision) pairs, recorded while policies run episodes in training houses."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.policy import Policy
from adhoc.core.errors import CheckpointError
from adhoc.dataset.making.parallel import Progress, in_processes
from adhoc.evaluation.episode import run_episode
from adhoc.evaluation.scenario import Scenario
from adhoc.tasks.task import Task
from adhoc.tasks.tidying_up import TidyingUp
from adhoc.training.behaviour_cloning import Examples
from adhoc.training.training_houses import HouseDraw, scenarios_of
from adhoc.worlds.pybullet_world import PyBulletWorld
from adhoc.worlds.world import World


class Recorder:
    """Takes down what somebody decided, and by what."""

    def __init__(self) -> None:
        self.rows: list[NDArray[np.float32]] = []
        self.labels: list[int] = []

    def note(self, row: NDArray[np.float32], label: int) -> None:
        """One decision: the features (F,), and the number of the class."""
        self.rows.append(row)
        self.labels.append(label)


@dataclass(frozen=True)
class Cast:
    """Who plays an episode, and who takes it down."""

    team: Sequence[Policy]
    """One policy for each teammate, in order."""
    recorders: Sequence[Recorder]
    newcomer: Policy | None = None
    join_step: int = 0


MakeCast = Callable[[World, Scenario], Cast]
"""Makes the cast of one episode. It may look into the world as it pleases: experts know everything. Sent to
other processes: a function of a module, or a `functools.partial` of one."""


@dataclass(frozen=True)
class Demonstrations:
    """Recorded decisions: `inputs` (N, F) float32 and `labels` (N,) int64; how many episodes, and how many of
    them ended with everything re-placed."""

    inputs: NDArray[np.float32]
    labels: NDArray[np.int64]
    episodes: int = 0
    successes: int = 0

    @property
    def examples(self) -> Examples:
        """As `behaviour_cloning.fit_classifier` takes them."""
        return Examples(self.inputs, self.labels)

    @classmethod
    def joined(cls, parts: Iterable[Demonstrations]) -> Demonstrations:
        """All of them in order; at least one."""
        parts = list(parts)
        return cls(
            np.concatenate([part.inputs for part in parts]),
            np.concatenate([part.labels for part in parts]),
            sum(part.episodes for part in parts),
            sum(part.successes for part in parts),
        )


@dataclass(frozen=True)
class DemonstrationSettings:
    """What is demonstrated, besides the houses. `name` tells files of different demonstrators apart."""

    name: str
    make_cast: MakeCast
    feature_size: int
    scenarios: int = 1
    """In each house."""
    max_steps: int = 500
    task: Task | None = None
    """Tidying up if None."""


def demonstrate(
    draws: Sequence[HouseDraw],
    settings: DemonstrationSettings,
    folder: Path,
    workers: int = 2,
    progress: Progress = lambda done, total, latest: None,
) -> Demonstrations:
    """Run the episodes in all the houses and join what was recorded; the number of workers changes nothing.

    The recordings of a house are kept in `folder` as soon as they are complete, and read from there when the
    same houses are asked for again: an interrupted training goes on where it stopped. Remove the folder
    after changing what `make_cast` makes.

    Raises CheckpointError for a file in `folder` that cannot be read or has another number of features.
    """
    folder.mkdir(parents=True, exist_ok=True)
    parts = in_processes(
        partial(_of_house, settings, folder),
        draws,
        workers,
        lambda draw: draw.rooms,
        lambda draw: draw.house_id,
        progress,
    )
    return Demonstrations.joined(parts)


def demonstrate_in_house(world: World, draw: HouseDraw, settings: DemonstrationSettings) -> Demonstrations:
    """The demonstrations of one house."""
    task = settings.task or TidyingUp()
    rows: list[NDArray[np.float32]] = []
    labels: list[int] = []
    episodes = successes = 0
    for scenario in scenarios_of(world, draw, settings.scenarios):
        cast = settings.make_cast(world, scenario)
        result = run_episode(
            world, scenario, task, cast.team, cast.newcomer, cast.join_step, settings.max_steps
        )
        episodes, successes = episodes + 1, successes + result.success
        for recorder in cast.recorders:
            rows.extend(recorder.rows)
            labels.extend(recorder.labels)
    inputs = np.array(rows, np.float32).reshape(len(rows), settings.feature_size)
    return Demonstrations(inputs, np.array(labels, np.int64), episodes, successes)


def _of_house(settings: DemonstrationSettings, folder: Path, draw: HouseDraw) -> Demonstrations:
    path = folder / f"{settings.name}-{draw.house_id}-s{draw.seed}-n{settings.scenarios}.npz"
    if path.is_file():
        return _read(path, settings.feature_size)
    world = PyBulletWorld()
    try:
        made = demonstrate_in_house(world, draw, settings)
    finally:
        world.close()
    _write(path, made)
    return made


def _write(path: Path, made: Demonstrations) -> None:
    fresh = path.with_name(path.name + ".part")
    counts = np.array([made.episodes, made.successes], np.int64)
    with fresh.open("wb") as file:
        np.savez_compressed(file, inputs=made.inputs, labels=made.labels, counts=counts)
    os.replace(fresh, path)


def _read(path: Path, feature_size: int) -> Demonstrations:
    try:
        with np.load(path, allow_pickle=False) as file:
            found: dict[str, Any] = {name: file[name] for name in ("inputs", "labels", "counts")}
    except (OSError, EOFError, KeyError, ValueError, BadZipFile) as error:
        raise CheckpointError(f"{path}: no recording of demonstrations; remove it ({error})") from error
    inputs, labels = found["inputs"], found["labels"]
    if inputs.ndim != 2 or inputs.shape[1] != feature_size or len(inputs) != len(labels):
        raise CheckpointError(
            f"{path}: inputs {list(inputs.shape)}, labels {list(labels.shape)}; there should be "
            f"{feature_size} features a row, and a label for each; remove the file"
        )
    episodes, successes = found["counts"].tolist()
    return Demonstrations(inputs, labels, episodes, successes)
