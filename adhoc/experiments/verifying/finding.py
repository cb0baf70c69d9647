"""What a check found."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from adhoc.evaluation.records import FILE_NAME, Record

Trouble = tuple[str, str]
"""A field, and what is wrong with it."""


@dataclass(frozen=True)
class Finding:
    """One thing that is wrong with a run folder, or worth a note."""

    file: str
    """Relative to the run folder."""
    line: int | None
    """From 1; None if it is about the whole file."""
    field: str
    """The field at fault; empty if it is none."""
    text: str
    is_fault: bool = True
    """Whether the folder fails for it."""

    def __str__(self) -> str:
        line = "" if self.line is None else f", line {self.line}"
        field = f"{self.field}: " if self.field else ""
        return f"{'' if self.is_fault else 'note: '}{self.file}{line}: {field}{self.text}"


@dataclass(frozen=True)
class NumberedRecord:
    """A record, and the line where it is."""

    line: int
    record: Record

    def finding(self, trouble: Trouble) -> Finding:
        """What is wrong with a field of it, told with its episode."""
        field, text = trouble
        return Finding(FILE_NAME, self.line, field, f"{text} (episode {self.record['episode_id']})")


def expected(field: str, found: object, wanted: object, because: str) -> Iterator[Trouble]:
    """The trouble, if there is one, that a field does not have the value that follows from others."""
    if found != wanted or isinstance(found, bool) != isinstance(wanted, bool):
        yield field, f"is {found!r}; {because} is {wanted!r}"
