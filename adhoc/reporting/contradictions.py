"""Which cells of the paper's tables contradict each other, found from the numbers alone.

Three things must hold whatever was measured: a percentage in brackets follows from the value before it and
from the team alone; one quantity that is printed twice is the same; and no team fully does more of its
tasks than of their objects (%PS is at least %Suc). Numbers are taken as rounded to the digits that they are
printed with, so that a cell is named only if no values that round to what is printed fit together.

The percentages are judged against what the team alone had, not against a misprint of it: of the numbers that
are printed for the same team, the one with the most votes, one for each time that it is printed and one for
each percentage in all of the team's blocks that fits it. Where more than half of the percentages of a block
do not fit that, the team alone is named instead of them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from adhoc.reporting.paper_numbers import METRICS, PaperBlock, PaperNumbers, PaperRow, PaperTable
from adhoc.reporting.printed import PrintedNumber

RISING = ("success", "partial_success")
"""Metrics whose improvement is their rise; that of the others is their decline."""
WITH_GAIN = METRICS[:4]
"""All but the efficiency have percentages."""
EXACT = 1e-9
"""Slack for the arithmetic of a computer; a percentage on the very edge of its rounding is not named."""
TOLERANCE = (
    "every printed number stands for all that round to it: half a unit of its last digit up and down, for "
    "the value, the team alone's and the percentage"
)


@dataclass(frozen=True)
class Place:
    """A cell."""

    table: str
    heading: str
    join_step: int
    row: str
    metric: str
    printed: str

    def __str__(self) -> str:
        team = "" if self.heading == str(self.join_step) else f"{self.heading}, "
        return f"{self.table}, {team}t0={self.join_step}, {self.row}"


@dataclass(frozen=True)
class Contradiction:
    """A cell that does not fit the others, and why."""

    place: Place
    reason: str


References = Mapping[tuple[str, str], PrintedNumber | None]
"""What a team alone had by team and metric; None where two numbers have equally many votes."""


def contradictions(numbers: PaperNumbers) -> list[Contradiction]:
    """All that are found, in the order of the tables; a cell may be there for several reasons."""
    references = {(team, metric): _reference(numbers, team, metric) for team, metric in _quantities(numbers)}
    found = [
        *(it for table, block in numbers.blocks() for it in _percentages(table, block, references)),
        *_repeated(numbers, references),
        *(it for table, block in numbers.blocks() for it in _partial_success(table, block)),
    ]
    order = {_place(*it): number for number, it in enumerate(_cells(numbers))}
    return sorted(found, key=lambda it: order[it.place])


def _quantities(numbers: PaperNumbers) -> Iterator[tuple[str, str]]:
    teams = dict.fromkeys(block.team for _, block in numbers.blocks())
    return ((team, metric) for team in teams for metric in METRICS)


def _reference(numbers: PaperNumbers, team: str, metric: str) -> PrintedNumber | None:
    blocks = [block for _, block in numbers.blocks() if block.team == team]
    printed = [number for block in blocks if (number := block.alone.cell(metric).value) is not None]
    ranges = [_implied_reference(row, metric) for block in blocks for row in _with_gain(block, metric)]
    votes = Counter(printed)
    for number in votes:
        votes[number] += _covering(ranges, number.low, number.high)
    best = [number for number, many in votes.items() if many == max(votes.values())]
    return best[0] if len(best) == 1 else None


def _with_gain(block: PaperBlock, metric: str) -> list[PaperRow]:
    """The rows with a percentage to judge."""
    rows = (row for row in block.rows if metric in WITH_GAIN)
    return [row for row in rows if row.cell(metric).gain and row.cell(metric).value]


def _percentages(table: PaperTable, block: PaperBlock, references: References) -> Iterator[Contradiction]:
    for metric in WITH_GAIN:
        rows, printed = _with_gain(block, metric), block.alone.cell(metric).value
        if printed is None or not rows:
            continue
        ranges = [_implied_reference(row, metric) for row in rows]
        true = references[block.team, metric] or printed
        low, high, told = true.low, true.high, f"{true.value:g}"
        if 2 * _covering(ranges, low, high) < len(rows):
            low, high = _most_covered(ranges)
            told = _range(low, high)
        misfits = len(rows) - _covering(ranges, printed.low, printed.high)
        if misfits and (low, high) != (printed.low, printed.high):
            yield Contradiction(
                _place(table, block, block.alone, metric),
                f"{misfits} of the {len(rows)} percentages that refer to it do not fit it; "
                f"{_covering(ranges, low, high)} fit {told}",
            )
        for row, (least, most) in zip(rows, ranges):
            if most < low - EXACT or least > high + EXACT:
                yield Contradiction(_place(table, block, row, metric), _misfit(row, metric, low, high))


def _misfit(row: PaperRow, metric: str, low: float, high: float) -> str:
    """What the value gives as percentage, and the percentage as value."""
    cell = row.cell(metric)
    assert cell.value is not None
    assert cell.gain is not None
    sign = 1.0 if metric in RISING else -1.0
    gains = [sign * 100.0 * (value / ref - 1.0) for value in _ends(cell.value) for ref in (low, high)]
    values = [ref * (1.0 + sign * gain / 100.0) for gain in _ends(cell.gain) for ref in (low, high)]
    away = max(min(gains) - cell.gain.value, cell.gain.value - max(gains))
    slip = " (a slip in the last digit)" if away < 2.0 * cell.gain.half else ""
    percent, value = _range(min(gains), max(gains)), _range(min(values), max(values))
    return (
        f"beside {_range(low, high)} of the team alone, {cell.value.value:g} is {percent} percent, not "
        f"{cell.gain.value:g}{slip}; that would be {value}"
    )


def _implied_reference(row: PaperRow, metric: str) -> tuple[float, float]:
    """Between what the team alone must have had for the row's value and percentage to fit."""
    cell = row.cell(metric)
    assert cell.value is not None
    assert cell.gain is not None
    sign = 1.0 if metric in RISING else -1.0
    ends = [value / (1.0 + sign * gain / 100.0) for value in _ends(cell.value) for gain in _ends(cell.gain)]
    return min(ends), max(ends)


