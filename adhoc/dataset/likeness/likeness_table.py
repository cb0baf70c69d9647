"""The likeness of generated to real houses as tables."""

from __future__ import annotations

from rich.table import Table

from adhoc.dataset.likeness.comparison import Likeness, Row

COLUMNS = (
    "room type",
    "statistic",
    "real",
    "generated",
    "",
    "distance",
    "noise",
    "n real",
    "n gen.",
    "remark",
)
LEFT = ("room type", "statistic", "", "remark")
DISTANCE = COLUMNS.index("distance")


def likeness_table(likeness: Likeness, title: str = "Generated against real houses") -> Table:
    """The rows as a table for a terminal; distances above the noise floor stand out."""
    table = Table(title=title, caption=likeness.summary())
    for name in COLUMNS:
        table.add_column(name, justify="left" if name in LEFT else "right", overflow="fold")
    for row in likeness.rows:
        table.add_row(*_cells(row), style="bold red" if row.differs else None)
    return table


def likeness_markdown(likeness: Likeness) -> str:
    """The rows as a table in Markdown; distances above the noise floor are bold."""
    lines = [
        "| " + " | ".join(COLUMNS) + " |",
        "|" + "|".join(" :-- " if name in LEFT else " --: " for name in COLUMNS) + "|",
    ]
    for row in likeness.rows:
        cells = _cells(row)
        if row.differs:
            cells[DISTANCE] = f"**{cells[DISTANCE]}**"
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join([*lines, "", likeness.summary() + "."]) + "\n"


def _cells(row: Row) -> list[str]:
    return [
        row.group,
        row.statistic,
        f"{row.real_mean:.2f}",
        f"{row.generated_mean:.2f}",
        row.kind,
        f"{row.distance:.3f}",
        "" if row.noise is None else f"{row.noise:.3f}",
        str(row.real_count),
        str(row.generated_count),
        row.remark,
    ]
