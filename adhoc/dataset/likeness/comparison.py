"""How alike generated and real houses are: one table of distances, room type by room type.

Room types are compared each on its own, since the real houses at hand are a sample of single rooms whose
room types are not as frequent as in another sample. Compare houses of one number of rooms at a time: a
kitchen of a ten-room house is smaller than a kitchen that is the whole house.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from adhoc.core.streams import stream
from adhoc.dataset.likeness.distances import noise_floor
from adhoc.dataset.likeness.likeness_statistics import RoomStatistics, house_statistics
from adhoc.dataset.likeness.room_samples import FEWEST, Frequencies, Numbers, is_of_receptacles
from adhoc.houses.house import House

Sample = TypeVar("Sample", Numbers, Frequencies)


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
        for kind in (Numbers.kind, Frequencies.kind):
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
        rows += _rows(Numbers, group, real_rooms[group], generated_rooms[group], generator)
        rows += _rows(Frequencies, group, real_rooms[group], generated_rooms[group], generator)
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


def _rows(
    sample: type[Sample],
    group: str,
    real: Sequence[RoomStatistics],
    generated: Sequence[RoomStatistics],
    generator: np.random.Generator,
) -> list[Row]:
    rows = []
    for statistic in _statistics(sample, real):
        theirs, ours = sample(real, statistic), sample(generated, statistic)
        if not theirs.is_worth_a_row(ours):
            continue
        distance = theirs.distance(ours)
        rows.append(
            Row(
                statistic,
                group,
                sample.kind,
                theirs.mean(),
                ours.mean(),
                1.0 if distance is None else distance,
                _noise(sample, statistic, real, len(generated), generator),
                len(theirs),
                len(ours),
                theirs.remark(ours),
                theirs.shown,
                ours.shown,
            )
        )
    return rows


def _statistics(sample: type[Sample], rooms: Iterable[RoomStatistics]) -> list[str]:
    """The statistics in the order of measuring; those of single receptacles last, by name."""
    names = dict.fromkeys(name for room in rooms for name in sample.of(room))
    return sorted(names, key=lambda name: name if is_of_receptacles(name) else "")


def _noise(
    sample: type[Sample],
    statistic: str,
    real: Sequence[RoomStatistics],
    generated: int,
    generator: np.random.Generator,
) -> float | None:
    def distance(first: Sequence[RoomStatistics], second: Sequence[RoomStatistics]) -> float | None:
        return sample(first, statistic).distance(sample(second, statistic))

    return noise_floor(real, distance, generator, generated) if len(real) >= FEWEST else None
