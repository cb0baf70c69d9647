"""Tables for the terminal: whole names and numbers, whatever its width."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from rich import box
from rich.console import Console, ConsoleOptions, JustifyMethod, RenderableType
from rich.table import Table as RichTable
from rich.text import Text

from adhoc.reporting.rendering.panels import Panel, Width, panels
from adhoc.reporting.table import Cell, Table, shown_once

MANY_COLUMNS = 9
"""Tables of more have them closer together, so that names keep their room."""
_DIVIDER = 1
"""Characters that the box puts between two columns."""


@dataclass(frozen=True)
class TerminalTable:
    """A table for a rich console; nothing in it is read as markup.

    Where the console is too narrow for all columns they stand in several panels, one below the other, each
    with the names. Neither a name nor a number is ever cut: what does not fit even so is wider than the
    console (print with `crop=False`).
    """

    table: Table

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[RenderableType]:
        """Title, panels, remarks."""
        table = self.table
        is_close = table.has_lines_below or len(table.columns) >= MANY_COLUMNS
        gap = 1 if is_close else 2
        yield Text(table.title, "italic")
        for panel in panels(list(_widths(table)), options.max_width, gap + _DIVIDER):
            yield Text()
            yield _panel(table, panel, gap)
        if table.remarks:
            yield Text()
            yield Text("\n".join(table.remarks), "dim")


def terminal_table(table: Table) -> TerminalTable:
    """The table, to be printed by a rich console."""
    return TerminalTable(table)


def _panel(table: Table, panel: Panel, gap: int) -> RichTable:
    total = sum(panel.widths) + (gap + _DIVIDER) * (len(panel.widths) - 1)
    shown = RichTable(
        box=box.SIMPLE_HEAD, show_edge=False, padding=(0, gap, 0, 0), pad_edge=False, width=total
    )
    for number, width in zip(panel.columns, panel.widths):
        column = table.columns[number]
        justify: JustifyMethod = "left" if column.is_name else "right"
        shown.add_column(Text(column.heading), justify=justify, width=width, overflow="fold")
    for group in table.groups:
        shown.add_section()
        for row in shown_once(group):
            cells = (_text(row.cells[number]) for number in panel.columns)
            shown.add_row(*cells, style="dim" if row.faint else None)
    return shown


def _widths(table: Table) -> Iterator[Width]:
    for number, column in enumerate(table.columns):
        cells = [row.cells[number] for group in table.groups for row in group]
        lines = [line for cell in cells for line in (cell.text, cell.below)]
        yield Width.of(column.heading, lines, column.is_name)


def _text(cell: Cell) -> Text:
    text = Text(cell.text, "bold" if cell.bold else "")
    if cell.below:
        text.append(f"\n{cell.below}", "dim")
    return text
