"""Drawing scenarios for a house as the paper does (Benchmark Dataset; appendix, Details of Dataset)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from adhoc.core.errors import ConfigurationError, WorldError
from adhoc.core.geometry import planar_distance
from adhoc.core.streams import derive_seed, stream
from adhoc.core.values import Capability, Point, Pose
from adhoc.evaluation.referee import PlacementReferee
from adhoc.evaluation.scenario import Displacement, Member, Scenario, difficulty_of, displace
from adhoc.houses.anonymous import anonymous
from adhoc.houses.facts import is_reasonable
from adhoc.houses.house import FLOOR, House, HouseObject
from adhoc.worlds.world import ObjectTruth, World

NEWCOMER = "newcomer"
"""The ad hoc robot's name; teammates are called `teammate_1`, `teammate_2`, ..."""

Accept = Callable[[House, ObjectTruth], bool]
"""Whether an object may lie misplaced where it is now; the house is the one whose ids it has."""

DECIMALS = 5
"""Of recorded positions: a hundredth of a millimetre."""


@dataclass(frozen=True)
class Ranges:
    """What is drawn, and from where. The defaults are the paper's where it says."""

    misplaced: tuple[int, int] = (1, 5)
    """Fewest and most misplaced objects (k of the paper)."""
    teammates: tuple[int, int] = (3, 5)
    heights: tuple[float, ...] = (0.9, 1.6)
    """Camera heights in metres."""
    payload: tuple[float, float] = (0.1, 20.0)
    """Kilograms, uniform."""
    max_steps: tuple[int, int] = (50, 500)
    """Battery, in steps, uniform, both ends included."""
    can_manipulate: float = 0.5
    """Probability of the manipulation ability. The paper says 'randomly'."""
    floor: float = 0.5
    """Probability that an object is dropped on the floor rather than put on an unreasonable receptacle.
    The paper says 'or'. Objects that may lie on the floor are never dropped there."""
    apart: float = 0.75
    """Metres between the robots' starting positions, at least. The paper is silent."""
    crowded: float = 0.5
    """The same for a house that is too small for `apart`."""


def sample_scenario(
    world: World,
    house: House,
    seed: int,
    misplaced: int | None = None,
    teammates: int | None = None,
    ranges: Ranges = Ranges(),
    name: str | None = None,
    team_seed: int | None = None,
    accept: Accept | None = None,
) -> Scenario:
    """Draw one scenario; equal arguments give equal scenarios.

    Only objects are misplaced that the house has a reasonable place for, with room. The things in the house
    get new ids (`houses.anonymous`), since robots see ids, and ProcTHOR's tell where a thing belongs. Every
    drawn thing has its own random stream, so that asking for another number of teammates leaves the objects
    as they are.

    Args:
        world: A world to try the placements in; it is reset.
        house: The house.
        seed: Seeds the draws and, later, the episode.
        misplaced: The number of misplaced objects; drawn from `ranges` if None.
        teammates: The number of teammates; drawn from `ranges` if None.
        ranges: What to draw from.
        name: The scenario's id; by default made of the house's id and the seed.
        team_seed: Seeds the robots and their starting poses alone, so that one set of misplaced objects can
            be tried with several teams; `seed` if None.
        accept: Asked about each misplaced object where it came to rest; where it says no, another place or
            object is tried. All places are accepted if None.

    Raises:
        ConfigurationError: The house has too few objects that can be misplaced, or a number is below 1.
        WorldError: The house has no room for the robots.
    """
    names = ("scenario", house.id)
    if misplaced is None:
        misplaced = _between(stream(seed, *names, "misplaced count"), ranges.misplaced)
    if teammates is None:
        teammates = _between(stream(seed, *names, "team size"), ranges.teammates)
    if misplaced < 1 or teammates < 1:
        raise ConfigurationError(
            f"a scenario needs at least 1 misplaced object and 1 teammate, not {misplaced} and {teammates}"
        )
    house = anonymous(house, seed)
    world.reset(house, seed)
    displacements = _displace_objects(world, house, seed, misplaced, ranges, accept)
    team_seed = seed if team_seed is None else team_seed
    poses = _poses_apart(world, teammates + 1, derive_seed(team_seed, *names, "poses"), ranges)
    capabilities = draw_team(stream(team_seed, *names, "team"), teammates, ranges)
    scenario = Scenario(
        id=name or f"{house.id}-s{seed}",
        house=house,
        misplaced=displacements,
        team=tuple(
            Member(f"teammate_{number}", capability, pose)
            for number, (capability, pose) in enumerate(zip(capabilities, poses), start=1)
        ),
        newcomer=Member(NEWCOMER, draw_capability(stream(team_seed, *names, NEWCOMER), ranges), poses[-1]),
        seed=seed,
        difficulty=difficulty_of(len(house.rooms)),
    )
    _check_misplaced(world, scenario)
    return scenario


