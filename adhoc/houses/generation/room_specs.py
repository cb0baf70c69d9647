"""Which rooms a house has: trees of groups and rooms with their shares of the floor.

The table says what ProcTHOR's sixteen specifications of one to eight and ten rooms say (see NOTICE), except
that single rooms come as often as among real single-room houses, of which none is a bathroom.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import accumulate

import numpy as np

from adhoc.core.errors import HouseError

PRIVATE = "Bathroom"
"""The type of rooms that are entered from their own group only, by one door, and lead nowhere else."""


@dataclass(frozen=True)
class RoomShare:
    """A room of that type; `share` is its part of its group's floor, relative to the other members'."""

    room_type: str
    share: int = 1


@dataclass(frozen=True)
class RoomGroup:
    """Rooms and smaller groups that lie side by side and have doors to each other."""

    members: tuple[RoomShare | RoomGroup, ...]
    share: int = 1

    def leaves(self) -> Iterator[RoomShare]:
        """All rooms below this group, in order."""
        for member in self.members:
            if isinstance(member, RoomShare):
                yield member
            else:
                yield from member.leaves()


@dataclass(frozen=True)
class HouseSpec:
    """One kind of house. `weight` is how often it comes among houses of as many rooms.

    `sides`, if given, are the lowest and highest numbers of cells that the house is deep and long, in place
    of the law of `floor_boundary`.
    """

    weight: float
    rooms: RoomGroup
    sides: tuple[tuple[int, int], tuple[int, int]] | None = None


def room_counts() -> tuple[int, ...]:
    """The numbers of rooms that a house can have, lowest first."""
    return tuple(_BY_COUNT)


def draw_spec(rooms: int, generator: np.random.Generator) -> HouseSpec:
    """A kind of house of that many rooms. Raises HouseError if there is none."""
    specs = _BY_COUNT.get(rooms)
    if specs is None:
        known = ", ".join(str(count) for count in _BY_COUNT)
        raise HouseError(f"no house of {rooms} rooms can be generated: the number should be one of {known}")
    bounds = list(accumulate(spec.weight for spec in specs))
    drawn = generator.random() * bounds[-1]
    return next(spec for spec, bound in zip(specs, bounds) if drawn < bound)


def _group(*members: RoomShare | RoomGroup) -> RoomGroup:
    return RoomGroup(members)


def _of(share: int, member: RoomGroup) -> RoomGroup:
    return replace(member, share=share)


def _kitchen(share: int = 1) -> RoomShare:
    return RoomShare("Kitchen", share)


def _living(share: int = 1) -> RoomShare:
    return RoomShare("LivingRoom", share)


def _bedroom(share: int = 1) -> RoomShare:
    return RoomShare("Bedroom", share)


def _bath(share: int = 1) -> RoomShare:
    return RoomShare("Bathroom", share)


_SUITE = _group(_bedroom(2), _bath(1))
_DAY = _group(_kitchen(3), _living(2))
_EVEN_DAY = _group(_kitchen(), _living())
_LIVING_WITH_BATH = _group(_living(2), _bath(1))

_BY_COUNT: dict[int, tuple[HouseSpec, ...]] = {
    1: (
        HouseSpec(4, _group(_living())),
        HouseSpec(3, _group(_kitchen())),
        HouseSpec(3, _group(_bedroom())),
    ),
    2: (HouseSpec(1, _SUITE), HouseSpec(1, _EVEN_DAY)),
    3: (
        HouseSpec(1, _group(_of(2, _DAY), _bedroom())),
        HouseSpec(1, _group(_of(2, _EVEN_DAY), _bedroom())),
    ),
    4: (HouseSpec(1, _group(_SUITE, _DAY)),),
    5: (
        HouseSpec(1, _group(_of(2, _group(_kitchen(3), _bath(2), _living(3))), _bedroom(), _bedroom())),
        HouseSpec(1, _group(_SUITE, _bedroom(), _DAY)),
    ),
    6: (HouseSpec(1, _group(_SUITE, _SUITE, _DAY)),),
    7: (
        HouseSpec(
            1,
            _group(
                _of(3, _group(_of(2, _EVEN_DAY), _LIVING_WITH_BATH)),
                _of(2, _group(_bedroom(), _bedroom(), _bedroom())),
            ),
        ),
    ),
    8: (
        HouseSpec(
            1,
            _group(
                _of(4, _group(_of(2, _EVEN_DAY), _LIVING_WITH_BATH)),
                _bedroom(),
                _bedroom(),
                _of(2, _group(_bedroom(), _bath())),
            ),
            sides=((5, 8), (13, 16)),
        ),
    ),
    10: (
        HouseSpec(
            1,
            _group(
                _group(_EVEN_DAY, _group(_living(), _living())),
                _group(_SUITE, _SUITE, _SUITE),
            ),
        ),
        HouseSpec(1, _group(_of(2, _group(_EVEN_DAY, _SUITE)), _of(3, _group(_SUITE, _SUITE, _SUITE)))),
    ),
}
