"""Drawing robots and where they begin (the paper's appendix, Details of Dataset)."""

from __future__ import annotations

import numpy as np

from adhoc.core.errors import ConfigurationError, WorldError
from adhoc.core.geometry import planar_distance
from adhoc.core.values import Capability, Pose
from adhoc.evaluation.ranges import PAPER_RANGES, Ranges, between
from adhoc.worlds.world import World


def draw_capability(generator: np.random.Generator, ranges: Ranges = PAPER_RANGES) -> Capability:
    """One robot's abilities (the paper's tuple); every robot can navigate."""
    return Capability(
        can_navigate=True,
        can_manipulate=bool(generator.random() < ranges.can_manipulate),
        camera_height=float(generator.choice(ranges.heights)),
        payload=round(float(generator.uniform(*ranges.payload)), 2),
        max_steps=between(generator, ranges.max_steps),
    )


def draw_team(generator: np.random.Generator, size: int, ranges: Ranges = PAPER_RANGES) -> list[Capability]:
    """The abilities of `size` teammates, at least one of them able to manipulate.

    Drawn again as a whole until one is, as the paper guarantees it; a team drawn in vain 1000 times
    (`can_manipulate` is 0, say) raises ConfigurationError.
    """
    for _ in range(1000):
        team = [draw_capability(generator, ranges) for _ in range(size)]
        if any(capability.can_manipulate for capability in team):
            return team
    raise ConfigurationError(f"can_manipulate={ranges.can_manipulate}: no teammate would ever manipulate")


def poses_apart(world: World, count: int, seed: int, ranges: Ranges) -> list[Pose]:
    """Free poses at a distance from each other, in the order drawn. Raises WorldError if too few fit."""
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
