"""Benchmarks: which houses, and which scenarios are drawn in them."""

from __future__ import annotations

import hashlib
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from adhoc.core.errors import ConfigurationError
from adhoc.core.streams import derive_seed
from adhoc.evaluation.lazy_scenarios import LazyScenarios
from adhoc.evaluation.ranges import PAPER_RANGES, Ranges
from adhoc.evaluation.sampling import sample_scenario
from adhoc.evaluation.scenario import Scenario
from adhoc.houses.house import House
from adhoc.houses.house_files import documents
from adhoc.houses.procthor import read_house
from adhoc.houses.samples import sample_house, sample_names, sample_path
from adhoc.worlds.world import World


class Benchmark(ABC):
    """A list of scenarios."""

    @abstractmethod
    def scenarios(self, world: World, seed: int, limit: int | None = None) -> Sequence[Scenario]:
        """The first `limit` scenarios (all if None); equal arguments give equal scenarios.

        `world` is needed to try placements, and is reset, also when a scenario of a lazy sequence is
        accessed (`evaluation.lazy_scenarios`). Another `seed` gives other scenarios of the same make, or, of
        fixed tasks, the same tasks with another seed of what is random in an episode; no two seeds share
        an id or a `Scenario.seed`. Raises HouseError, WorldError, DatasetError or ConfigurationError, at
        once or on access, if a scenario cannot be made.
        """

    def largest_team(self, limit: int | None = None) -> int | None:
        """How many teammates there may be at the most in the first `limit` scenarios, without making them;
        None if that is not known."""
        return None

    @property
    def fingerprint(self) -> str:
        """A hash of the files that its houses and tasks come from, equal on every machine; empty if there are
        none, or they cannot be known without loading all. Raises as `scenarios` for files that cannot be
        read."""
        return ""


@dataclass(frozen=True)
class Draw:
    """One scenario to be drawn: a shipped sample house, and what is asked of the draw."""

    house: str
    seed: int = 0
    misplaced: int | None = None
    teammates: int | None = None


class SampleBenchmark(Benchmark):
    """Scenarios in the houses that ship with the library.

    Args:
        draws: One mapping for each scenario, with the fields of `Draw`. Raises ConfigurationError for an
            unknown field or house.
    """

    def __init__(self, draws: Sequence[Draw | dict[str, object]]) -> None:
        self._draws = [draw if isinstance(draw, Draw) else _to_draw(draw) for draw in draws]

    def scenarios(self, world: World, seed: int, limit: int | None = None) -> Sequence[Scenario]:
        """See `Benchmark`. Every scenario is drawn when it is accessed."""
        return _drawn_later(world, sample_house, self._draws[:limit], seed)

    def largest_team(self, limit: int | None = None) -> int | None:
        """See `Benchmark`."""
        return max((_teammates(draw.teammates) for draw in self._draws[:limit]), default=None)

    @property
    def fingerprint(self) -> str:
        """See `Benchmark`."""
        names = sorted({draw.house for draw in self._draws})
        return files_fingerprint([(name, sample_path(name).read_bytes()) for name in names])


class HouseBenchmark(Benchmark):
    """Scenarios in one house of a ProcTHOR file.

    Args:
        path: A `.json`, `.json.gz` or `.jsonl.gz` file.
        index: Which house of the file.
        count: How many scenarios.
        misplaced: Misplaced objects of each; 1 to 5 are drawn if None.
        teammates: Robots of each team; 3 to 5 are drawn if None.
    """

    def __init__(
        self,
        path: str | Path,
        index: int = 0,
        count: int = 5,
        misplaced: int | None = None,
        teammates: int | None = None,
    ) -> None:
        if count < 1:
            raise ConfigurationError(f"benchmark.count={count}: must be at least 1")
        self._path, self._index, self._count = Path(path), index, count
        self._misplaced, self._teammates = misplaced, teammates

    def scenarios(self, world: World, seed: int, limit: int | None = None) -> Sequence[Scenario]:
        """See `Benchmark`. Every scenario is drawn when it is accessed. Raises HouseError at once if the file
        cannot be read."""
        house = read_house(self._path, self._index)
        count = self._count if limit is None else min(limit, self._count)
        draws = [Draw(house.id, number, self._misplaced, self._teammates) for number in range(count)]
        return _drawn_later(world, lambda _: house, draws, seed)

    def largest_team(self, limit: int | None = None) -> int | None:
        """See `Benchmark`."""
        return _teammates(self._teammates)

    @property
    def fingerprint(self) -> str:
        """See `Benchmark`. Every house of the file counts."""
        return files_fingerprint([(it.name, it.text.encode()) for it in documents(self._path)])


def files_fingerprint(files: Iterable[tuple[str, bytes]]) -> str:
    """A hash of the names and contents of files, for `Benchmark.fingerprint`."""
    digest = hashlib.sha256()
    for name, content in files:
        digest.update(f"{name}\0{hashlib.sha256(content).hexdigest()}\0".encode())
    return digest.hexdigest()


def _drawn_later(
    world: World, house_of: Callable[[str], House], draws: Sequence[Draw], run_seed: int
) -> LazyScenarios:
    """The scenarios of draws under a run's seed. Under 0 they are those of the draws' own seeds; the ids name
    both seeds else, as in `corridor-s0-r7`."""
    suffix = f"-r{run_seed}" if run_seed else ""
    ids = [f"{draw.house}-s{draw.seed}{suffix}" for draw in draws]

    def load(position: int) -> Scenario:
        draw = draws[position]
        seed = derive_seed(run_seed, "draw", draw.seed) if run_seed else draw.seed
        house = house_of(draw.house)
        return sample_scenario(world, house, seed, draw.misplaced, draw.teammates, Ranges(), ids[position])

    return LazyScenarios(ids, load)


def _teammates(asked: int | None) -> int:
    """At the most."""
    return PAPER_RANGES.teammates[1] if asked is None else asked


def _to_draw(fields: dict[str, object]) -> Draw:
    try:
        draw = Draw(**fields)  # type: ignore[arg-type]
    except TypeError as error:
        known = ", ".join(Draw.__dataclass_fields__)
        raise ConfigurationError(f"benchmark.draws: {fields!r} does not fit the fields {known}") from error
    if draw.house not in sample_names():
        known = ", ".join(sample_names())
        raise ConfigurationError(f"benchmark.draws: no sample house {draw.house!r}; there are {known}")
    for name in ("seed", "misplaced", "teammates"):
        value = getattr(draw, name)
        if not (_is_whole(value) or (value is None and name != "seed")):
            raise ConfigurationError(
                f"benchmark.draws: {name}={value!r} of {fields!r} must be a whole number"
            )
    return draw


def _is_whole(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)
