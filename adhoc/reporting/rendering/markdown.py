"""Tables and whole reports as Markdown (with GitHub's tables)."""

from __future__ import annotations

import re
from html import escape

from adhoc.reporting.table import Cell, Document, Row, Table

_STARTS_MARK = re.compile(r"[\\|<`]|[*](?=[^\s])|(?<!\w)_|_(?!\w)|\[(?=[^\]]*\]\()|&(?=#?\w+;)|\$(?=[^$]*\$)")


def markdown_document(document: Document) -> str:
    """The whole report."""
    parts = [f"# {_escaped(document.title)}", *map(markdown_table, document.tables)]
    parts += [f"![{_escaped(it.title)}]({it.file}.svg)" for it in document.pictures]
    remarks = [f"- **{_escaped(it)}**" for it in document.warnings]
    remarks += [f"- {_escaped(it)}" for it in document.notes]
    parts += ["\n".join(remarks)] if remarks else []
    parts += [f"<!-- {escape(document.command)} -->"] if document.command else []
    return "\n\n".join(parts) + "\n"


def markdown_table(table: Table) -> str:
    """One table under its heading; names are repeated in every row, so that rows can be searched for."""
    lines = [f"## {_escaped(table.title)}", "", _line([_escaped(it.heading) for it in table.columns])]
    lines.append("|" + "".join("---|" if it.is_name else "---:|" for it in table.columns))
    lines += [_line([_cell(cell, row) for cell in row.cells]) for group in table.groups for row in group]
    if table.remarks:
        lines += ["", *(f"- {_escaped(it)}" for it in table.remarks)]
    return "\n".join(lines)


def _cell(cell: Cell, row: Row) -> str:
    text = _escaped(cell.text)
    if cell.text and (cell.bold or row.faint):
        mark = "**" if cell.bold else "*"
        text = f"{mark}{text.removesuffix('*')}{mark}*" if text.endswith("*") else f"{mark}{text}{mark}"
    return f"{text}<br>{_escaped(cell.below)}" if cell.below else text


def _escaped(text: str) -> str:
    """What ends a cell or starts a mark does not, in names of others. A star before a blank starts
    nothing."""
    return _STARTS_MARK.sub(r"\\\g<0>", " ".join(text.split()))


def _line(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"
