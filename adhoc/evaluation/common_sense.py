"""How well a language model's common sense agrees with the placement table, from records."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass

from rich import box
from rich.table import Table

from adhoc.core.errors import AssetError
from adhoc.evaluation.records import Record
from adhoc.houses.facts import is_reasonable
from adhoc.tasks.common_sense import CommonSense

FIELD = "common_sense"
"""The field of a record; None where no language model judged."""
TITLE = "Common sense of a language model, against the placement table"
COLUMNS = ("judge", "%agreed ↑", "only judge: misplaced", "only table: misplaced", "unanswered", "judged")
EXPLANATION = (
    "a judgement is one type of object in one receptacle and room type, counted once in each episode in "
    "which a robot asked for it; the referee goes by the table"
)


@dataclass
class Agreement:
    """Judgements of one model; `asked` is the sum of the others."""

    asked: int = 0
    agreed: int = 0
    false_misplaced: int = 0
    """Misplaced for the judge alone: robots carry away what the referee leaves."""
    false_in_place: int = 0
    """Misplaced for the table alone: robots overlook what the referee waits for."""
    unanswered: int = 0
    """No usable reply; the robots took it for in place."""

    @property
    def accuracy(self) -> float | None:
        """Percent of the judgements that agree with the table; unanswered ones do not. None without any."""
        return 100.0 * self.agreed / self.asked if self.asked else None

    def count(self, judged: bool | None, by_table: bool) -> None:
        """Take in whether something is misplaced, according to both."""
        self.asked += 1
        self.unanswered += judged is None
        self.agreed += judged is by_table
        self.false_misplaced += judged is True and not by_table
        self.false_in_place += judged is False and by_table


def judgement_counts(common_sense: CommonSense | None) -> dict[str, str | int] | None:
    """What a record says of a language model's judgements in its episode; None if none judged.

    Objects that the table does not know are left out: there is nothing to compare with.
    """
    if common_sense is None or common_sense.judge is None:
        return None
    agreement = Agreement()
    for (category, receptacle, room_type), judged in common_sense.judged.items():
        try:
            by_table = not is_reasonable(category, receptacle, room_type)
        except AssetError:
            continue
        agreement.count(judged, by_table)
    return {"judge": common_sense.judge, **asdict(agreement)}


def agreements(records: Sequence[Record]) -> dict[str, Agreement]:
    """The judgements in all records, by judge."""
    by_judge: dict[str, Agreement] = {}
    for record in records:
        found = record.get(FIELD)
        if found is not None:
            total = by_judge.setdefault(str(found["judge"]), Agreement())
            for name in asdict(total):
                setattr(total, name, getattr(total, name) + int(found[name]))
    return by_judge


def agreement_table(records: Sequence[Record]) -> Table | None:
    """The agreement of every judge, for the terminal; None if no language model judged."""
    rows = list(_rows(records))
    if not rows:
        return None
    table = Table(
        title=TITLE, title_justify="left", box=box.SIMPLE_HEAD, collapse_padding=True, pad_edge=False
    )
    for column in COLUMNS:
        table.add_column(column, justify="left" if column == COLUMNS[0] else "right")
    for row in rows:
        table.add_row(*row)
    table.caption, table.caption_justify = EXPLANATION, "left"
    return table


def agreement_markdown(records: Sequence[Record]) -> str:
    """The same as Markdown; empty if no language model judged."""
    rows = list(_rows(records))
    if not rows:
        return ""
    lines = [f"## {TITLE}", "", _line(COLUMNS), "|---|" + "---:|" * (len(COLUMNS) - 1)]
    return "\n".join([*lines, *map(_line, rows), "", f"- {EXPLANATION}"]) + "\n"


def _rows(records: Sequence[Record]) -> Iterator[tuple[str, ...]]:
    for judge, counts in sorted(agreements(records).items()):
        accuracy = "-" if counts.accuracy is None else f"{counts.accuracy:.1f}"
        numbers = (counts.false_misplaced, counts.false_in_place, counts.unanswered, counts.asked)
        yield (judge, accuracy, *map(str, numbers))


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
