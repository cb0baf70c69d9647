"""Tables as LaTeX, to be read in by a paper: `\\usepackage{booktabs}` is all that they need."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from adhoc.core.errors import ConfigurationError
from adhoc.reporting.table import Cell, Document, Row, Table, shown_once

PAGE = 54
"""Lines of a table that fit a page."""
MANY_COLUMNS = 9
LONG_TEXT = 45
_MARKS = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"$<$",
    ">": r"$>$",
    "|": r"$|$",
    '"': "''",
    "↑": r"$\uparrow$",
    "↓": r"$\downarrow$",
    "†": r"$^\dagger$",
    "·": r"$\cdot$",
    "×": r"$\times$",
    "–": "--",
    "—": "---",
    "≥": r"$\geq$",
    "≤": r"$\leq$",
}
"""What TeX reads as commands, and what its fonts lack."""
_LABEL = re.compile(r"[A-Za-z0-9-]*")
_MINUS = re.compile(r"(?<![\w.)\]])-(?=\d)")


def latex_document(document: Document, label_prefix: str = "") -> str:
    """All tables, one float each, with the remarks as comments and below the last.

    Args:
        document: What to write.
        label_prefix: Goes before the name of each table in its label, so that a paper can read in several
            reports: `tab:PREFIX-joining-0`; letters, digits and dashes.

    Raises:
        ConfigurationError: a prefix of anything else.
    """
    check_label_prefix(label_prefix)
    told = [f"% {_one_line(it)}" for it in (document.title, *document.warnings, *document.notes)]
    head = ["% In the preamble: \\usepackage{booktabs}", *told]
    head += [f"% {_one_line(document.command)}"] if document.command else []
    return "\n".join(head) + "\n\n" + "\n".join(latex_table(it, label_prefix) for it in document.tables)


def latex_table(table: Table, label_prefix: str = "") -> str:
    """One table, as a float over both columns of a two-column page; as several where it is longer than a
    page."""
    parts = list(_pages(table))
    label = f"{label_prefix}-{table.key}" if label_prefix else table.key
    return "\n".join(_float(table, label, lines, at, len(parts)) for at, lines in enumerate(parts, start=1))


def check_label_prefix(label_prefix: str) -> None:
    """Raise ConfigurationError for what is no part of a label."""
    if not _LABEL.fullmatch(label_prefix):
        raise ConfigurationError(f"label prefix {label_prefix!r}: takes letters, digits and dashes alone")


def latex_text(text: str) -> str:
    """Text with nothing in it that TeX takes for a command."""
    marked = "".join(_MARKS.get(mark, mark) for mark in _MINUS.sub("\0", _one_line(text)))
    return marked.replace("\0", "$-$")


def _float(table: Table, label: str, lines: Sequence[str], number: int, of: int) -> str:
    part = f" (part {number} of {of})" if of > 1 else ""
    is_wide = len(table.columns) > MANY_COLUMNS
    made = [
        r"\begin{table*}[t]",
        r"\centering",
        rf"\caption{{{latex_text(table.title + part)}}}",
        rf"\label{{tab:{label}{f'-{number}' if number > 1 else ''}}}",
        *([r"\scriptsize", r"\setlength{\tabcolsep}{3pt}"] if is_wide else [r"\small"]),
        rf"\begin{{tabular}}{{@{{}}{''.join(_column(table, it) for it in range(len(table.columns)))}@{{}}}}",
        r"\toprule",
        _line(latex_text(it.heading) for it in table.columns),
        *lines,
        r"\bottomrule",
        r"\end{tabular}",
    ]
    if table.remarks and number == of:
        told = ". ".join(latex_text(it) for it in table.remarks)
        made += ["", r"\smallskip", rf"\parbox{{\linewidth}}{{\footnotesize {told}.}}"]
    return "\n".join([*made, r"\end{table*}"]) + "\n"


def _pages(table: Table) -> Iterator[list[str]]:
    """The lines of the table, at most `PAGE` at once; a group that fits a page is not parted."""
    page: list[str] = []
    for group in table.groups:
        rows = [list(_row_lines(row)) for row in shown_once(group)]
        if page and len(page) + sum(map(len, rows)) > PAGE:
            yield page
            page = []
        page.append(r"\midrule")
        for lines in rows:
            if len(page) + len(lines) > PAGE:
                yield page
                page = [r"\midrule"]
            page += lines
    yield page


def _column(table: Table, number: int) -> str:
    """Long texts are broken, names stand left, numbers right."""
    if not table.columns[number].is_name:
        return "r"
    longest = max((len(row.cells[number].text) for group in table.groups for row in group), default=0)
    return r"p{0.4\linewidth}" if longest > LONG_TEXT else "l"


def _row_lines(row: Row) -> Iterator[str]:
    yield _line(_cell(cell, row.faint) for cell in row.cells)
    if any(cell.below for cell in row.cells):
        yield _line(rf"{{\scriptsize {latex_text(cell.below)}}}" if cell.below else "" for cell in row.cells)


def _cell(cell: Cell, faint: bool) -> str:
    text = latex_text(cell.text)
    # A bracket at the beginning of a row would be taken for an argument of the line before.
    text = f"{{{text}}}" if text.startswith(("[", "*")) else text
    if cell.bold:
        return rf"\textbf{{{text}}}"
    return rf"\textit{{{text}}}" if faint and text else text


def _line(cells: Iterable[str]) -> str:
    return f"{' & '.join(cells)} \\\\"


def _one_line(text: str) -> str:
    return " ".join(text.split())
