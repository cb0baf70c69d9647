"""Which columns of a table stand side by side where the page is narrow, and how wide each is."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rich.cells import cell_len

SHORT = 30
"""Characters of a name that is kept on one line where that costs no further panel."""
LEAST_OF_TEXT = 24
"""Characters to which longer names and texts may be broken, unless a word is longer."""
_WORD_END = re.compile(r"\s+(?![↑↓])")
"""Arrows stay beside the word before them."""


@dataclass(frozen=True)
class Width:
    """Characters that a column may have."""

    full: int
    """With the heading and every entry on one line."""
    least: int
    """With headings and names broken between words; numbers are never broken."""
    is_name: bool

    @classmethod
    def of(cls, heading: str, entries: Sequence[str], is_name: bool) -> Width:
        """Of a column with such a heading."""
        full = max(_longest([heading, *entries]), 1)
        in_heading = max(_longest(_WORD_END.split(heading)), 1)
        if not is_name:
            return cls(full, max(in_heading, _longest(entries)), False)
        words = max(in_heading, _longest(word for it in entries for word in it.split()))
        return cls(full, max(words, min((full + 1) // 2, LEAST_OF_TEXT)), True)

    @property
    def stiff(self) -> Width:
        """The same, short names and headings unbroken."""
        return Width(self.full, self.full if self.full <= SHORT else self.least, self.is_name)


@dataclass(frozen=True)
class Panel:
    """Columns side by side."""

    columns: tuple[int, ...]
    """Their numbers in the table."""
    widths: tuple[int, ...]


def panels(columns: Sequence[Width], room: int, gap: int) -> list[Panel]:
    """As few panels as hold all columns, each beginning with the names that begin the table.

    Names and headings are broken between words only where that spares a panel. A single column that does not
    fit beside the names even so makes a panel that is wider than the room.

    Args:
        columns: Those of the table.
        room: Characters of a line.
        gap: Characters between two columns.
    """
    unbroken = _packed([it.stiff for it in columns], room, gap)
    broken = _packed(columns, room, gap)
    return broken if len(broken) < len(unbroken) or _overflows(unbroken, room, gap) else unbroken


def _packed(columns: Sequence[Width], room: int, gap: int) -> list[Panel]:
    names = next((number for number, it in enumerate(columns) if not it.is_name), len(columns))
    stub, packed = tuple(range(names)), list[tuple[int, ...]]()
    current = stub
    for number in range(names, len(columns)):
        wider = (*current, number)
        if len(current) > names and _least(columns, wider, gap) > room:
            packed.append(current)
            wider = (*stub, number)
        current = wider
    return [Panel(it, _fitted([columns[at] for at in it], room, gap)) for it in (*packed, current)]


def _least(columns: Sequence[Width], some: Sequence[int], gap: int) -> int:
    return sum(columns[number].least for number in some) + gap * (len(some) - 1)


def _fitted(columns: Sequence[Width], room: int, gap: int) -> tuple[int, ...]:
    """Full widths, and of these the widest made narrower until all fit or none can be."""
    widths = [it.full for it in columns]
    for _ in range(sum(it.full - it.least for it in columns)):
        if sum(widths) + gap * (len(widths) - 1) <= room:
            break
        breakable = (number for number, it in enumerate(columns) if widths[number] > it.least)
        widths[max(breakable, key=widths.__getitem__)] -= 1
    return tuple(widths)


def _overflows(found: Iterable[Panel], room: int, gap: int) -> bool:
    return any(sum(it.widths) + gap * (len(it.widths) - 1) > room for it in found)


def _longest(texts: Iterable[str]) -> int:
    return max(map(cell_len, texts), default=0)
