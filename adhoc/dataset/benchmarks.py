"""Benchmarks of fixed tasks: a split of a dataset, or a subset of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from adhoc.core.errors import ConfigurationError
from adhoc.core.streams import derive_seed
from adhoc.dataset.files.checked_lines import read_compressed
from adhoc.dataset.files.dataset_folder import SPLITS, DatasetSplit, SplitFiles, dataset_folder
from adhoc.dataset.making.house_tasks import PAPER_GRID
from adhoc.dataset.subset import SUBSETS
from adhoc.evaluation.benchmark import Benchmark, files_fingerprint
from adhoc.evaluation.lazy_scenarios import LazyScenarios
from adhoc.evaluation.scenario import Scenario
from adhoc.houses.house import House
from adhoc.worlds.world import World


class TaskFileBenchmark(Benchmark):
    """The tasks of one split of a dataset, loaded one at a time.

    A run with seed 0 runs the tasks as they are. Another run seed r keeps tasks and set-up, and changes the
    seed of what is random in an episode; the ids then end with `-r{r}`.

    Args:
        dataset: The name of a dataset that comes with the library.
        split: `train`, `val` or `test`.
        subset: `sample` for 30 tasks that stand for all (see `dataset.subset`); None for all.
        mass_scale: Factor on the masses of all objects that can be picked up, for policies and worlds alike.
            With real masses the payload of a robot hardly ever matters: it does for 2 of 100 pairs of object
            and robot, for more than a third with a factor of 20.
        folder: The folder of a dataset made by `adhoc dataset make`, instead of one that is shipped.

    Raises:
        ConfigurationError: An argument is none of what it may be.
    """

    def __init__(
        self,
        dataset: str = "paper",
        split: str = "test",
        subset: str | None = None,
        mass_scale: float = 1.0,
        folder: str | None = None,
    ) -> None:
        if split not in SPLITS:
            raise ConfigurationError(f"benchmark.split={split}: must be one of {', '.join(SPLITS)}")
        if subset is not None and subset not in SUBSETS:
            raise ConfigurationError(
                f"benchmark.subset={subset}: must be null or one of {', '.join(SUBSETS)}"
            )
        if not 0.0 < mass_scale < 1e6:
            raise ConfigurationError(f"benchmark.mass_scale={mass_scale}: must be above 0")
        self._dataset, self._split, self._subset = dataset, split, subset
        self._mass_scale = float(mass_scale)
        self._folder = None if folder is None else Path(folder)

    def scenarios(self, world: World, seed: int, limit: int | None = None) -> Sequence[Scenario]:
        """See `Benchmark`; nothing is tried in the world.

        Raises DatasetError, naming file, line and field, for files that cannot be read, at once or when a
        task is accessed.
        """
        split = DatasetSplit(dataset_folder(self._dataset, self._folder), self._split)
        ids = split.ids if self._subset is None else SUBSETS[self._subset](self._split)
        chosen = ids[:limit]
        for task_id in chosen:
            split.where(task_id)  # a subset of a dataset that has not all of it is refused before the run
        split.open_houses()

        def load(position: int) -> Scenario:
            scenario = split.scenario(chosen[position])
            return for_run(replace(scenario, house=scaled(scenario.house, self._mass_scale)), seed)

        return LazyScenarios([id_for_run(task_id, seed) for task_id in chosen], load)

    def largest_team(self, limit: int | None = None) -> int | None:
        """See `Benchmark`; not known of a dataset of one's own."""
        return max(PAPER_GRID.teammates) if self._folder is None else None

    @property
    def fingerprint(self) -> str:
        """See `Benchmark`: of the contents of the split's tasks and houses. Raises DatasetError."""
        files = SplitFiles(dataset_folder(self._dataset, self._folder), self._split)
        return files_fingerprint([(it.name, read_compressed(it)) for it in (files.tasks, files.houses)])


def for_run(scenario: Scenario, run_seed: int) -> Scenario:
    """A fixed task under a run's seed: itself under 0, else with another seed for its episodes."""
    if run_seed == 0:
        return scenario
    return replace(
        scenario,
        id=id_for_run(scenario.id, run_seed),
        seed=derive_seed(run_seed, "episode", scenario.seed),
        setup_seed=scenario.placement_seed,
    )


def id_for_run(task_id: str, run_seed: int) -> str:
    """The id of a fixed task under a run's seed."""
    return f"{task_id}-r{run_seed}" if run_seed else task_id


def scaled(house: House, mass_scale: float) -> House:
    """The house with the masses of what can be picked up multiplied."""
    if mass_scale == 1.0:
        return house
    objects = (
        replace(thing, mass=thing.mass * mass_scale) if thing.pickupable else thing for thing in house.objects
    )
    return replace(house, objects=tuple(objects))
