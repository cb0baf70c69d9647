"""How well a language model's common sense agrees with the placement table, from records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

from adhoc.core.errors import AssetError
from adhoc.evaluation.records import Record
from adhoc.houses.facts import is_reasonable
from adhoc.tasks.common_sense import CommonSense

FIELD = "common_sense"
"""The field of a record; None where no language model judged."""


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
