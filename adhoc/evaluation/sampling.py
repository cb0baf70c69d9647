"""Drawing scenarios for a house as the paper does (Benchmark Dataset; appendix, Details of Dataset)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from adhoc.core.errors import ConfigurationError, WorldError
from adhoc.core.geometry import planar_distance
from adhoc.core.streams import derive_seed, stream
from adhoc.core.values import Capability, Pose
from adhoc.evaluation.referee import PlacementReferee
from adhoc.evaluation.scenario import Displacement, Member, Scenario, difficulty_of, displace
from adhoc.houses.anonymous import anonymous
from adhoc.houses.facts import is_reasonable
from adhoc.houses.house import FLOOR, House, HouseObject
from adhoc.worlds.world import World

NEWCOMER = "newcomer"
"""The ad hoc robot's name; teammates are called `teammate_1`, `teammate_2`, ..."""


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


def sample_scenario(
    world: World,
    house: House,
    seed: int,
    misplaced: int | None = None,
    teammates: int | None = None,
    ranges: Ranges = Ranges(),
    name: str | None = None,
) -> Scenario:
    """Draw one scenario; equal arguments give equal scenarios.

    Only objects are misplaced that the house has a reasonable place for. The things in the house get new
    ids (`houses.anonymous`), since robots see ids, and ProcTHOR's tell where a thing belongs. Every drawn
    thing has its own random stream, so that asking for another number of teammates leaves the objects as
    they are.

    Args:
        world: A world to try the placements in; it is reset.
        house: The house.
        seed: Seeds the draws and, later, the episode.
        misplaced: The number of misplaced objects; drawn from `ranges` if None.
        teammates: The number of teammates; drawn from `ranges` if None.
        ranges: What to draw from.
        name: The scenario's id; by default made of the house's id and the seed.

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
    displacements = _displace_objects(world, house, seed, misplaced, ranges)
    poses = _poses_apart(world, teammates + 1, derive_seed(seed, *names, "poses"), ranges.apart)
    capabilities = draw_team(stream(seed, *names, "team"), teammates, ranges)
    scenario = Scenario(
        id=name or f"{house.id}-s{seed}",
        house=house,
        misplaced=displacements,
        team=tuple(
            Member(f"teammate_{number}", capability, pose)
            for number, (capability, pose) in enumerate(zip(capabilities, poses), start=1)
        ),
        newcomer=Member(NEWCOMER, draw_capability(stream(seed, *names, NEWCOMER), ranges), poses[-1]),
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
    world: World, house: House, seed: int, count: int, ranges: Ranges
) -> tuple[Displacement, ...]:
    generator = stream(seed, "scenario", house.id, "misplaced")
    pickupable = [thing for thing in house.objects if thing.pickupable]
    displaced: list[Displacement] = []
    for position in generator.permutation(len(pickupable)):
        if len(displaced) == count:
            break
        for candidate in _wrong_places(house, pickupable[position], generator, ranges):
            if displace(world, candidate, seed):
                displaced.append(candidate)
                break
    if len(displaced) < count:
        raise ConfigurationError(
            f"house {house.id!r}: only {len(displaced)} objects can be misplaced and put right again in it, "
            f"{count} were asked for"
        )
    return tuple(displaced)


def _wrong_places(
    house: House, thing: HouseObject, generator: np.random.Generator, ranges: Ranges
) -> Iterator[Displacement]:
    """Where the object could be misplaced to, in the order in which to try; nothing if the house has no
    right place for it."""
    room_types = {room.id: room.room_type for room in house.rooms}
    receptacles = [other for other in house.objects if other.is_receptacle and not other.pickupable]
    right: list[str] = []
    wrong: list[str] = []
    for receptacle in receptacles:
        fits = is_reasonable(thing.category, receptacle.category, room_types[receptacle.room])
        (right if fits else wrong).append(receptacle.id)
    on_floor = [is_reasonable(thing.category, FLOOR, room_type) for room_type in room_types.values()]
    order = [wrong[position] for position in generator.permutation(len(wrong))]
    drop_first = generator.random() < ranges.floor
    if not any(on_floor):
        order.insert(0 if drop_first else len(order), FLOOR)
    if right or any(on_floor):
        yield from (Displacement(thing.id, receptacle_id) for receptacle_id in order)


def _poses_apart(world: World, count: int, seed: int, apart: float) -> list[Pose]:
    """Free poses at least `apart` metres from each other, in the order drawn."""
    chosen: list[Pose] = []
    for pose in _many_poses(world, count, seed):
        if all(planar_distance(pose, other) >= apart for other in chosen):
            chosen.append(pose)
        if len(chosen) == count:
            return chosen
    raise WorldError(f"no room for {count} robots {apart:g} m apart: only {len(chosen)} fit")


def _many_poses(world: World, count: int, seed: int) -> list[Pose]:
    """Free poses to choose `count` from: many, or as many as a small house has."""
    for times in (16, 8, 4, 2):
        try:
            return world.free_poses(times * count, seed)
        except WorldError:
            continue
    return world.free_poses(count, seed)


def _between(generator: np.random.Generator, bounds: tuple[int, int]) -> int:
    return int(generator.integers(bounds[0], bounds[1], endpoint=True))


def _check_misplaced(world: World, scenario: Scenario) -> None:
    """A scenario that begins with an object in a right place would be won by doing nothing."""
    in_place = PlacementReferee(world, scenario).replaced()
    if in_place:
        raise WorldError(f"scenario {scenario.id!r}: {', '.join(in_place)} ended in a reasonable place")
