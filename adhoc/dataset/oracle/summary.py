"""The ceilings of a benchmark as a table: which tasks can be done, by difficulty and team size."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence, Sized
from dataclasses import dataclass
from statistics import median
from typing import Protocol

from rich import box
from rich.table import Table

from adhoc.core.errors import ConfigurationError
from adhoc.dataset.oracle.ceilings import Ceiling
from adhoc.evaluation.scenario import Difficulty

ALL = "all"
"""The label of rows over everything."""

_HEAD = (
    "difficulty",
    "team",
    "tasks",
    "team alone",
    "only with newcomer",
    "unsolved",
    "of these proven",
    "steps alone",
    "steps together",
    "least",
)


class Described(Protocol):
    """What is asked of a task: a scenario, or a line of a task file."""

    @property
    def id(self) -> str:
        """The task's id."""

    @property
    def difficulty(self) -> Difficulty:
        """Its category."""

    @property
    def team(self) -> Sized:
        """The original team."""


@dataclass(frozen=True)
class CeilingRow:
    """The ceilings of some tasks. Shares are of all of them, medians are over those that were solved."""

    difficulty: str
    """A `Difficulty`'s value, or `all`."""
    teammates: str
    """The size of the original team, or `all`."""
    tasks: int
    team: float
    """Share that the team solves alone."""
    newcomer: float
    """Share that it solves with the newcomer only."""
    none: float
    """Share that the oracle does not solve."""
    proven: float
    """Share that is proven to be unsolvable; part of `none`."""
    team_steps: float | None
    """Median steps of the team alone; None if it solved nothing."""
    joint_steps: float | None
    """Median steps with the newcomer, over everything that was solved."""
    least_steps: float | None
    """Median lower bound of `joint_steps`, over everything that was solved."""


def summarise(ceilings: Iterable[Ceiling], tasks: Iterable[Described]) -> tuple[CeilingRow, ...]:
    """One row for each difficulty and team size that occurs, one for each difficulty, and one for all.

    Raises ConfigurationError for a ceiling whose task is not among `tasks`.
    """
    known = {task.id: (task.difficulty, len(task.team)) for task in tasks}
    found: list[tuple[Difficulty, int, Ceiling]] = []
    for one in ceilings:
        if one.task_id not in known:
            raise ConfigurationError(f"there is a ceiling of {one.task_id!r}, but no task of that id")
        found.append((*known[one.task_id], one))
    rows: list[CeilingRow] = []
    for difficulty in Difficulty:
        ours = [(size, one) for level, size, one in found if level is difficulty]
        if not ours:
            continue
        for size in sorted({size for size, _ in ours}):
            rows.append(_row(difficulty.value, str(size), [one for other, one in ours if other == size]))
        rows.append(_row(difficulty.value, ALL, [one for _, one in ours]))
    if found:
        rows.append(_row(ALL, ALL, [one for _, _, one in found]))
    return tuple(rows)


def to_markdown(rows: Sequence[CeilingRow]) -> str:
    """The rows as a Markdown table."""
    lines = [_HEAD, ("---", *("---:" for _ in _HEAD[1:])), *(row_cells(row) for row in rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def to_table(rows: Sequence[CeilingRow]) -> Table:
    """The rows as a table for the terminal."""
    table = Table(title="What the oracle solves", box=box.SIMPLE_HEAD)
    for number, name in enumerate(_HEAD):
        table.add_column(name, justify="right" if number else "left")
    for row in rows:
        table.add_row(*row_cells(row), end_section=row.teammates == ALL)
    return table


def row_cells(row: CeilingRow) -> tuple[str, ...]:
    """The texts of one row, as both tables print them."""
    return (
        row.difficulty,
        row.teammates,
        str(row.tasks),
        *(f"{100 * share:.1f}%" for share in (row.team, row.newcomer, row.none, row.proven)),
        *(
            "-" if steps is None else f"{steps:g}"
            for steps in (row.team_steps, row.joint_steps, row.least_steps)
        ),
    )


def _row(difficulty: str, teammates: str, ceilings: Sequence[Ceiling]) -> CeilingRow:
    def share(holds: Callable[[Ceiling], bool]) -> float:
        return sum(map(holds, ceilings)) / len(ceilings)

    solved = [one for one in ceilings if one.kind != "none"]
    return CeilingRow(
        difficulty,
        teammates,
        len(ceilings),
        share(lambda one: one.kind == "team"),
        share(lambda one: one.kind == "newcomer"),
        share(lambda one: one.kind == "none"),
        share(lambda one: one.kind == "none" and one.proven),
        _median(one.team_steps for one in solved),
        _median(one.joint_steps for one in solved),
        _median(one.least_steps for one in solved),
    )


def _median(steps: Iterable[int | None]) -> float | None:
    known = [number for number in steps if number is not None]
    return float(median(known)) if known else None
