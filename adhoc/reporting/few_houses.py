"""What a table says where its intervals come from few houses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from adhoc.core.counting import counted
from adhoc.statistics.intervals import LEAST_HOUSES

FEW_HOUSES = 10
"""With fewer, intervals are too narrow, which is said below the table, and no difference is marked by its
interval; with fewer than `LEAST_HOUSES` they are not shown at all."""
WHERE = "docs/statistics.md"


def few_houses(houses: Iterable[int]) -> Iterator[str]:
    """Remarks on intervals from so many houses; none where there are enough.

    How often such intervals hold the truth was measured (`docs/statistics.md`).
    """
    found = set(houses)
    few, too_few = (
        {it for it in found if LEAST_HOUSES <= it < FEW_HOUSES},
        {it for it in found if it < LEAST_HOUSES},
    )
    if few:
        yield f"{_told(few)}: intervals from fewer than {FEW_HOUSES} houses are too narrow ({WHERE})"
    if too_few:
        yield f"{_told(too_few)}: no intervals ([?]) from fewer than {LEAST_HOUSES} houses ({WHERE})"


def _told(houses: set[int]) -> str:
    low, high = min(houses), max(houses)
    return counted(high, "house") if low == high else f"{low} to {high} houses"
