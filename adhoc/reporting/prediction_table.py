"""How often policies that predict their teammates were right, from episode records."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields

from adhoc.evaluation.predictions import PARTS, Accuracy
from adhoc.evaluation.records import Record
from adhoc.reporting.contestants import Contestant
from adhoc.reporting.paper_order import policy_order, team_order
from adhoc.reporting.results import Results
from adhoc.reporting.table import Table, plain_table

FIELD = "predictions"
COUNTS = tuple(field.name for field in fields(Accuracy))
TITLE = "Predictions of what teammates do next"
COLUMNS = (
    "Team",
    "ad hoc",
    "%sub-tasks ↑",
    "%named",
    "judged",
    "%sub-skills ↑",
    "%named",
    "judged",
)
EXPLANATION = (
    "%: of the judged, the same call and arguments as the teammate's first new one within {} steps, "
    "or as what it went on doing; named: of the same name"
)


def prediction_table(results: Results) -> Table | None:
    """The table; None if nobody predicted anything."""
    rows = list(_rows(results))
    if not rows:
        return None
    return plain_table("predictions", TITLE, COLUMNS, 2, [rows], [_explanation(results.records)])


def _rows(results: Results) -> Iterator[tuple[str, ...]]:
    """One for each team and each policy of a model that predicted; records of other versions may lack the
    field."""
    groups: dict[Contestant, list[Record]] = {}
    for (who, _), records in results.groups.items():
        groups.setdefault(who, []).extend(records)
    for row in sorted(groups, key=lambda it: (team_order(it.team), policy_order(it))):
        everything = groups[row]
        found = [it[FIELD] for it in everything if it.get(FIELD)]
        if not any(it[f"{part}s"]["made"] for it in found for part in PARTS):
            continue
        parts = [_sum(it[f"{part}s"] for it in found) for part in PARTS]
        yield (results.teams[row.team], results.rows[row], *(cell for part in parts for cell in _cells(part)))


def _sum(counts: Iterable[Mapping[str, int]]) -> Accuracy:
    total = Counter[str]()
    for one in counts:
        for name in COUNTS:
            total[name] += int(one[name])
    return Accuracy(**{name: total[name] for name in COUNTS})


def _cells(accuracy: Accuracy) -> tuple[str, ...]:
    return (
        _percent(accuracy.right, accuracy.judged),
        _percent(accuracy.named, accuracy.judged),
        f"{accuracy.judged} of {accuracy.made}",
    )


def _percent(count: int, of: int) -> str:
    return f"{100.0 * count / of:.1f}" if of else "-"


def _explanation(records: Sequence[Record]) -> str:
    within = sorted({int(record[FIELD]["within"]) for record in records if record.get(FIELD)})
    return EXPLANATION.format(" or ".join(map(str, within)))
