"""How well a language model's common sense agrees with the placement table, from episode records."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from adhoc.evaluation.common_sense import agreements
from adhoc.evaluation.records import Record
from adhoc.reporting.table import Table, plain_table

TITLE = "Common sense of a language model, against the placement table"
COLUMNS = ("judge", "%agreed ↑", "only judge: misplaced", "only table: misplaced", "unanswered", "judged")
EXPLANATION = (
    "a judgement is one type of object in one receptacle and room type, counted once in each episode in "
    "which a robot asked for it; the referee goes by the table"
)


def agreement_table(records: Sequence[Record]) -> Table | None:
    """The agreement of every judge; None if no language model judged."""
    rows = list(_rows(records))
    return plain_table("agreement", TITLE, COLUMNS, 1, [rows], [EXPLANATION]) if rows else None


def _rows(records: Sequence[Record]) -> Iterator[tuple[str, ...]]:
    for judge, counts in sorted(agreements(records).items()):
        accuracy = "-" if counts.accuracy is None else f"{counts.accuracy:.1f}"
        numbers = (counts.false_misplaced, counts.false_in_place, counts.unanswered, counts.asked)
        yield (judge, accuracy, *map(str, numbers))
