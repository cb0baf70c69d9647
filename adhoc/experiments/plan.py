"""What a run will do: which episodes there are, which are recorded, and in which order the others are run."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from adhoc.core.errors import ConfigurationError
from adhoc.core.streams import stream
from adhoc.evaluation.episode_key import EpisodeKey, EpisodeKind
from adhoc.evaluation.lazy_scenarios import scenario_ids
from adhoc.evaluation.recording import newcomer_label
from adhoc.evaluation.records import Record
from adhoc.evaluation.settings_files import differing
from adhoc.experiments.comparison import Comparison
from adhoc.experiments.folder import RunFolder


@dataclass(frozen=True)
class Unit:
    """What one worker does without a break: one scenario of one comparison, the team alone first."""

    comparison: int
    """Its place in the list of comparisons."""
    position: int
    """The place of the scenario in the comparison's list."""


@dataclass(frozen=True)
class Shard:
    """One of `count` parts of a run, numbered from 1. Raises ConfigurationError if there is no such part."""

    number: int = 1
    count: int = 1

    def __post_init__(self) -> None:
        if not 1 <= self.number <= self.count:
            raise ConfigurationError(f"shard={self}: must be i/n with i from 1 to n")

    def __str__(self) -> str:
        return f"{self.number}/{self.count}"


@dataclass(frozen=True)
class Plan:
    """The episodes of a run, or of its shard."""

    units: tuple[Unit, ...]
    """Those with something to do, in the order in which they are handed out."""
    scenarios: int
    recorded: Mapping[str, int] = field(default_factory=dict)
    """Episodes that there are, by the label of the newcomer."""
    missing: Mapping[str, int] = field(default_factory=dict)
    """Episodes to run, likewise."""
    models: tuple[str, ...] = ()
    """The language models that these will ask."""
    usd: float | None = None
    """What they will cost, if each costs as much as the recorded ones of its newcomer did on average; None if
    there are none to go by."""

    @property
    def to_run(self) -> int:
        """How many episodes will be run."""
        return sum(self.missing.values())

    @property
    def done(self) -> int:
        """How many are recorded."""
        return sum(self.recorded.values())


def make_plan(
    comparisons: Sequence[Comparison], folder: RunFolder, seed: int = 0, shard: Shard | None = None
) -> Plan:
    """Plan what `folder` does not hold yet.

    Units are shuffled, so that what is done at any time is a fair sample of the whole: time left and running
    success mislead less. The order depends on `seed` and the number of units alone; a shard takes every n-th.

    Raises:
        ConfigurationError: No scenarios, two of one id, one policy with two configurations, or an episode
            that two comparisons would both run.
        RecordError: The folder holds episodes of another configuration, or of another version of a scenario.
    """
    units = [
        Unit(number, position)
        for number, comparison in enumerate(comparisons)
        for position in range(len(comparison.scenarios))
    ]
    names = [scenario_ids(comparison.scenarios) for comparison in comparisons]
    for ids in names:
        check_ids(ids)
    _check_kinds(comparisons)
    units = _without_repeated(units, comparisons, names)
    order = stream(seed, "plan").permutation(len(units))
    part = shard or Shard()
    mine = [units[place] for place in order[part.number - 1 :: part.count]]
    count, checked, open_units = _Count(), set[int](), []
    for unit in mine:
        comparison, scenario_id = comparisons[unit.comparison], names[unit.comparison][unit.position]
        there = [folder.recorded(kind.id_in(scenario_id), kind) for kind in comparison.kinds]
        for kind, record in zip(comparison.kinds, there):
            count.add(kind, record)
        if None in there:
            open_units.append(unit)
        elif unit.comparison not in checked:
            checked.add(unit.comparison)
            folder.find(EpisodeKey(comparison.scenarios[unit.position], comparison.kinds[0]))
    scenarios = len({names[unit.comparison][unit.position] for unit in mine})
    return Plan(
        tuple(open_units), scenarios, count.recorded, count.missing, tuple(sorted(count.models)), count.usd
    )


def _check_kinds(comparisons: Sequence[Comparison]) -> None:
    """What one run folder would refuse later: see `RunFolder.recorded`."""
    first: dict[tuple[str, str, str | None], EpisodeKind] = {}
    for kind in (kind for comparison in comparisons for kind in comparison.kinds):
        other = first.setdefault(kind.group, kind)
        if other.config_hash != kind.config_hash:
            changes = differing(other.settings, kind.settings, "in one", "in the other")
            raise ConfigurationError(
                f"team={kind.group[0]} policy={kind.group[1]} is to be run with two configurations in one "
                f"folder ({changes}); give them names of their own (policy.name=...) or folders "
                "(out=...)"
            )


def _without_repeated(
    units: Sequence[Unit], comparisons: Sequence[Comparison], names: Sequence[Sequence[str]]
) -> list[Unit]:
    """The units without those whose episodes are all in others, as in a sweep over `limit`."""
    planned: set[str] = set()
    kept = []
    for unit in units:
        kinds = comparisons[unit.comparison].kinds
        ids = [kind.id_in(names[unit.comparison][unit.position]) for kind in kinds]
        repeated = [name for name in ids if name in planned]
        if not repeated:
            kept.append(unit)
        elif len(repeated) < len(ids):
            raise ConfigurationError(
                f"episode {repeated[0]!r} is in two parts of this sweep; run them one after the other"
            )
        planned.update(ids)
    return kept


class _Count:
    """Episodes that there are and that there are not, and what they cost."""

    def __init__(self) -> None:
        self.recorded, self.missing = Counter[str](), Counter[str]()
        self.models: set[str] = set()
        self._spent: defaultdict[str, float] = defaultdict(float)

    def add(self, kind: EpisodeKind, record: Record | None) -> None:
        label = newcomer_label(kind.newcomer)
        if record is not None:
            self.recorded[label] += 1
            self._spent[label] += float(record["llm"].get("cost_usd", 0.0))
            return
        self.missing[label] += 1
        if kind.model is not None:
            self.models.add(kind.model)

    @property
    def usd(self) -> float | None:
        if any(not self.recorded[label] for label in self.missing):
            return None
        return sum(self._spent[it] / self.recorded[it] * count for it, count in self.missing.items())


def check_ids(ids: Sequence[str]) -> None:
    """Raise ConfigurationError if there are no scenarios, or two of one id."""
    if not ids:
        raise ConfigurationError("there are no scenarios to run: the benchmark is empty, or limit is 0")
    if len(set(ids)) != len(ids):
        repeated = ", ".join(repr(name) for name, count in sorted(Counter(ids).items()) if count > 1)
        raise ConfigurationError(f"scenario ids must be unique: {repeated}")
