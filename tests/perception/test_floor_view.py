from __future__ import annotations

import math

import numpy as np
import pytest
from tiny_scene import TinyScene

from adhoc.core.values import Observation, Pose
from adhoc.perception.perception import Perception
from adhoc.perception.voxels import STOOD

HALL = TinyScene({"room|1": (-9.0, -9.0, 9.0, 9.0)})


def cells_in_view(observation: Observation, perception: Perception, margin: float) -> np.ndarray:
    """Which cells of an endless floor lie in the picture and in reach, by `margin` pixels and centimetres."""
    grid, settings = perception.map, perception.settings
    middles = (np.arange(len(grid.floor)) + 0.5) * settings.cell
    x, y = np.meshgrid(grid.origin[0] + middles, grid.origin[1] + middles, indexing="ij")
    camera, matrix = observation.camera.world_from_camera, observation.camera.intrinsics
    rays = np.stack([x, y, np.zeros_like(x)], -1) - camera[:3, 3]
    right, down, along = np.moveaxis(rays @ camera[:3, :3], -1, 0)
    with np.errstate(divide="ignore"):
        u = matrix[0, 0] * right / along + matrix[0, 2]
        v = matrix[1, 1] * down / along + matrix[1, 2]
    height, width = observation.depth.shape
    in_picture = (u > margin) & (u < width - 1 - margin) & (v > margin) & (v < height - 1 - margin)
    return in_picture & (along > 0.05) & (along < settings.floor_depth - margin / 100)


@pytest.mark.parametrize("yaw", [0.0, math.pi / 2, math.pi, 0.3, -2.0])
@pytest.mark.parametrize("pitch", [0.0, math.pi / 6, math.pi / 3])
def test_the_floor_in_view_is_known_to_its_edges_and_no_further(yaw, pitch):
    perception = Perception()
    observation = HALL.look(Pose(0.02, -0.01, yaw, pitch))
    perception.observe(observation)
    seen = (perception.map.floor > 0) & (perception.map.floor < STOOD)
    surely = cells_in_view(observation, perception, 0.1)
    assert surely.sum() > 500
    assert seen[surely].all()
    assert not (seen & ~cells_in_view(observation, perception, -0.1)).any()