def _most_covered(ranges: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """The part of the line that lies in most of the ranges; the first of several."""
    starts = [low for low, _ in ranges]
    best = max(starts, key=lambda at: _covering(ranges, at, at))
    covering = [(low, high) for low, high in ranges if low - EXACT <= best <= high + EXACT]
    return best, min(high for _, high in covering)


def _covering(ranges: Iterable[tuple[float, float]], low: float, high: float) -> int:
    return sum(start <= high + EXACT and end >= low - EXACT for start, end in ranges)


def _repeated(numbers: PaperNumbers, references: References) -> Iterator[Contradiction]:
    """The team alone is the same whenever somebody would join, and a row of two tables the same in both."""
    printed: dict[tuple[object, ...], list[tuple[Place, float]]] = {}
    usual: dict[tuple[object, ...], PrintedNumber | None] = {}
    for table, block, row, metric in _cells(numbers):
        number = row.cell(metric).value
        if number is not None:
            step = None if row.is_alone else block.join_step
            key = (block.team, row.policy, row.model, step, metric)
            printed.setdefault(key, []).append((_place(table, block, row, metric), number.value))
            usual[key] = references[block.team, metric] if row.is_alone else None
    for quantity, places in printed.items():
        right = usual[quantity]
        for place, value in _odd(places, None if right is None else right.value):
            others = [(where, other) for where, other in places if other != value]
            told = "; ".join(f"{other} in {it.table}, t0={it.join_step}" for it, other in others)
            yield Contradiction(place, f"the same is {told}")


def _odd(places: Sequence[tuple[Place, float]], right: float | None) -> list[tuple[Place, float]]:
    """Those that are not what is `right`, or than most are; all that differ if none is more usual."""
    counts = Counter(value for _, value in places)
    if len(counts) == 1:
        return []
    usual = [value for value, times in counts.items() if times == max(counts.values())]
    if right is None and len(usual) == 1:
        right = usual[0]
    return [(place, value) for place, value in places if value != right]


def _partial_success(table: PaperTable, block: PaperBlock) -> Iterator[Contradiction]:
    for row in block.rows:
        whole, part = row.cell("success").value, row.cell("partial_success").value
        if whole is not None and part is not None and part.high < whole.low - EXACT:
            yield Contradiction(
                _place(table, block, row, "partial_success"),
                f"less than its %Suc of {whole.value:g}, which counts only tasks with all objects in place",
            )


def _cells(numbers: PaperNumbers) -> Iterator[tuple[PaperTable, PaperBlock, PaperRow, str]]:
    for table, block in numbers.blocks():
        for row in block.rows:
            for metric in METRICS:
                yield table, block, row, metric


def _place(table: PaperTable, block: PaperBlock, row: PaperRow, metric: str) -> Place:
    return Place(table.name, block.heading, block.join_step, row.label, metric, row.cell(metric).text)


def _ends(number: PrintedNumber) -> tuple[float, float]:
    return number.low, number.high


def _range(low: float, high: float) -> str:
    first, last = f"{low:.2f}", f"{high:.2f}"
    return first if first == last else f"{first} to {last}"
