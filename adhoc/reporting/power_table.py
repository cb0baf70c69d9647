"""How many tasks it would take to tell policies apart, with the episodes that are there as the pilot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.contender import ALONE
from adhoc.reporting.comparisons import Comparison, Family
from adhoc.reporting.table import Table, plain_table
from adhoc.statistics.power import LEVEL, POWER, detectable_difference, episodes_needed

COLUMNS = (
    "Team",
    "ad hoc",
    "against",
    "points",
    "differ",
    "deff",
    "tasks (houses)",
    "in family",
    "told now",
)
EXACT = 1e-9
"""Slack for the arithmetic of a computer, also of the search for the smallest difference."""
ASSUMED = "*"
"""Marks numbers for which the pilot's disagreement was raised to what the difference needs."""


def power_tables(
    found: Sequence[Family], points: float | None = None, every_pair: bool = True
) -> Iterator[Table]:
    """One for each joining step.

    Args:
        found: The comparisons.
        points: The difference to be told, in percentage points; None for the one that was observed.
        every_pair: Also pairs without the team alone and the most successful policy.

    Raises:
        ConfigurationError: points that are no difference of two percentages.
    """
    if points is not None and not 0.0 < points <= 100.0:
        raise ConfigurationError(f"{points:g} points: a difference to be told is above 0 and at most 100")
    for join_step in dict.fromkeys(it.board.join_step for it in found):
        here = [it for it in found if it.board.join_step == join_step]
        groups = [list(_rows(family, points, every_pair)) for family in here]
        is_assumed = any(cell.endswith(ASSUMED) for rows in groups for row in rows for cell in row[3:])
        title = f"Tasks needed to tell apart, joining at step {join_step}"
        yield plain_table(f"power-{join_step}", title, COLUMNS, 3, groups, list(_remarks(points, is_assumed)))


def _remarks(points: float | None, is_assumed: bool) -> Iterator[str]:
    wanted = "the observed difference, if it is the true one" if points is None else f"{points:g} points"
    yield (
        "differ: tasks in which just one succeeds; deff: how many times as many tasks it takes because those "
        "of one house are alike"
    )
    yield (
        f"tasks (houses): that both must do, in houses with as many tasks each as here, so that {wanted} "
        f"would be told at {LEVEL:.0%} with probability {POWER:.0%}, as a single comparison; in family: as "
        "the first of all of the family"
    )
    yield "told now: the points that as many tasks as here would tell, as a single comparison"
    if is_assumed:
        yield (
            f"{ASSUMED} the pilot shows less disagreement (differ) than such a difference needs; the least "
            "possible was assumed, so this is a lower bound"
        )


def _rows(family: Family, points: float | None, every_pair: bool) -> Iterator[tuple[str, ...]]:
    first = family.against_alone[0].policy
    shown = [it for it in family.comparisons if every_pair or it.against == ALONE or it.policy == first]
    for it in shown:
        pilot = it.pilot
        smallest = detectable_difference(pilot.pairs, pilot.discordant, design_effect=pilot.design_effect)
        yield (
            family.board.team,
            it.policy,
            it.against,
            f"{it.points.mean:+.1f}",
            f"{pilot.discordant:.1%}",
            f"{pilot.design_effect:.2f}" if math.isfinite(pilot.design_effect) else "?",
            _needed(it, points, LEVEL),
            _needed(it, points, LEVEL / it.family_size),
            "none" if smallest is None else f"{100.0 * smallest:.1f}{_mark(it, smallest)}",
        )


def _needed(it: Comparison, points: float | None, level: float) -> str:
    difference = abs(it.pilot.difference) if points is None else points / 100.0
    discordant = max(it.pilot.discordant, difference)
    tasks = episodes_needed(difference, discordant, level, design_effect=it.pilot.design_effect)
    if not math.isfinite(tasks):
        return "-"
    return f"{tasks:,.0f} ({it.pilot.houses_for(tasks):,.0f}){_mark(it, difference)}"


def _mark(it: Comparison, difference: float) -> str:
    return ASSUMED if difference > it.pilot.discordant + EXACT else ""
