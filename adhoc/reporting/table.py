"""What a table is, whatever it is shown in: the one model behind terminal, Markdown, LaTeX and HTML."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path


@dataclass(frozen=True)
class Cell:
    """One entry."""

    text: str
    below: str = ""
    """A second, smaller line: an interval."""
    bold: bool = False


@dataclass(frozen=True)
class Row:
    """One line; as many cells as the table has columns."""

    cells: tuple[Cell, ...]
    faint: bool = False
    """Whether it is only there to compare with, such as the paper's numbers."""


@dataclass(frozen=True)
class Column:
    """One column. Names stand left, numbers right."""

    heading: str
    is_name: bool = False


@dataclass(frozen=True)
class Table:
    """A table with what it is and how to read it.

    Groups of rows are parted by a line. Where rows of a group repeat the first cell of the row before, it is
    shown once.
    """

    key: str
    """A name for references to it, of letters, digits and dashes."""
    title: str
    columns: tuple[Column, ...]
    groups: tuple[tuple[Row, ...], ...]
    remarks: tuple[str, ...] = ()
    """Below the table."""

    def about(self, told: str) -> Table:
        """The same with this in its title, such as the model of its records, unless it is there already."""
        return self if told in self.title else replace(self, title=f"{self.title}; {told}")

    @property
    def has_lines_below(self) -> bool:
        """Whether any cell has a second line."""
        return any(cell.below for group in self.groups for row in group for cell in row.cells)


@dataclass(frozen=True)
class Picture:
    """A figure that is on the disk, beside its table."""

    title: str
    file: str
    """Its path, without the ending of the format."""
    svg: str
    """The picture itself."""


@dataclass(frozen=True)
class Document:
    """A whole report."""

    title: str
    tables: tuple[Table, ...]
    warnings: tuple[str, ...] = ()
    """What a reader must know before believing a number."""
    notes: tuple[str, ...] = ()
    pictures: tuple[Picture, ...] = ()
    command: str = ""
    """What writes it again; empty if nobody said."""

    def made_by(self, command: str, folder: Path) -> Document:
        """As it stands in a file of `folder`: with the command, and with pictures found from there."""
        pictures = (
            replace(it, file=Path(os.path.relpath(it.file, folder)).as_posix()) for it in self.pictures
        )
        return replace(self, pictures=tuple(pictures), command=command)


def text_row(cells: Iterable[str], faint: bool = False) -> Row:
    """A row of plain entries."""
    return Row(tuple(map(Cell, cells)), faint)


def plain_table(
    key: str,
    title: str,
    columns: Sequence[str],
    names: int,
    groups: Iterable[Iterable[Iterable[str]]],
    remarks: Sequence[str] = (),
) -> Table:
    """A table of plain entries, of whose columns the first so many hold names."""
    return Table(
        key,
        title,
        tuple(Column(heading, number < names) for number, heading in enumerate(columns)),
        tuple(tuple(map(text_row, group)) for group in groups),
        tuple(remarks),
    )


def shown_once(group: Sequence[Row]) -> list[Row]:
    """The rows of a group, their first cell empty where it repeats that of the row before."""
    shown, before = [], None
    for row in group:
        first = row.cells[0]
        shown.append(Row((Cell(""), *row.cells[1:]), row.faint) if first == before else row)
        before = first
    return shown
