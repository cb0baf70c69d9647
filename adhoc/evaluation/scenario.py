"""One tidying-up scenario as a value, and how it is set up in a world (paper, section Benchmark Dataset)."""

from __future__ import annotations

import hashlib
import json
import math
from dataclasses import asdict, dataclass
from enum import Enum

from adhoc.core.errors import HouseError, WorldError
from adhoc.core.streams import derive_seed
from adhoc.core.values import Capability, Point, Pose
from adhoc.houses.house import House
from adhoc.worlds.world import World

SAME_PLACE = 0.01
"""Metres within which an object lies where it was recorded to lie."""
_FOREIGN = "the scenario was made for another world or house"


class Difficulty(str, Enum):
    """The paper's three categories of tasks, by the number of rooms."""

    EASY = "Easy"
    MEDIUM = "Medium"
    DIFFICULT = "Difficult"


@dataclass(frozen=True)
class Displacement:
    """One misplaced object: which object is moved, and to which receptacle (an id, or `Floor`)."""

    object_id: str
    receptacle_id: str
    position: Point | None = None
    """Where its centre came to rest when the scenario was drawn, in metres; None if that is not known."""


@dataclass(frozen=True)
class Member:
    """One robot of a scenario: its name, what it can do, and where it begins (or joins)."""

    name: str
    capability: Capability
    pose: Pose


@dataclass(frozen=True)
class Scenario:
    """A house with misplaced objects, a team, and the robot that may join it.

    The newcomer is part of the scenario, so that every ad hoc policy and every joining step is tried
    with the same robot at the same place. `seed` is the seed of everything random in an episode.
    """

    id: str
    house: House
    misplaced: tuple[Displacement, ...]
    team: tuple[Member, ...]
    newcomer: Member
    seed: int
    difficulty: Difficulty
    setup_seed: int | None = None
    """The seed of where misplaced objects lie; `seed` if None. Fixed tasks that are run under several seeds
    keep it."""
    source: str = ""
    """Where it came from, e.g. a file and line, for error texts."""

    @property
    def placement_seed(self) -> int:
        """The seed of where misplaced objects lie."""
        return self.seed if self.setup_seed is None else self.setup_seed

    def content_hash(self) -> str:
        """A hash of the whole content, equal on every machine; the file the house came from is left out."""
        content = asdict(self)
        del content["house"]["source"], content["source"]
        canonical = json.dumps(content, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(canonical.encode()).hexdigest()[:16]


def prepare(world: World, scenario: Scenario) -> None:
    """Build the scenario in `world`: the house, the misplaced objects, then the team, in that order.

    Deterministic in the scenario. Raises HouseError or WorldError if the world cannot hold it.
    """
    world.reset(scenario.house, scenario.placement_seed)
    for index, displacement in enumerate(scenario.misplaced):
        if not displace(world, displacement, scenario.placement_seed):
            raise WorldError(
                f"{_name(scenario)}: misplaced[{index}]: no free place for {displacement.object_id!r} on "
                f"or in {displacement.receptacle_id!r}; {_FOREIGN}"
            )
        _check_position(world, scenario, index)
    for member in scenario.team:
        world.add_agent(member.name, member.capability, member.pose)


def _check_position(world: World, scenario: Scenario, index: int) -> None:
    """A scenario whose objects lie elsewhere than when it was drawn is another scenario."""
    displacement = scenario.misplaced[index]
    if displacement.position is None:
        return
    found = world.truth()[displacement.object_id].position
    if math.dist(found, displacement.position) > SAME_PLACE:
        raise WorldError(
            f"{_name(scenario)}: misplaced[{index}].position is {_shown(displacement.position)}; "
            f"{displacement.object_id!r} came to rest at {_shown(found)}; {_FOREIGN}"
        )


def _shown(point: Point) -> str:
    return "(" + ", ".join(f"{number:.3f}" for number in point) + ")"


def _name(scenario: Scenario) -> str:
    return f"scenario {scenario.id!r}" + (f" ({scenario.source})" if scenario.source else "")


def displace(world: World, displacement: Displacement, seed: int) -> bool:
    """Misplace one object at a place that depends on the seed and on the object alone; False if none is
    free. Sampling and set-up share it, so that what was sampled can be set up."""
    place_seed = derive_seed(seed, "displace", displacement.object_id)
    return world.displace(displacement.object_id, displacement.receptacle_id, place_seed)


def difficulty_of(rooms: int) -> Difficulty:
    """The category of a house with that many rooms: 1-3 Easy, 4-6 Medium, 7 and more Difficult.

    Every room of the house counts, a corridor too: the paper does not say, and a corridor must be explored.
    The paper's largest houses have 10 rooms; larger ones are Difficult too. Raises HouseError below 1.
    """
    if rooms < 1:
        raise HouseError(f"a house needs at least one room, not {rooms}")
    if rooms <= 3:
        return Difficulty.EASY
    return Difficulty.MEDIUM if rooms <= 6 else Difficulty.DIFFICULT
