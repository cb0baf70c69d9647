"""What a run will ask of a language model, from the records of a few of its episodes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields

from adhoc.evaluation.records import Record
from adhoc.reporting.cost_table import Use, use_of


@dataclass(frozen=True)
class Spread:
    """What one scenario took: the mean, the least and the most of those that were run, each count by
    itself."""

    mean: Use
    least: Use
    most: Use

    def __add__(self, other: Spread) -> Spread:
        return Spread(self.mean + other.mean, self.least + other.least, self.most + other.most)

    def times(self, factor: float) -> Spread:
        """For so many scenarios: as expected, if all were like the cheapest, and like the dearest."""
        return Spread(self.mean.times(factor), self.least.times(factor), self.most.times(factor))


def spread_of(records: Iterable[Record]) -> Spread:
    """Over scenarios: the team alone and the team with the newcomer together are one. At least one record."""
    scenarios: dict[str, Use] = {}
    for record in records:
        scenarios[record["task_id"]] = scenarios.get(record["task_id"], Use()) + use_of(record)
    uses = list(scenarios.values())
    return Spread(sum(uses, Use()).times(1 / len(uses)), _of_each(min, uses), _of_each(max, uses))


def spread_evenly(number: int, count: int) -> list[int]:
    """`count` of the positions 0 to `number - 1`, the middles of equal parts: benchmarks are listed by house
    and difficulty, so all kinds are met."""
    count = min(number, count)
    return [(2 * part + 1) * number // (2 * count) for part in range(count)]


def _of_each(choose: Callable[[Iterable[float]], float], uses: Sequence[Use]) -> Use:
    return Use(*(choose(getattr(use, field.name) for use in uses) for field in fields(Use)))
