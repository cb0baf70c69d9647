"""Many comparisons at once: p-values that say what is beyond chance in all of them together."""

from __future__ import annotations

from collections.abc import Sequence

from adhoc.core.errors import ConfigurationError


def holm(p_values: Sequence[float]) -> list[float]:
    """Holm's adjusted p-values, in the order given.

    The smallest of m is multiplied by m, the next by m - 1, and so on, at most 1 and never below one that was
    smaller (Holm, Scandinavian Journal of Statistics 6, 1979). Calling beyond chance what is adjusted to at
    most 0.05 errs at all, in any of the m comparisons, with a probability of at most 0.05, however they hang
    together; those between policies of one benchmark do.

    Raises:
        ConfigurationError: a p-value that is none.
    """
    for value in p_values:
        if not 0.0 <= value <= 1.0:
            raise ConfigurationError(f"p-value {value}: must be between 0 and 1")
    adjusted = [1.0] * len(p_values)
    largest = 0.0
    for rank, number in enumerate(sorted(range(len(p_values)), key=lambda it: p_values[it])):
        largest = max(largest, min(1.0, (len(p_values) - rank) * p_values[number]))
        adjusted[number] = largest
    return adjusted
