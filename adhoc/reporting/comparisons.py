"""Every policy against the team alone and against every other, on the same scenarios, by success."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from adhoc.evaluation.contender import ALONE
from adhoc.reporting.results import Results
from adhoc.reporting.scoreboards import Scoreboard, scoreboards
from adhoc.statistics.intervals import FloatArray, Interval, Sample, clustered_intervals
from adhoc.statistics.many import holm
from adhoc.statistics.paired_tests import PairedTest, paired_test
from adhoc.statistics.power import Pilot, pilot

BEYOND_CHANCE = 0.05
"""Adjusted p-values up to this are marked."""


class Scope(str, Enum):
    """Which comparisons are one family, whose p-values are adjusted together.

    An adjustment holds for what is looked at together. Whoever looks for the best of all teams and joining
    steps looks at the whole report.
    """

    TABLE = "table"
    """All of one team at one joining step: each policy against the team alone, and every pair."""
    REPORT = "report"
    """All of all teams and joining steps."""


@dataclass(frozen=True)
class Comparison:
    """One policy against another, or against the team alone."""

    policy: str
    against: str
    """The other policy, or `ALONE`."""
    points: Interval
    """How many percentage points more often the first succeeds."""
    test: PairedTest
    p_adjusted: float
    """The p-value by houses after Holm's correction over the family."""
    family_size: int
    pilot: Pilot
    """What these episodes say about how many are needed."""

    @property
    def beyond_chance(self) -> bool:
        """Whether the two are told apart, with all comparisons of the family taken together."""
        return self.p_adjusted <= BEYOND_CHANCE


@dataclass(frozen=True)
class Family:
    """All comparisons of one team at one joining step, and what they were made from."""

    board: Scoreboard
    comparisons: tuple[Comparison, ...]
    """Against the team alone first, then the pairs; the more successful policy stands first."""

    @property
    def against_alone(self) -> tuple[Comparison, ...]:
        """That of each policy against the team alone, the most successful first."""
        return tuple(it for it in self.comparisons if it.against == ALONE)

    def between(self, policy: str, against: str = ALONE) -> Comparison | None:
        """That comparison, seen from `policy`; None if the two share no scenario."""
        for it in self.comparisons:
            if (it.policy, it.against) == (policy, against):
                return it
            if (it.against, it.policy) == (policy, against):
                return _turned(it)
        return None


def families(results: Results, scope: Scope = Scope.TABLE) -> list[Family]:
    """All comparisons that the records allow, by joining step and team."""
    boards = scoreboards(results)
    contests = [list(_contests(board)) for board in boards]
    samples = [Sample.of(100.0 * it.gains, it.houses) for mine in contests for it in mine]
    intervals = iter(clustered_intervals(samples))
    drafts = [[_comparison(it, next(intervals)) for it in mine] for mine in contests]
    together = [drafts] if scope is Scope.REPORT else [[mine] for mine in drafts]
    adjusted = [family for group in together for family in _adjusted(group)]
    return [Family(board, tuple(mine)) for board, mine in zip(boards, adjusted)]


@dataclass(frozen=True)
class _Contest:
    policy: str
    against: str
    first: FloatArray
    second: FloatArray
    houses: NDArray[np.str_]

    @property
    def gains(self) -> FloatArray:
        return self.first - self.second


def _contests(board: Scoreboard) -> Iterator[_Contest]:
    names = list(board.policies)
    for name in names:
        yield from _contest(board, name, ALONE, board.alone)
    for number, name in enumerate(names):
        for other in names[number + 1 :]:
            yield from _contest(board, name, other, board.policies[other])


def _contest(board: Scoreboard, name: str, other: str, theirs: FloatArray) -> Iterator[_Contest]:
    mine = board.policies[name]
    both = np.isfinite(mine) & np.isfinite(theirs)
    if both.any():
        yield _Contest(name, other, mine[both], theirs[both], board.houses[both])


def _comparison(contest: _Contest, points: Interval) -> Comparison:
    first, second, houses = contest.first, contest.second, contest.houses
    test = paired_test(first, second, houses)
    return Comparison(
        contest.policy, contest.against, points, test, test.p_houses, 1, pilot(first, second, houses)
    )


def _adjusted(group: Sequence[Sequence[Comparison]]) -> list[list[Comparison]]:
    """The same with the p-values of all of them adjusted together."""
    size = sum(map(len, group))
    p_values = iter(holm([it.test.p_houses for mine in group for it in mine]))
    return [[replace(it, p_adjusted=next(p_values), family_size=size) for it in mine] for mine in group]


def _turned(it: Comparison) -> Comparison:
    """The same from the other side."""
    return replace(
        it,
        policy=it.against,
        against=it.policy,
        points=Interval(-it.points.mean, -it.points.high, -it.points.low, it.points.houses),
        test=replace(it.test, wins=it.test.losses, losses=it.test.wins),
        pilot=replace(it.pilot, difference=-it.pilot.difference),
    )
