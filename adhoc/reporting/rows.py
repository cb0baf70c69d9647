"""One row of a table of results: a team with one ad hoc policy, averaged and compared with the team alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.evaluation.metrics import Improvement, Scores, average_columns, improvement
from adhoc.evaluation.records import Record
from adhoc.reporting.contestants import Contestant, Team
from adhoc.reporting.few_houses import FEW_HOUSES
from adhoc.reporting.pairing import Pair
from adhoc.statistics.intervals import Interval, Sample, clustered_intervals

METRICS = ("success", "partial_success", "temporal_steps", "action_steps", "efficiency")
"""The columns, by their names in records and in `Scores`."""
IN_PERCENT = ("success", "partial_success", "efficiency")
FEWER_IS_BETTER = ("temporal_steps", "action_steps")


@dataclass(frozen=True)
class Uncertainty:
    """What the number of episodes and houses allows to say, by metric."""

    values: Mapping[str, Interval]
    """Of the row's numbers."""
    gains: Mapping[str, Interval]
    """Of what the row has over the team alone in the same scenarios, in the units of the metric, positive
    where it is better; empty for the team alone."""
    houses: int

    def is_marked(self, metric: str) -> bool:
        """Whether the interval of the gain excludes nothing gained."""
        gain = self.gains.get(metric)
        return gain is not None and self.houses >= FEW_HOUSES and gain.tells_spread and gain.excludes_zero


@dataclass(frozen=True)
class ResultRow:
    """One row: `scores` over the episodes whose team-alone episode is there too, `gain` against those."""

    team: Team
    who: Contestant | None
    """None for the team alone."""
    team_name: str
    ad_hoc: str
    scores: Scores
    gain: Improvement | None
    uncertainty: Uncertainty | None = None
    unaided: int = 0
    """Tasks that the team did only with the newcomer, where it succeeded more often with it and the newcomer
    re-placed no object itself in any of them; 0 elsewhere."""


def averages(records: Sequence[Record]) -> Scores:
    """The five numbers of a row."""
    return average_columns(*([record[metric] for record in records] for metric in METRICS))


def gain_of(mine: Sequence[Pair], scores: Scores) -> Improvement:
    """The bracketed percentages of a row."""
    return improvement(averages([pair.alone for pair in mine]), scores)


def unaided_successes(mine: Sequence[Pair]) -> int:
    """How many tasks the team did only with the newcomer, if it did more than alone and the newcomer itself
    re-placed nothing in any of them; 0 otherwise, and where records of other versions do not tell."""
    won = [pair.joined for pair in mine if pair.joined["success"] and not pair.alone["success"]]
    lost = sum(pair.alone["success"] and not pair.joined["success"] for pair in mine)
    is_unaided = all("first_help" in it and it["first_help"] is None for it in won)
    return len(won) if len(won) > lost and is_unaided else 0


def uncertainties(rows: Sequence[tuple[Sequence[Record], Sequence[Record]]]) -> list[Uncertainty]:
    """The intervals of many rows at once.

    Args:
        rows: For each its records, and the records of the team alone in the same order; none of these for the
            team alone.
    """
    drafts = [_samples(mine, alone) for mine, alone in rows]
    found = iter(
        clustered_intervals([it for values, gains, _ in drafts for it in (*values.values(), *gains.values())])
    )
    return [
        Uncertainty({it: next(found) for it in values}, {it: next(found) for it in gains}, houses)
        for values, gains, houses in drafts
    ]


def _samples(
    mine: Sequence[Record], alone: Sequence[Record]
) -> tuple[dict[str, Sample], dict[str, Sample], int]:
    _, of = np.unique(np.array([record["house_id"] for record in mine]), return_inverse=True)
    sizes = np.bincount(of).astype(np.float64)

    def sample(values: NDArray[np.float64]) -> Sample:
        return Sample(np.bincount(of, values).astype(np.float64), sizes)

    metrics = [it for it in METRICS if all(record[it] is not None for record in mine)]
    values = {it: _column(mine, it) for it in metrics}
    gains = {it: _gains(values[it], _column(alone, it), it) for it in metrics[:4] if alone}
    return (
        {it: sample(column) for it, column in values.items()},
        {it: sample(column) for it, column in gains.items()},
        len(sizes),
    )


def _column(records: Sequence[Record], metric: str) -> NDArray[np.float64]:
    column = np.array([record[metric] for record in records], dtype=np.float64)
    return 100.0 * column if metric in IN_PERCENT else column


def _gains(mine: NDArray[np.float64], alone: NDArray[np.float64], metric: str) -> NDArray[np.float64]:
    return alone - mine if metric in FEWER_IS_BETTER else mine - alone
