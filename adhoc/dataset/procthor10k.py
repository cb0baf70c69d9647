"""The benchmark on the real ProcTHOR-10K houses, from a file or through the package `prior`."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from importlib import import_module
from pathlib import Path

from adhoc.core.errors import (
    AdhocError,
    AssetError,
    ConfigurationError,
    HouseError,
    MissingDependency,
    WorldError,
)
from adhoc.dataset.benchmarks import for_run, id_for_run
from adhoc.dataset.files.dataset_folder import SPLITS
from adhoc.dataset.generator import ROOM_COUNTS
from adhoc.dataset.house_choice import Candidate, check_enough, choose
from adhoc.dataset.making.house_tasks import PAPER_GRID, draw_tasks, task_id
from adhoc.evaluation.benchmark import Benchmark, files_fingerprint
from adhoc.evaluation.lazy_scenarios import LazyScenarios
from adhoc.evaluation.scenario import Scenario
from adhoc.houses.house import House
from adhoc.houses.house_files import Document, decode, documents
from adhoc.houses.procthor import parse_house
from adhoc.worlds.world import World

DATASET = "procthor-10k"
"""As `prior` calls it."""
CANDIDATES = 4
"""So many houses are looked at for each that is wanted, in case some do not suit."""


class ProcThor10kBenchmark(Benchmark):
    """Tasks in houses of ProcTHOR-10K, made as those of the generated houses are, when they are needed.

    Houses are ranked by a hash of `seed` and their content, so that the order of a file plays no role. Of
    each number of rooms the first `houses_per_count` are taken in which all tasks can be drawn; a house in
    which one cannot (too few objects can be misplaced, no room for the robots, an unknown asset) is
    passed over. All tasks of a house are drawn when its first one is needed. Run seeds work as in
    `TaskFileBenchmark`.

    Args:
        path: A `.json`, `.jsonl` or compressed file of houses; None for the package `prior`, which downloads
            the houses when it is first used.
        split: `train`, `val` or `test` of ProcTHOR-10K; of a file it is only part of the ids.
        houses_per_count: Houses of each number of rooms.
        counts: The numbers of rooms.
        seed: Another seed chooses other houses and draws other tasks.

    Raises:
        ConfigurationError: An argument is none of what it may be.
    """

    def __init__(
        self,
        path: str | None = None,
        split: str = "test",
        houses_per_count: int = 10,
        counts: Sequence[int] = ROOM_COUNTS,
        seed: int = 0,
    ) -> None:
        if split not in SPLITS:
            raise ConfigurationError(f"benchmark.split={split}: must be one of {', '.join(SPLITS)}")
        if houses_per_count < 1:
            raise ConfigurationError(f"benchmark.houses_per_count={houses_per_count}: must be at least 1")
        if not isinstance(counts, Sequence) or not counts or not all(map(_is_count, counts)):
            raise ConfigurationError(f"benchmark.counts={counts!r}: must be a list of numbers of rooms")
        self._path, self._split, self._seed = path, split, seed
        self._houses_per_count = houses_per_count
        self._counts = tuple(sorted(set(counts)))

    def scenarios(self, world: World, seed: int, limit: int | None = None) -> Sequence[Scenario]:
        """See `Benchmark`. The world is reset whenever the tasks of another house are drawn.

        Raises:
            MissingDependency: There is no `path`, and `prior` is not installed.
            ConfigurationError: There are too few houses, at once or when one is needed.
            HouseError: The file cannot be read.
        """
        where = self._path or DATASET
        houses = _prior_houses(self._split) if self._path is None else _file_houses(Path(self._path))
        most = CANDIDATES * self._houses_per_count
        chosen = choose(houses, self._counts, most, self._seed)
        check_enough(chosen, self._houses_per_count, where)
        drawn = _DrawnHouses(world, chosen, self._prefix, self._seed, where)
        places = [
            (rooms, index, *sizes)
            for rooms in self._counts
            for index in range(self._houses_per_count)
            for sizes in PAPER_GRID.sizes()
        ][:limit]
        ids = [task_id(drawn.house_id(rooms, index), k, size) for rooms, index, k, size in places]

        def load(position: int) -> Scenario:
            rooms, index, _, _ = places[position]
            return for_run(drawn.scenario(rooms, index, ids[position]), seed)

        return LazyScenarios([id_for_run(name, seed) for name in ids], load)

    def largest_team(self, limit: int | None = None) -> int | None:
        """See `Benchmark`."""
        return max(PAPER_GRID.teammates)

    @property
    def fingerprint(self) -> str:
        """See `Benchmark`: of the file; empty for houses of `prior`, which only the `scenario_hash` of each
        record tells."""
        if self._path is None:
            return ""
        return files_fingerprint([(it.name, it.text.encode()) for it in documents(Path(self._path))])

    @property
    def _prefix(self) -> str:
        name = f"procthor10k-{self._split}"
        return f"{name}-s{self._seed}" if self._seed else name


class _DrawnHouses:
    """The tasks of chosen houses, drawn a house at a time; those of the latest house are kept."""

    def __init__(
        self,
        world: World,
        chosen: Mapping[int, Sequence[Candidate]],
        prefix: str,
        seed: int,
        where: str,
    ) -> None:
        self._world, self._chosen, self._prefix, self._seed, self._where = world, chosen, prefix, seed, where
        self._taken: dict[int, list[int]] = {rooms: [] for rooms in chosen}
        """For each number of rooms, the positions of the candidates that were taken so far."""
        self._next = dict.fromkeys(chosen, 0)
        self._latest: tuple[str, dict[str, Scenario]] = ("", {})

    def house_id(self, rooms: int, index: int) -> str:
        """The id of a house, whichever it will be."""
        return f"{self._prefix}-{rooms:02d}-{index:02d}"

    def scenario(self, rooms: int, index: int, name: str) -> Scenario:
        """One task of a house; all houses before it with as many rooms are tried first."""
        while len(self._taken[rooms]) <= index:
            self._take_next(rooms)
        house_id = self.house_id(rooms, index)
        if self._latest[0] != house_id:
            self._latest = house_id, self._draw(self._chosen[rooms][self._taken[rooms][index]], house_id)
        return self._latest[1][name]

    def _take_next(self, rooms: int) -> None:
        """Take the next candidate that suits, and keep its tasks."""
        house_id = self.house_id(rooms, len(self._taken[rooms]))
        refusal: AdhocError | None = None
        for position in range(self._next[rooms], len(self._chosen[rooms])):
            try:
                tasks = self._draw(self._chosen[rooms][position], house_id)
            except (ConfigurationError, WorldError, HouseError, AssetError) as error:
                refusal = error
                continue
            self._taken[rooms].append(position)
            self._next[rooms] = position + 1
            self._latest = house_id, tasks
            return
        raise ConfigurationError(
            f"{self._where}: house {house_id!r}: tasks can be drawn in only {len(self._taken[rooms])} of the "
            f"{len(self._chosen[rooms])} candidates with {rooms} rooms ({refusal}); lower "
            "benchmark.houses_per_count, or leave that number out of benchmark.counts"
        )

    def _draw(self, candidate: Candidate, house_id: str) -> dict[str, Scenario]:
        house = _parse(candidate, house_id)
        return {task.id: task for task in draw_tasks(self._world, house, self._seed)}


def _parse(candidate: Candidate, house_id: str) -> House:
    return parse_house(
        decode(Document(house_id, candidate.source, candidate.text)), candidate.source, house_id
    )


def _file_houses(path: Path) -> Iterator[tuple[str, object]]:
    return ((document.source, decode(document)) for document in documents(path))


def _prior_houses(split: str) -> Iterator[tuple[str, object]]:
    try:
        prior = import_module("prior")
    except ImportError as error:
        raise MissingDependency(
            "benchmark=procthor10k reads the houses through the package `prior`: install it with "
            '`pip install "adhoc[procthor]"`, or name a file of houses with benchmark.path=FILE'
        ) from error
    try:
        dataset = prior.load_dataset(DATASET)[split]
    except (OSError, ValueError, AssertionError, KeyError) as error:
        raise ConfigurationError(f"{DATASET}: `prior` cannot load it: {error!r}") from error
    # `prior` keeps every house that it decoded; its lines are decoded here instead, one at a time.
    for index, house in enumerate(getattr(dataset, "data", dataset)):
        source = f"{DATASET}, {split}, house {index}"
        yield source, _decoded(house, source)


def _decoded(house: object, source: str) -> object:
    if not isinstance(house, (str, bytes)):
        return house
    try:
        return json.loads(house)
    except ValueError as error:
        raise HouseError(f"{source}: not valid JSON: {error}") from error


def _is_count(rooms: object) -> bool:
    return isinstance(rooms, int) and not isinstance(rooms, bool) and rooms > 0
