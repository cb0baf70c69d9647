"""What a success takes: calls, tokens and money for each, unusable replies, and how soon newcomers help."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from statistics import median

from adhoc.evaluation.records import Record
from adhoc.llm.offline.reasoner import OFFLINE_NAME
from adhoc.reporting.cost_table import dollars, total_use
from adhoc.reporting.paper_order import policy_order, team_order
from adhoc.reporting.remarks import questions, total
from adhoc.reporting.results import Results
from adhoc.reporting.table import Column, Row, Table, text_row

TITLE = "What a success takes"
COLUMNS = (
    Column("Team", True),
    Column("ad hoc", True),
    Column("t0", True),
    Column("successes"),
    Column("calls"),
    Column("tokens in"),
    Column("tokens out"),
    Column("USD"),
    Column("%invalid ↓"),
    Column("helped ↑"),
    Column("after ↓"),
)
REMARKS = (
    "calls, tokens and USD of all episodes, failed ones too, for each success; '-': none, or nobody's",
    "%invalid: of the questions to models, those without a usable reply",
    "helped: newcomers that brought a misplaced object to a right place themselves, of those that can "
    "manipulate and joined; after: steps from joining until they first did, the median",
)


def effort_table(results: Results) -> Table | None:
    """One row for each team, policy and joining step; None if no model was asked and no newcomer's help
    recorded."""
    if not any(it["llm"]["calls"] or "first_help" in it for it in results.records):
        return None
    order = sorted(results.groups, key=lambda it: (team_order(it[0].team), policy_order(it[0]), it[1] or 0))
    by_team: dict[str, list[Row]] = {}
    for who, step in order:
        name = results.teams[who.team]
        head = (name, results.rows[who], "-" if step is None else str(step))
        by_team.setdefault(name, []).append(text_row((*head, *_cells(results.groups[who, step]))))
    title = f"{TITLE}; language model: {', '.join(results.models) or 'none used'}"
    return Table("effort", title, COLUMNS, tuple(map(tuple, by_team.values())), REMARKS)


def first_helps(records: Iterable[Record]) -> tuple[int, list[int]]:
    """How many newcomers joined that can manipulate, and after how many steps those of them that did so first
    brought an object to a right place. Records of other versions do not tell, and are not counted."""
    able = [
        record
        for record in records
        if record.get("newcomer") and record["newcomer"]["can_manipulate"] and record["joined"]
    ]
    return len(able), [record["first_help"] for record in able if record["first_help"] is not None]


def _cells(mine: Sequence[Record]) -> list[str]:
    successes = sum(record["success"] for record in mine)
    use = total_use(mine)
    able, helped = first_helps(mine)
    is_free = mine[0]["model"] in (None, OFFLINE_NAME)
    return [
        f"{successes} of {len(mine)}",
        _each(use.calls, successes),
        "-" if is_free else _each(use.prompt_tokens, successes),
        "-" if is_free else _each(use.completion_tokens, successes),
        "-" if is_free or not successes else dollars(use.cost_usd / successes),
        _percent(total(mine, "llm", "invalid"), questions(mine)),
        f"{len(helped)} of {able}" if able else "-",
        f"{median(helped):g}" if helped else "-",
    ]


def _each(amount: float, successes: int) -> str:
    return f"{amount / successes:,.0f}" if successes and amount else "-"


def _percent(count: int, of: int) -> str:
    return f"{100.0 * count / of:.1f}" if of else "-"
