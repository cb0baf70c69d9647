"""What is in a frame, and how near: the list of visible instances."""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.worlds.sensor.sensor import Frame


def survey(frame: Frame, instance_count: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Pixel count and nearness of every instance in a frame.

    Returns:
        counts (instance_count,) int64, pixels of each instance; nearest (instance_count,) float64, the
        smallest horizontal distance in metres from the camera's vertical axis to a visible point of each
        instance, inf where it is not in the frame.
    """
    counts = np.zeros(instance_count, np.int64)
    nearest = np.full(instance_count, math.inf)
    _survey_pixels(
        frame.depth,
        frame.instances,
        frame.camera.intrinsics,
        frame.camera.world_from_camera,
        counts,
        nearest,
    )
    return counts, nearest


def visible_instances(instances: NDArray[np.int32], instance_count: int) -> frozenset[int]:
    """The instances with at least one pixel in `instances` (H, W)."""
    counts = np.zeros(instance_count, np.int64)
    _count_pixels(instances, counts)
    return frozenset(np.flatnonzero(counts).tolist())


@numba.njit(cache=True, nogil=True)
def _count_pixels(instances: NDArray[np.int32], counts: NDArray[np.int64]) -> None:
    height, width = instances.shape
    for row in range(height):
        run_start, run = 0, instances[row, 0]
        for column in range(1, width):
            if instances[row, column] != run:
                if run >= 0:
                    counts[run] += column - run_start
                run_start, run = column, instances[row, column]
        if run >= 0:
            counts[run] += width - run_start


@numba.njit(cache=True, nogil=True)
def _survey_pixels(
    depth: NDArray[np.float32],
    instances: NDArray[np.int32],
    intrinsics: NDArray[np.float64],
    world_from_camera: NDArray[np.float64],
    counts: NDArray[np.int64],
    nearest: NDArray[np.float64],
) -> None:
    height, width = depth.shape
    for row in range(height):
        v = (row - intrinsics[1, 2]) / intrinsics[1, 1]
        ray_x = world_from_camera[0, 2] + v * world_from_camera[0, 1]
        ray_y = world_from_camera[1, 2] + v * world_from_camera[1, 1]
        for column in range(width):
            instance = instances[row, column]
            if instance < 0:
                continue
            u = (column - intrinsics[0, 2]) / intrinsics[0, 0]
            x = ray_x + u * world_from_camera[0, 0]
            y = ray_y + u * world_from_camera[1, 0]
            distance = math.sqrt(x * x + y * y) * depth[row, column]
            counts[instance] += 1
            nearest[instance] = min(nearest[instance], distance)
