"""How often policies that predict their teammates were right, from episode records."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict

from rich import box
from rich.table import Table

from adhoc.evaluation.predictions import PARTS, Accuracy
from adhoc.evaluation.records import Record
from adhoc.reporting.pairing import Contestant, contestant, labels, team_names

FIELD = "predictions"
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


def prediction_table(records: Sequence[Record]) -> Table | None:
    """The table for the terminal; None if nobody predicted anything."""
    rows = list(_rows(records))
    if not rows:
        return None
    table = Table(title=TITLE, title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    for column in COLUMNS:
        table.add_column(column, justify="left" if column in COLUMNS[:2] else "right")
    for row in rows:
        table.add_row(*row)
    table.caption, table.caption_justify = _explanation(records), "left"
    return table


def prediction_markdown(records: Sequence[Record]) -> str:
    """The same as Markdown; empty if nobody predicted anything."""
    rows = list(_rows(records))
    if not rows:
        return ""
    lines = [f"## {TITLE}", "", _line(COLUMNS), "|---|---|" + "---:|" * (len(COLUMNS) - 2)]
    return "\n".join([*lines, *map(_line, rows), "", f"- {_explanation(records)}"]) + "\n"


def _rows(records: Sequence[Record]) -> Iterator[tuple[str, ...]]:
    """One for each team and each policy of a model that predicted; records of other versions may lack the
    field."""
    totals: dict[Contestant, dict[str, Accuracy]] = {}
    teams = team_names(records)
    for record in records:
        found = record.get(FIELD)
        if found and any(found[f"{part}s"]["made"] for part in PARTS):
            total = totals.setdefault(contestant(record), {part: Accuracy() for part in PARTS})
            for part, accuracy in total.items():
                for name, count in asdict(accuracy).items():
                    setattr(accuracy, name, count + int(found[f"{part}s"][name]))
    names = labels(records)
    for row, total in totals.items():
        yield (teams[row.team], names[row], *(cell for part in PARTS for cell in _cells(total[part])))


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


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
