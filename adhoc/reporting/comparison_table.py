"""Comparisons by success as tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from adhoc.core.counting import counted
from adhoc.evaluation.contender import ALONE
from adhoc.reporting.comparisons import BEYOND_CHANCE, Comparison, Family
from adhoc.reporting.few_houses import few_houses
from adhoc.reporting.ordering import told
from adhoc.reporting.table import Table, plain_table
from adhoc.statistics.intervals import LEVEL

COLUMNS = ("Team", "ad hoc", "against", "points", "won : lost", "McNemar", "by houses", "Holm", "N (houses)")
_SMALLEST = 0.001


def comparison_tables(found: Sequence[Family], every_pair: bool = True) -> Iterator[Table]:
    """One for each joining step.

    Without `every_pair`, pairs of policies whose difference might well be chance even by itself (p by houses
    over `BEYOND_CHANCE`) are left out and counted; what is against the team alone is always there.
    """
    for join_step in dict.fromkeys(it.board.join_step for it in found):
        here = [it for it in found if it.board.join_step == join_step]
        shown = [[it for it in family.comparisons if every_pair or _is_shown(it)] for family in here]
        left_out = sum(len(family.comparisons) for family in here) - sum(map(len, shown))
        yield plain_table(
            f"told-apart-{join_step}",
            f"Who is told apart, joining at step {join_step}",
            COLUMNS,
            3,
            (_rows(family.board.team, mine) for family, mine in zip(here, shown)),
            [*_remarks(here), *_omission(left_out)],
        )


def p_text(p_value: float) -> str:
    """A p-value as in a table."""
    return f"<{_SMALLEST}" if p_value < _SMALLEST else f"{p_value:.3f}"


def _is_shown(it: Comparison) -> bool:
    return it.against == ALONE or it.test.p_houses <= BEYOND_CHANCE


def _remarks(here: Sequence[Family]) -> Iterator[str]:
    sizes = sorted({it.family_size for family in here for it in family.comparisons})
    yield (
        f"points of %Suc on the same tasks, in brackets their {LEVEL:.0%} interval by bootstrap over houses; "
        "won : lost: tasks in which just the one or the other succeeded"
    )
    yield (
        "McNemar: exact p if tasks are independent; by houses: exact p if only houses are; Holm: the latter "
        f"for {' or '.join(map(str, sizes))} comparisons at once; *: that is at most {BEYOND_CHANCE:g}"
    )
    yield from few_houses(it.test.houses for family in here for it in family.comparisons)


def _omission(left_out: int) -> Iterator[str]:
    if left_out:
        are = "is" if left_out == 1 else "are"
        yield (
            f"{counted(left_out, 'pair')} with p by houses over {BEYOND_CHANCE:g} {are} not shown here, "
            "but in files"
        )


def _rows(team: str, shown: Sequence[Comparison]) -> Iterator[tuple[str, ...]]:
    for it in shown:
        yield (
            team,
            it.policy,
            it.against,
            told(it.points, True, it.beyond_chance),
            f"{it.test.wins} : {it.test.losses}",
            p_text(it.test.p_episodes),
            p_text(it.test.p_houses),
            p_text(it.p_adjusted),
            f"{it.test.pairs} ({it.test.houses})",
        )
