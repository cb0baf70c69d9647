"""One tidying-up scenario as a value, and how it is set up in a world (paper, section Benchmark Dataset)."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass
from enum import Enum

from adhoc.core.errors import HouseError, WorldError
from adhoc.core.streams import derive_seed
from adhoc.core.values import Capability, Pose
from adhoc.houses.house import House
from adhoc.worlds.world import World


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

    def content_hash(self) -> str:
        """A hash of the whole content, equal on every machine; the file the house came from is left out."""
        content = asdict(self)
        del content["house"]["source"]
        canonical = json.dumps(content, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(canonical.encode()).hexdigest()[:16]


def prepare(world: World, scenario: Scenario) -> None:
    """Build the scenario in `world`: the house, the misplaced objects, then the team, in that order.

    Deterministic in the scenario. Raises HouseError or WorldError if the world cannot hold it.
    """
    world.reset(scenario.house, scenario.seed)
    for displacement in scenario.misplaced:
        if not displace(world, displacement, scenario.seed):
            raise WorldError(
                f"scenario {scenario.id!r}: no free place for {displacement.object_id!r} on or in "
                f"{displacement.receptacle_id!r}; the scenario was made for another world or house"
            )
    for member in scenario.team:
        world.add_agent(member.name, member.capability, member.pose)


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
