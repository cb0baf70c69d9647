"""The order of policies by success in each team, with what the number of episodes allows to say about it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from adhoc.reporting.comparisons import BEYOND_CHANCE, Comparison, Family
from adhoc.reporting.few_houses import few_houses
from adhoc.reporting.table import Table, plain_table
from adhoc.statistics.intervals import LEAST_HOUSES, LEVEL, Interval, Sample, clustered_intervals

COLUMNS = ("Team", "ad hoc", "%Suc", "points over the team alone", "points over the first", "N", "houses")


@dataclass(frozen=True)
class Place:
    """One policy's place; all numbers in percent of episodes, or percentage points for differences."""

    policy: str
    success: Interval
    alone: Comparison
    """Against the team alone in the same scenarios."""
    best: Comparison | None
    """Against the most successful policy, the first of several, over the scenarios of both; None for that
    itself, and where they share none."""

    @property
    def over_alone(self) -> Interval:
        """How much more often it succeeds than the team alone."""
        return self.alone.points

    @property
    def over_best(self) -> Interval | None:
        """How much more often it succeeds than the most successful policy."""
        return None if self.best is None else self.best.points

    @property
    def episodes(self) -> int:
        """All of them paired with the team alone."""
        return self.alone.test.pairs

    @property
    def houses(self) -> int:
        """Where they were."""
        return self.alone.test.houses


@dataclass(frozen=True)
class Ordering:
    """The policies of one team and one joining step, the most successful first."""

    team: str
    join_step: int
    places: tuple[Place, ...]


def orderings(found: Sequence[Family]) -> list[Ordering]:
    """The order in each family, in the order of the families."""
    outcomes = [
        (values[np.isfinite(values)], family.board.houses[np.isfinite(values)])
        for family in found
        for values in family.board.policies.values()
    ]
    rates = iter(clustered_intervals([Sample.of(100.0 * values, houses) for values, houses in outcomes]))
    return [
        Ordering(
            family.board.team,
            family.board.join_step,
            tuple(_place(family, alone, next(rates)) for alone in family.against_alone),
        )
        for family in found
    ]


def ordering_tables(found: Sequence[Family]) -> Iterator[Table]:
    """One for each joining step."""
    orders = orderings(found)
    for join_step in dict.fromkeys(it.join_step for it in orders):
        here = [it for it in orders if it.join_step == join_step]
        title = f"By success, joining at step {join_step}"
        compared = [it for order in here for place in order.places for it in (place.alone, place.best)]
        remarks = (*_REMARKS, *few_houses(it.test.houses for it in compared if it is not None))
        yield plain_table(f"order-{join_step}", title, COLUMNS, 2, map(_rows, here), remarks)


def told(interval: Interval, is_difference: bool, star: bool = False) -> str:
    """A number with its interval; `[?]` where the episodes do not tell how far they scatter."""
    mean, low, high = (_digits(it, is_difference) for it in (interval.mean, interval.low, interval.high))
    return f"{mean} [{f'{low}, {high}' if interval.tells_spread else '?'}]{'*' if star else ''}"


def _digits(number: float, is_difference: bool) -> str:
    rounded = round(number, 1) + 0.0  # no minus before nothing
    return f"{rounded:{'+' if is_difference else ''}.1f}"


_REMARKS = (
    f"in brackets the {LEVEL:.0%} interval by bootstrap over houses, each for itself; ? where all houses are "
    f"alike or there are fewer than {LEAST_HOUSES}",
    f"*: beyond chance at {BEYOND_CHANCE:.0%} with all comparisons of the family taken together (Holm)",
)


def _place(family: Family, alone: Comparison, success: Interval) -> Place:
    first = family.against_alone[0].policy
    return Place(alone.policy, success, alone, family.between(alone.policy, first))


def _rows(ordering: Ordering) -> Iterator[tuple[str, ...]]:
    for place in ordering.places:
        best = place.best
        yield (
            ordering.team,
            place.policy,
            told(place.success, False),
            told(place.over_alone, True, place.alone.beyond_chance),
            "-" if best is None else told(best.points, True, best.beyond_chance),
            str(place.episodes),
            str(place.houses),
        )
