"""What is done in the tasks without skill on the newcomer's side: the floor beside the oracle's ceiling."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import mean

from adhoc.evaluation.records import Record
from adhoc.evaluation.scenario import Difficulty

ALL = "all"
"""The label of rows over everything."""


@dataclass(frozen=True)
class FloorRow:
    """Success of one ad hoc policy, or of none, in some tasks; shares of all of them."""

    difficulty: str
    """A `Difficulty`'s value, or `all`."""
    teammates: str
    """The size of the original team, or `all`."""
    ad_hoc: str
    """The ad hoc policy's label."""
    tasks: int
    success: float
    """%Suc as a share."""
    partial_success: float
    """%PS as a share."""
    temporal_steps: float
    """#TS; a failure counts the step limit."""


def floors(records: Sequence[Record]) -> tuple[FloorRow, ...]:
    """A row for each difficulty, team size and policy of a run, and the same over all sizes and tasks.

    Newcomers that join at different steps are told apart by their label.
    """
    labels = list(dict.fromkeys(_label(record) for record in records))
    levels = [level.value for level in Difficulty if any(it["difficulty"] == level.value for it in records)]
    sizes = sorted({record["teammates"] for record in records})
    groups = [(level, str(size)) for level in levels for size in (*sizes, ALL)] + [(ALL, ALL)]
    rows = []
    for level, size in groups:
        inside = [
            record
            for record in records
            if level in (ALL, record["difficulty"]) and size in (ALL, str(record["teammates"]))
        ]
        for label in labels:
            own = [record for record in inside if _label(record) == label]
            if own:
                rows.append(_row(level, size, label, own))
    return tuple(rows)


def floors_markdown(rows: Sequence[FloorRow]) -> str:
    """The rows as a Markdown table: one line for each group of tasks, %Suc and %PS of each policy."""
    labels = list(dict.fromkeys(row.ad_hoc for row in rows))
    groups = list(dict.fromkeys((row.difficulty, row.teammates) for row in rows))
    found = {(row.difficulty, row.teammates, row.ad_hoc): row for row in rows}
    head = [
        "difficulty",
        "team",
        "tasks",
        *(f"{label} {name}" for label in labels for name in ("%Suc", "%PS")),
    ]
    lines = [head, ["---", *("---:" for _ in head[1:])]]
    for group in groups:
        own = [found.get((*group, label)) for label in labels]
        tasks = max(row.tasks for row in own if row is not None)
        cells = [cell for row in own for cell in _cells(row)]
        lines.append([*group, str(tasks), *cells])
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def _cells(row: FloorRow | None) -> tuple[str, str]:
    if row is None:
        return "-", "-"
    return f"{100 * row.success:.1f}", f"{100 * row.partial_success:.1f}"


def _row(difficulty: str, teammates: str, label: str, records: Sequence[Record]) -> FloorRow:
    return FloorRow(
        difficulty,
        teammates,
        label,
        len(records),
        mean(bool(record["success"]) for record in records),
        mean(record["partial_success"] for record in records),
        mean(record["temporal_steps"] for record in records),
    )


def _label(record: Record) -> str:
    step = record["join_step"]
    label: str = record["policy_label"]
    return label if step in (None, 0) else f"{label} from step {step}"
