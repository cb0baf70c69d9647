"""How alike generated and real houses are: one table of distances, room type by room type.

Room types are compared each on its own, since the real houses at hand are a sample of single rooms whose
room types are not as frequent as in another sample. Compare houses of one number of rooms at a time: a
kitchen of a ten-room house is smaller than a kitchen that is the whole house.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from adhoc.core.streams import stream
from adhoc.dataset.likeness.distances import kolmogorov_smirnov, noise_floor, shares, total_variation
from adhoc.dataset.likeness.likeness_statistics import RoomStatistics, house_statistics
from adhoc.houses.house import House

KOLMOGOROV_SMIRNOV = "KS"
TOTAL_VARIATION = "TV"
FEWEST = 20
"""Real rooms that a noise floor needs, and receptacles that a statistic of one type needs on both sides to
get a row: with fewer, a distance says little."""


@dataclass(frozen=True)
class Row:
    """One statistic of one group of rooms."""

    statistic: str
    """With its unit; a bare name is a number of things."""
    group: str
    """The room type, or `WHOLE_HOUSE`."""
    kind: str
    """`KS` (of numbers) or `TV` (of frequencies)."""
    real_mean: float
    """Mean of the numbers; for frequencies, things counted per room."""
    generated_mean: float
    distance: float
    noise: float | None
    """The mean distance of two random halves of the real rooms (the second no larger than what was
    generated); None if there are fewer than `FEWEST`."""
    real_count: int
    """How many numbers, or things counted, the real rooms gave."""
    generated_count: int
    remark: str
    """For frequencies, the name whose shares differ most and both shares; for numbers of few real rooms,
    where their mean lies among the generated ones."""
    real: Sequence[float] | Mapping[str, float]
    """All numbers, or the shares by name, most frequent first."""
    generated: Sequence[float] | Mapping[str, float]

    @property
    def differs(self) -> bool:
        """Whether the distance is above the noise floor."""
        return self.noise is not None and self.distance > self.noise


@dataclass(frozen=True)
class Likeness:
    """Generated against real houses, row by row: by room type, numbers before frequencies."""

    rows: tuple[Row, ...]
    real_houses: int
    generated_houses: int

    def groups(self) -> tuple[str, ...]:
        """The room types compared, in the order of the rows."""
        return tuple(dict.fromkeys(row.group for row in self.rows))

    def summary(self) -> str:
        """How many rows differ more than by chance, and the mean distance of each kind."""
        known = [row for row in self.rows if row.noise is not None]
        means = []
        for kind in (KOLMOGOROV_SMIRNOV, TOTAL_VARIATION):
            distances = [row.distance for row in self.rows if row.kind == kind]
            if distances:
                means.append(f"mean {kind} {np.mean(distances):.3f}")
        apart = sum(row.differs for row in known)
        above = (
            f"{apart} of {len(known)} distances are above the noise floor" if known else "too few real rooms"
        )
        return "; ".join([above, *means])

    def row(self, statistic: str, group: str) -> Row:
        """The row of a statistic and a room type; raises KeyError."""
        for row in self.rows:
            if (row.statistic, row.group) == (statistic, group):
                return row
        raise KeyError((statistic, group))


def compare(
    real: Sequence[House], generated: Sequence[House], generator: np.random.Generator | None = None
) -> Likeness:
    """Measure both sets of houses and their distances.

    Args:
        real: Houses to be like.
        generated: Houses to judge.
        generator: Draws the random halves of the noise floor; a fixed stream if None.

    Returns:
        A row for every statistic that both sets have, in room types that both have. Statistics of one
        receptacle type need `FEWEST` receptacles on both sides.
    """
    generator = stream(0, "likeness") if generator is None else generator
    real_rooms, generated_rooms = _by_group(real), _by_group(generated)
    rows: list[Row] = []
    for group in sorted(real_rooms.keys() & generated_rooms.keys(), key=_group_order):
        rows += _number_rows(group, real_rooms[group], generated_rooms[group], generator)
        rows += _frequency_rows(group, real_rooms[group], generated_rooms[group], generator)
    return Likeness(tuple(rows), len(real), len(generated))


def _by_group(houses: Iterable[House]) -> dict[str, list[RoomStatistics]]:
    groups: dict[str, list[RoomStatistics]] = {}
    for house in houses:
        for room in house_statistics(house):
            groups.setdefault(room.group, []).append(room)
    return groups


GROUP_ORDER = ("Kitchen", "LivingRoom", "Bedroom", "Bathroom")


def _group_order(group: str) -> tuple[int, str]:
    return (GROUP_ORDER.index(group) if group in GROUP_ORDER else len(GROUP_ORDER)), group


def _number_rows(
    group: str,
    real: Sequence[RoomStatistics],
    generated: Sequence[RoomStatistics],
    generator: np.random.Generator,
) -> list[Row]:
    rows = []
    for statistic in _names(real, lambda room: room.numbers):
        ours, theirs = _numbers(generated, statistic), _numbers(real, statistic)
        if not ours or not theirs or (_is_of_receptacles(statistic) and not _is_worth_a_row(theirs, ours)):
            continue
        rows.append(
            Row(
                statistic,
                group,
                KOLMOGOROV_SMIRNOV,
                float(np.mean(theirs)),
                float(np.mean(ours)),
                kolmogorov_smirnov(theirs, ours),
                _noise(real, len(generated), partial(_number_distance, statistic), generator),
                len(theirs),
                len(ours),
                _place_among(theirs, ours),
                theirs,
                ours,
            )
        )
    return rows


def _frequency_rows(
    group: str,
    real: Sequence[RoomStatistics],
    generated: Sequence[RoomStatistics],
    generator: np.random.Generator,
) -> list[Row]:
    rows = []
    for statistic in _names(real, lambda room: room.counts):
        ours, theirs = _counts(generated, statistic), _counts(real, statistic)
        if not ours and not theirs:
            continue
        rows.append(
            Row(
                statistic,
                group,
                TOTAL_VARIATION,
                theirs.total() / len(real),
                ours.total() / len(generated),
                _apart(theirs, ours),
                _noise(real, len(generated), partial(_count_distance, statistic), generator),
                theirs.total(),
                ours.total(),
                _largest_gap(theirs, ours),
                _shares(theirs),
                _shares(ours),
            )
        )
    return rows


def _noise(
    real: Sequence[RoomStatistics],
    generated: int,
    distance: Callable[[Sequence[RoomStatistics], Sequence[RoomStatistics]], float | None],
    generator: np.random.Generator,
) -> float | None:
    return noise_floor(real, distance, generator, generated) if len(real) >= FEWEST else None


def _names(
    rooms: Iterable[RoomStatistics], part: Callable[[RoomStatistics], Mapping[str, object]]
) -> list[str]:
    """The statistics in the order of measuring; those of single receptacles last, by name."""
    names = dict.fromkeys(name for room in rooms for name in part(room))
    return sorted(names, key=lambda name: name if _is_of_receptacles(name) else "")


def _is_of_receptacles(statistic: str) -> bool:
    return statistic.startswith(("items on a ", "items in a "))


def _is_worth_a_row(real: Sequence[float], generated: Sequence[float]) -> bool:
    """Whether there are enough receptacles of a type, and whether any holds something."""
    return min(len(real), len(generated)) >= FEWEST and (any(real) or any(generated))


def _place_among(real: Sequence[float], generated: Sequence[float]) -> str:
    """Where the mean of few real numbers lies among the generated: ties count half."""
    if len(real) >= FEWEST or len(generated) < FEWEST:
        return ""
    mean, ranks = np.mean(real), np.asarray(generated)
    share = float(np.mean(ranks < mean) + np.mean(ranks == mean) / 2)
    return f"real mean above {share:.0%} of generated"


def _numbers(rooms: Iterable[RoomStatistics], statistic: str) -> list[float]:
    return [number for room in rooms for number in room.numbers.get(statistic, ())]


def _counts(rooms: Iterable[RoomStatistics], statistic: str) -> Counter[str]:
    total: Counter[str] = Counter()
    for room in rooms:
        total.update(room.counts.get(statistic, {}))
    return total


def _number_distance(
    statistic: str, first: Sequence[RoomStatistics], second: Sequence[RoomStatistics]
) -> float | None:
    a, b = _numbers(first, statistic), _numbers(second, statistic)
    return kolmogorov_smirnov(a, b) if a and b else None


def _count_distance(
    statistic: str, first: Sequence[RoomStatistics], second: Sequence[RoomStatistics]
) -> float | None:
    a, b = _counts(first, statistic), _counts(second, statistic)
    return total_variation(a, b) if a and b else None


def _apart(real: Counter[str], generated: Counter[str]) -> float:
    """Total variation; 1 where one side has nothing at all."""
    return total_variation(real, generated) if real and generated else 1.0


def _shares(counts: Counter[str]) -> dict[str, float]:
    return shares(counts) if counts else {}


def _largest_gap(theirs: Counter[str], ours: Counter[str]) -> str:
    """`Chair 31% → 12%`: the name whose shares differ most, first real, then generated."""
    real, generated = _shares(theirs), _shares(ours)
    name = max(
        sorted({*real, *generated}),
        key=lambda name: round(abs(real.get(name, 0.0) - generated.get(name, 0.0)), 9),
    )
    return f"{name} {real.get(name, 0.0):.1%} → {generated.get(name, 0.0):.1%}"
