"""Whether the records of a folder belong together: one task a name, one configuration a row, one version."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence

from adhoc.core.counting import counted
from adhoc.evaluation.records import Record
from adhoc.experiments.verifying.finding import Finding, NumberedRecord

OF_TASK = ("scenario_hash", "house_id", "rooms", "difficulty", "teammates", "misplaced", "seed")
"""What is the same in all episodes of one task."""


def together_findings(records: Sequence[NumberedRecord]) -> Iterator[Finding]:
    """What is not as in the other records of the same task, of the same row, of the folder."""
    yield from _twice(records)
    for field in OF_TASK:
        yield from _differing(records, lambda it: it["task_id"], field, "for this task")
    yield from _differing(records, _row, "config_hash", "for this team, policy and model")
    yield from _differing(records, lambda it: None, "library_version", "in this folder")


def _row(record: Record) -> tuple[str, str, str | None]:
    """Episodes of a folder that agree in these must agree in their settings."""
    return record["team"], record["policy"], record["model"]


def _twice(records: Sequence[NumberedRecord]) -> Iterator[Finding]:
    first: dict[str, int] = {}
    for it in records:
        line = first.setdefault(it.record["episode_id"], it.line)
        if line != it.line:
            yield it.finding(("episode_id", f"is there twice, first in line {line}"))


def _differing(
    records: Sequence[NumberedRecord], group: Callable[[Record], object], field: str, where: str
) -> Iterator[Finding]:
    """Records that are not as most of their group; as the first of it, where there are as many of both."""
    groups: dict[object, list[NumberedRecord]] = {}
    for it in records:
        groups.setdefault(group(it.record), []).append(it)
    for together in groups.values():
        values = Counter(repr(it.record.get(field)) for it in together)
        usual, count = values.most_common(1)[0]
        line = next(it.line for it in together if repr(it.record.get(field)) == usual)
        for it in together if len(values) > 1 else ():
            found = repr(it.record.get(field))
            if found != usual:
                yield it.finding(
                    (field, f"is {found}; {where} it is {usual} (line {line}, {counted(count, 'record')})")
                )
