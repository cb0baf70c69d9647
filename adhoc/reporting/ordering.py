"""The order of policies by success in each team, with what the number of episodes allows to say about it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rich import box
from rich.table import Table

from adhoc.evaluation.records import Record
from adhoc.reporting.pairing import (
    Pair,
    Team,
    check_settings,
    contestant,
    labels,
    pair_key,
    pairs,
    team_names,
    team_of,
)
from adhoc.statistics.intervals import LEVEL, Interval, clustered_interval

COLUMNS = ("Team", "ad hoc", "%Suc", "points over the team alone", "points over the first", "N", "houses")
FEW_HOUSES = 10
"""With fewer, intervals are too narrow to say anything is beyond chance."""


@dataclass(frozen=True)
class Place:
    """One policy's place; all numbers in percent of episodes, or percentage points for differences."""

    policy: str
    success: Interval
    over_alone: Interval
    """How much more often it succeeds than the team alone in the same scenarios."""
    over_best: Interval | None
    """The same against the most successful policy, the first of several, over the scenarios of both; None for
    that itself."""
    episodes: int
    houses: int


@dataclass(frozen=True)
class Ordering:
    """The policies of one team and one joining step, the most successful first."""

    team: str
    join_step: int
    places: tuple[Place, ...]


def orderings(records: Sequence[Record]) -> list[Ordering]:
    """All orders that the records tell, by joining step and team in the order of the records."""
    check_settings(records)
    paired = pairs(records)
    names, teams = labels(pair.joined for pair in paired), team_names(records)
    groups: dict[tuple[int, Team], dict[str, list[Pair]]] = {}
    for pair in paired:
        group = groups.setdefault((pair.joined["join_step"], team_of(pair.joined)), {})
        group.setdefault(names[contestant(pair.joined)], []).append(pair)
    order = sorted(groups, key=lambda key: key[0])
    return [Ordering(teams[team], join_step, _places(groups[join_step, team])) for join_step, team in order]


def ordering_tables(records: Sequence[Record]) -> Iterator[Table]:
    """One table for each joining step."""
    found = orderings(records)
    for join_step in dict.fromkeys(it.join_step for it in found):
        table = Table(
            title=f"By success, joining at step {join_step}; {_REMARK}",
            title_justify="left",
            box=box.SIMPLE_HEAD,
            collapse_padding=True,
            pad_edge=False,
        )
        for column in COLUMNS:
            table.add_column(column, justify="left" if column in COLUMNS[:2] else "right")
        for ordering in (it for it in found if it.join_step == join_step):
            table.add_section()
            for cells in _rows(ordering):
                table.add_row(*cells)
        yield table


def ordering_markdown(records: Sequence[Record]) -> str:
    """The same as Markdown; empty if there is nothing to order."""
    lines: list[str] = []
    found = orderings(records)
    for join_step in dict.fromkeys(it.join_step for it in found):
        lines += [f"## By success, joining at step {join_step}", "", f"{_REMARK}.", ""]
        lines += ["| " + " | ".join(COLUMNS) + " |", "|---|---|" + "---:|" * (len(COLUMNS) - 2)]
        for ordering in (it for it in found if it.join_step == join_step):
            lines += ["| " + " | ".join(cells) + " |" for cells in _rows(ordering)]
        lines.append("")
    return "\n".join(lines)


_REMARK = (
    f"intervals of {LEVEL:.0%} by bootstrap over houses, each comparison by itself; "
    f"*: the interval excludes no difference (never with fewer than {FEW_HOUSES} houses)"
)


def _places(policies: dict[str, list[Pair]]) -> tuple[Place, ...]:
    rates = {
        name: sum(pair.joined["success"] for pair in mine) / len(mine) for name, mine in policies.items()
    }
    order = sorted(policies, key=lambda name: -rates[name])
    best = policies[order[0]]
    return tuple(
        Place(
            name,
            _interval([(float(pair.joined["success"]), pair.joined["house_id"]) for pair in policies[name]]),
            _interval([(_gain(pair.joined, pair.alone), pair.joined["house_id"]) for pair in policies[name]]),
            None if place == 0 else _against(policies[name], best),
            len(policies[name]),
            len({pair.joined["house_id"] for pair in policies[name]}),
        )
        for place, name in enumerate(order)
    )


def _against(mine: Sequence[Pair], best: Sequence[Pair]) -> Interval | None:
    theirs = {pair_key(pair.joined): pair.joined for pair in best}
    shared = [pair.joined for pair in mine if pair_key(pair.joined) in theirs]
    gains = [(_gain(it, theirs[pair_key(it)]), it["house_id"]) for it in shared]
    return _interval(gains) if gains else None


def _gain(record: Record, other: Record) -> float:
    return float(record["success"]) - float(other["success"])


def _interval(values: Sequence[tuple[float, str]]) -> Interval:
    return clustered_interval([100.0 * value for value, _ in values], [house for _, house in values])


def _rows(ordering: Ordering) -> Iterator[list[str]]:
    for number, place in enumerate(ordering.places):
        yield [
            ordering.team if number == 0 else "",
            place.policy,
            _told(place.success),
            _told(place.over_alone, place.houses),
            "-" if place.over_best is None else _told(place.over_best, place.houses),
            str(place.episodes),
            str(place.houses),
        ]


def _told(interval: Interval, houses_of_difference: int | None = None) -> str:
    is_difference = houses_of_difference is not None
    sign = "+" if is_difference else ""
    star = "*" if (houses_of_difference or 0) >= FEW_HOUSES and interval.excludes_zero else ""
    return f"{interval.mean:{sign}.1f} [{interval.low:{sign}.1f}, {interval.high:{sign}.1f}]{star}"
