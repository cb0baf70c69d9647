"""What a statistic found in some rooms, and how far that is from what it found in others.

`Numbers` and `Frequencies` have the same members, so that one table can be made of both.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from adhoc.dataset.likeness.distances import kolmogorov_smirnov, shares, total_variation
from adhoc.dataset.likeness.likeness_statistics import RoomStatistics

FEWEST = 20
"""Real rooms that a noise floor needs, and receptacles that a statistic of one type needs on both sides to
get a row: with fewer, a distance says little."""


class Numbers:
    """The numbers that one statistic found in some rooms.

    Args:
        rooms: where to look.
        statistic: its name.
    """

    kind = "KS"

    def __init__(self, rooms: Sequence[RoomStatistics], statistic: str) -> None:
        self.shown = [number for room in rooms for number in self.of(room).get(statistic, ())]
        self._is_of_receptacles = is_of_receptacles(statistic)

    @staticmethod
    def of(room: RoomStatistics) -> Mapping[str, Sequence[float]]:
        """All numbers of a room, by statistic."""
        return room.numbers

    def __len__(self) -> int:
        return len(self.shown)

    def mean(self) -> float:
        """Of the numbers."""
        return float(np.mean(self.shown))

    def is_worth_a_row(self, generated: Numbers) -> bool:
        """Whether both have numbers; of one type of receptacles enough, some of which hold something."""
        if self._is_of_receptacles:
            enough = min(len(self), len(generated)) >= FEWEST
            return enough and (any(self.shown) or any(generated.shown))
        return bool(self.shown and generated.shown)

    def distance(self, other: Numbers) -> float | None:
        """From 0 to 1; None if one of both is empty."""
        return kolmogorov_smirnov(self.shown, other.shown) if self.shown and other.shown else None

    def remark(self, generated: Numbers) -> str:
        """Where the mean of few real numbers lies among the generated: ties count half."""
        if len(self) >= FEWEST or len(generated) < FEWEST:
            return ""
        mean, ranks = np.mean(self.shown), np.asarray(generated.shown)
        share = float(np.mean(ranks < mean) + np.mean(ranks == mean) / 2)
        return f"real mean above {share:.0%} of generated"


class Frequencies:
    """How often one statistic found each name in some rooms.

    Args:
        rooms: where to look.
        statistic: its name.
    """

    kind = "TV"

    def __init__(self, rooms: Sequence[RoomStatistics], statistic: str) -> None:
        self._rooms = len(rooms)
        self._counts: Counter[str] = Counter()
        for room in rooms:
            self._counts.update(self.of(room).get(statistic, {}))
        self.shown = shares(self._counts) if self._counts else {}

    @staticmethod
    def of(room: RoomStatistics) -> Mapping[str, Mapping[str, int]]:
        """All counts of a room, by statistic."""
        return room.counts

    def __len__(self) -> int:
        return self._counts.total()

    def mean(self) -> float:
        """Things counted per room."""
        return self._counts.total() / self._rooms

    def is_worth_a_row(self, generated: Frequencies) -> bool:
        """Whether there is anything on either side."""
        return bool(self.shown or generated.shown)

    def distance(self, other: Frequencies) -> float | None:
        """From 0 to 1; None if one of both is empty."""
        return total_variation(self._counts, other._counts) if self.shown and other.shown else None

    def remark(self, generated: Frequencies) -> str:
        """`Chair 31% → 12%`: the name whose shares differ most, first here, then generated."""
        here, there = self.shown, generated.shown
        name = max(
            sorted({*here, *there}),
            key=lambda name: round(abs(here.get(name, 0.0) - there.get(name, 0.0)), 9),
        )
        return f"{name} {here.get(name, 0.0):.1%} → {there.get(name, 0.0):.1%}"


def is_of_receptacles(statistic: str) -> bool:
    """Whether a statistic has a number for every receptacle of one type."""
    return statistic.startswith(("items on a ", "items in a "))
