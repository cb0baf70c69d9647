"""What the figure of success by joining step shows (the paper's Fig. 'performance of different ad hoc
policies')."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from adhoc.reporting.contestants import Contestant, Team
from adhoc.reporting.paper_order import ABLATIONS
from adhoc.reporting.report import Report
from adhoc.statistics.intervals import Interval


@dataclass(frozen=True)
class Series:
    """One policy: its success in percent by joining step."""

    who: Contestant | None
    """None for the team alone."""
    name: str
    points: Mapping[int, Interval]


@dataclass(frozen=True)
class SuccessByStep:
    """All policies of one team, the team alone first."""

    team: Team
    team_name: str
    steps: tuple[int, ...]
    series: tuple[Series, ...]
    episodes: tuple[int, ...]
    """Of all rows, each number once."""
    houses: tuple[int, ...]
    """Of all intervals, each number once."""


def success_by_step(report: Report) -> Iterator[SuccessByStep]:
    """One for each team with a newcomer; parts of the paper's method are left to the ablation table.

    The report must have been made with intervals.
    """
    teams = {row.team: row.team_name for block in report.blocks for row in block.rows if row.who is not None}
    for team, name in teams.items():
        found: dict[tuple[Contestant | None, str], dict[int, Interval]] = {}
        episodes, houses = set[int](), set[int]()
        for block in report.blocks:
            rows = [row for row in block.rows if row.team == team and block.join_step is not None]
            for row in rows:
                if row.uncertainty is None or (row.who is not None and row.who.policy in ABLATIONS):
                    continue
                points = found.setdefault((row.who, row.ad_hoc), {})
                points[block.join_step or 0] = row.uncertainty.values["success"]
                episodes.add(row.scores.episodes)
                houses.add(row.uncertainty.houses)
        series = tuple(Series(who, label, points) for (who, label), points in found.items())
        steps = tuple(sorted({step for it in series for step in it.points}))
        if len(series) > 1:
            yield SuccessByStep(team, name, steps, series, tuple(sorted(episodes)), tuple(sorted(houses)))
