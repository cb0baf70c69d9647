"""A number as it is printed, and what it may have been before it was rounded."""

from __future__ import annotations

import re
from dataclasses import dataclass

from adhoc.core.errors import RecordError

BOLD = "**"
_CELL = re.compile(r"(?P<value>-|\d+(?:\.\d+)?)\s*(?:\((?P<gain>-|-?\d+(?:\.\d+)?)\))?")


@dataclass(frozen=True)
class PrintedNumber:
    """A rounded number: what was rounded lies within `half` of `value`.

    `half` is half a unit of the last digit that is printed, which allows for any way of breaking ties.
    """

    value: float
    half: float

    @property
    def low(self) -> float:
        """The least that it may have been."""
        return self.value - self.half

    @property
    def high(self) -> float:
        """The most that it may have been."""
        return self.value + self.half


@dataclass(frozen=True)
class PrintedCell:
    """A cell of a table of the paper: a value, and in brackets the improvement on the team alone."""

    text: str
    bold: bool
    value: PrintedNumber | None
    gain: PrintedNumber | None


def read_cell(printed: str, where: str) -> PrintedCell:
    """Read one cell, e.g. `**21.0 (37.3)**`. Raises RecordError, which says `where`, if it is none."""
    text = printed.removeprefix(BOLD).removesuffix(BOLD)
    match = _CELL.fullmatch(text)
    if match is None:
        raise RecordError(f"{where}: {printed!r} is no value with an improvement in brackets")
    return PrintedCell(text, text != printed, _number(match["value"]), _number(match["gain"]))


def _number(text: str | None) -> PrintedNumber | None:
    if text is None or text == "-":
        return None
    digits = len(text.partition(".")[2])
    return PrintedNumber(float(text), 0.5 * 10.0**-digits)
