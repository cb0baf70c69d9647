"""Misplacing objects in a house (the paper's Benchmark Dataset; appendix, Details of Dataset)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from adhoc.core.errors import ConfigurationError, WorldError
from adhoc.core.streams import derive_seed, stream
from adhoc.core.values import Point
from adhoc.evaluation.ranges import PAPER_RANGES, Ranges
from adhoc.evaluation.scenario import Displacement, displace
from adhoc.houses.anonymous import anonymous
from adhoc.houses.facts import is_reasonable
from adhoc.houses.house import FLOOR, House, HouseObject
from adhoc.worlds.world import ObjectTruth, World

Accept = Callable[[ObjectTruth], bool]
"""Whether an object may lie misplaced where it is now; what it accepts stays there."""
Accepting = Callable[[House], Accept]
"""Makes an `Accept` for a house, whose ids the objects have."""

DECIMALS = 5
"""Of recorded positions: a hundredth of a millimetre."""


def accept_all(house: House) -> Accept:
    """The `Accepting` that has nothing against any place."""
    return lambda truth: True


@dataclass(frozen=True)
class Disorder:
    """A house in which objects are misplaced: a scenario that has no robots yet."""

    house: House
    misplaced: tuple[Displacement, ...]
    seed: int


def misplace(
    world: World,
    house: House,
    seed: int,
    count: int,
    ranges: Ranges = PAPER_RANGES,
    accepting: Accepting = accept_all,
) -> Disorder:
    """Misplace objects, and leave the world so; equal arguments give equal results.

    Only objects are misplaced that some right place has room for, as all of them lie in the end: it is tried
    out. The things in the house get new ids (`houses.anonymous`), since robots see ids, and ProcTHOR's tell
    where a thing belongs.

    Args:
        world: A world to try the placements in; it is reset.
        house: The house.
        seed: Seeds the draws.
        count: The number of misplaced objects.
        ranges: What to draw from.
        accepting: What it makes is asked about each misplaced object where it came to rest; where it says
            no, another place or object is tried.

    Raises:
        ConfigurationError: The house has too few objects that can be misplaced.
    """
    house = anonymous(house, seed)
    generator = stream(seed, "scenario", house.id, "misplaced")
    pickupable = [thing for thing in house.objects if thing.pickupable]
    drawing = _Drawing(world, house, seed, accepting(house))
    for position in generator.permutation(len(pickupable)):
        if len(drawing.displaced) == count:
            break
        drawing.displace_one(_wrong_places(house, pickupable[position], generator, ranges))
    if len(drawing.displaced) < count:
        raise ConfigurationError(
            f"house {house.id!r}: only {len(drawing.displaced)} objects can be misplaced and put right again "
            f"in it, {count} were asked for"
        )
    return Disorder(house, tuple(drawing.displaced), seed)


class _Drawing:
    """A house in a world, and which of its objects are displaced so far."""

    def __init__(self, world: World, house: House, seed: int, accept: Accept) -> None:
        self.displaced: list[Displacement] = []
        self._world, self._house, self._seed, self._accept = world, house, seed, accept
        self._begin_again()

    def displace_one(self, candidates: Sequence[Displacement]) -> None:
        """Displace an object to the first candidate that is free and accepted and leaves room to put all
        objects right; leave it where it is if there is none."""
        for candidate in candidates:
            if not displace(self._world, candidate, self._seed):
                continue
            truth = self._world.truth()[candidate.object_id]
            after = [*self.displaced, replace(candidate, position=_rounded(truth.position))]
            suits = all(map(self._has_room, after)) and self._accept(truth)
            self.displaced = after if suits else self.displaced
            self._begin_again()
            if suits:
                return

    def _begin_again(self) -> None:
        """Undo all trials, by setting up the house and what is displaced for good anew, as `prepare` does."""
        self._world.reset(self._house, self._seed)
        for displacement in self.displaced:
            displace(self._world, displacement, self._seed)

    def _has_room(self, displaced: Displacement) -> bool:
        """Whether some right place has room for a displaced object as things lie now; it is tried out."""
        thing = self._house.object(displaced.object_id)
        trial_seed = derive_seed(self._seed, "room", thing.id)
        has_room = any(
            self._world.displace(thing.id, place, trial_seed) for place in _right_places(self._house, thing)
        )
        if has_room and not displace(self._world, displaced, self._seed):
            raise WorldError(
                f"{thing.id!r} was displaced to {displaced.receptacle_id!r}, and cannot be again"
            )
        return has_room


def _wrong_places(
    house: House, thing: HouseObject, generator: np.random.Generator, ranges: Ranges
) -> list[Displacement]:
    """Where the object could be misplaced to, in the order in which to try; nothing if the house has no
    right place for it."""
    right = set(_right_places(house, thing))
    wrong = [
        receptacle.id
        for receptacle in house.objects
        if receptacle.is_receptacle and not receptacle.pickupable and receptacle.id not in right
    ]
    order = [wrong[position] for position in generator.permutation(len(wrong))]
    drop_first = generator.random() < ranges.floor
    if not _belongs_on_floors(house, thing):
        order.insert(0 if drop_first else len(order), FLOOR)
    return [Displacement(thing.id, receptacle_id) for receptacle_id in order] if right else []


def _right_places(house: House, thing: HouseObject) -> list[str]:
    """Receptacles, and rooms for their floors, where the object belongs."""
    room_types = {room.id: room.room_type for room in house.rooms}
    receptacles = [
        other.id
        for other in house.objects
        if other.is_receptacle
        and not other.pickupable
        and is_reasonable(thing.category, other.category, room_types[other.room])
    ]
    floors = [name for name, kind in room_types.items() if is_reasonable(thing.category, FLOOR, kind)]
    return [*receptacles, *floors]


def _belongs_on_floors(house: House, thing: HouseObject) -> bool:
    return any(is_reasonable(thing.category, FLOOR, room.room_type) for room in house.rooms)


def _rounded(point: Point) -> Point:
    x, y, z = (round(number, DECIMALS) + 0.0 for number in point)
    return x, y, z
