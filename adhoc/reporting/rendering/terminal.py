"""Tables for the terminal."""

from __future__ import annotations

from rich import box
from rich.table import Table as RichTable
from rich.text import Text

from adhoc.reporting.table import Cell, Table, shown_once

MANY_COLUMNS = 9
"""Tables of more have them closer together, so that names keep their room."""


def terminal_table(table: Table) -> RichTable:
    """The table for a rich console; nothing in it is read as markup."""
    shown = RichTable(
        title=Text(table.title, "italic"),
        title_justify="left",
        caption=Text("\n".join(table.remarks), "dim") if table.remarks else None,
        caption_justify="left",
        box=box.SIMPLE_HEAD,
        padding=(0, 1) if table.has_lines_below or len(table.columns) >= MANY_COLUMNS else (0, 2),
        collapse_padding=True,
        pad_edge=False,
    )
    for column in table.columns:
        shown.add_column(
            Text(column.heading), justify="left" if column.is_name else "right", no_wrap=not column.is_name
        )
    for group in table.groups:
        shown.add_section()
        for row in shown_once(group):
            shown.add_row(*map(_text, row.cells), style="dim" if row.faint else None)
    return shown


def _text(cell: Cell) -> Text:
    text = Text(cell.text, "bold" if cell.bold else "")
    if cell.below:
        text.append(f"\n{cell.below}", "dim")
    return text