def draw_capability(generator: np.random.Generator, ranges: Ranges = Ranges()) -> Capability:
    """One robot's abilities (the paper's tuple); every robot can navigate."""
    return Capability(
        can_navigate=True,
        can_manipulate=bool(generator.random() < ranges.can_manipulate),
        camera_height=float(generator.choice(ranges.heights)),
        payload=round(float(generator.uniform(*ranges.payload)), 2),
        max_steps=_between(generator, ranges.max_steps),
    )


def draw_team(generator: np.random.Generator, size: int, ranges: Ranges = Ranges()) -> list[Capability]:
    """The abilities of `size` teammates, at least one of them able to manipulate.

    Drawn again as a whole until one is, as the paper guarantees it; a team drawn in vain 1000 times
    (`can_manipulate` is 0, say) raises ConfigurationError.
    """
    for _ in range(1000):
        team = [draw_capability(generator, ranges) for _ in range(size)]
        if any(capability.can_manipulate for capability in team):
            return team
    raise ConfigurationError(f"can_manipulate={ranges.can_manipulate}: no teammate would ever manipulate")


def _displace_objects(
    world: World, house: House, seed: int, count: int, ranges: Ranges, accept: Accept | None
) -> tuple[Displacement, ...]:
    generator = stream(seed, "scenario", house.id, "misplaced")
    pickupable = [thing for thing in house.objects if thing.pickupable]
    displaced: list[Displacement] = []
    for position in generator.permutation(len(pickupable)):
        if len(displaced) == count:
            break
        candidates = _wrong_places(house, pickupable[position], generator, ranges)
        found = _displace_one(world, house, seed, candidates, accept)
        if found is not None:
            displaced.append(found)
        else:
            _begin_again(world, house, seed, displaced)
    able = [it for it in displaced if _has_room(world, house, seed, it)]
    if len(able) < count:
        raise ConfigurationError(
            f"house {house.id!r}: only {len(able)} objects can be misplaced and put right again in it, "
            f"{count} were asked for"
        )
    _begin_again(world, house, seed, displaced)
    return tuple(displaced)


def _displace_one(
    world: World, house: House, seed: int, candidates: Iterator[Displacement], accept: Accept | None
) -> Displacement | None:
    """The first candidate that is free and accepted, with where the object came to rest."""
    for candidate in candidates:
        if displace(world, candidate, seed):
            truth = world.truth()[candidate.object_id]
            has_room = _has_room(world, house, seed, candidate)
            if has_room and (accept is None or accept(house, truth)):
                return replace(candidate, position=_rounded(truth.position))
    return None


def _has_room(world: World, house: House, seed: int, displaced: Displacement) -> bool:
    """Whether some right place has room for a displaced object as things lie now; it is tried out."""
    thing = house.object(displaced.object_id)
    trial_seed = derive_seed(seed, "room", thing.id)
    has_room = any(world.displace(thing.id, place, trial_seed) for place in _right_places(house, thing))
    if has_room and not displace(world, displaced, seed):
        raise WorldError(f"{thing.id!r} was displaced to {displaced.receptacle_id!r}, and cannot be again")
    return has_room


def _begin_again(world: World, house: House, seed: int, displaced: list[Displacement]) -> None:
    """Undo all trials, by setting up the house and what is displaced for good anew, as `prepare` does."""
    world.reset(house, seed)
    for displacement in displaced:
        displace(world, displacement, seed)


def _wrong_places(
    house: House, thing: HouseObject, generator: np.random.Generator, ranges: Ranges
) -> Iterator[Displacement]:
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
    if right:
        yield from (Displacement(thing.id, receptacle_id) for receptacle_id in order)


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


def _poses_apart(world: World, count: int, seed: int, ranges: Ranges) -> list[Pose]:
    """Free poses at a distance from each other, in the order drawn."""
    drawn = _many_poses(world, count, seed)
    for apart in (ranges.apart, ranges.crowded):
        chosen: list[Pose] = []
        for pose in drawn:
            if all(planar_distance(pose, other) >= apart for other in chosen):
                chosen.append(pose)
            if len(chosen) == count:
                return chosen
    raise WorldError(f"no room for {count} robots {ranges.crowded:g} m apart: only {len(chosen)} fit")


def _many_poses(world: World, count: int, seed: int) -> list[Pose]:
    """Free poses to choose `count` from: many, or as many as a small house has."""
    for times in (16, 8, 4, 2):
        try:
            return world.free_poses(times * count, seed)
        except WorldError:
            continue
    return world.free_poses(count, seed)


def _rounded(point: Point) -> Point:
    x, y, z = (round(number, DECIMALS) + 0.0 for number in point)
    return x, y, z


def _between(generator: np.random.Generator, bounds: tuple[int, int]) -> int:
    return int(generator.integers(bounds[0], bounds[1], endpoint=True))


def _check_misplaced(world: World, scenario: Scenario) -> None:
    """A scenario that begins with an object in a right place would be won by doing nothing."""
    in_place = PlacementReferee(world, scenario).replaced()
    if in_place:
        raise WorldError(f"scenario {scenario.id!r}: {', '.join(in_place)} ended in a reasonable place")
