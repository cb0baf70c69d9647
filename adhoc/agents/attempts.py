"""What a robot tried in vain, and when it may try again."""

from __future__ import annotations

import math
from collections import Counter


class Attempts:
    """Things, by id, that are left alone for a while after each failure, and for good after too many.

    Args:
        most: How often a thing is tried in all.
        retry_after: Steps before it is tried again.
    """

    def __init__(self, most: int = 3, retry_after: int = 30) -> None:
        self._most, self._retry_after = most, retry_after
        self._failures: Counter[str] = Counter()
        self._until: dict[str, float] = {}

    def put_off(self, name: str, step: int) -> None:
        """It was tried in vain at that step."""
        self._failures[name] += 1
        final = self._failures[name] >= self._most
        self._until[name] = math.inf if final else step + self._retry_after

    def pending(self, step: int) -> frozenset[str]:
        """What is left alone at that step."""
        return frozenset(name for name, until in self._until.items() if until > step)

    def will_retry(self, name: str) -> bool:
        """Whether it was put off, and not for good."""
        return self._until.get(name, math.inf) < math.inf
