"""Whether an object finds room on or in a receptacle: the candidate places of `worlds.placement`, tested by
arithmetic instead of physics."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numba
import numpy as np

from adhoc.core.values import Point
from adhoc.dataset.checks.box_arrays import BoxArrays, FloatArray
from adhoc.houses.solids import Surface

_SPACING = 0.05
_GAP = 0.001
_EXACT_FIT = 1e-9


def has_room(half: Point, surfaces: Sequence[Surface], boxes: BoxArrays) -> bool:
    """Whether a box with these half extents has a free place on one of the surfaces.

    `boxes` is everything else in the house. Conservative: an object of several boxes may fit where its
    bounding box does not.
    """
    for surface in surfaces:
        if 2 * half[2] + _GAP > surface.clearance:
            continue
        for turn, across, along in ((0.0, half[0], half[1]), (math.pi / 2, half[1], half[0])):
            reach = (surface.half[0] - across, surface.half[1] - along)
            if min(reach) < -_EXACT_FIT:
                continue
            if _any_free(surface, reach, surface.yaw + turn, half, boxes):
                return True
            break
    return False


def fits_at(
    place: tuple[float, float], half: tuple[float, float], heights: tuple[float, float], boxes: BoxArrays
) -> bool:
    """Whether nothing overlaps an axis-aligned box around a place, between two heights, in metres."""
    low, high = heights
    close = (boxes.centers[:, 2] + boxes.halves[:, 2] > low) & (
        boxes.centers[:, 2] - boxes.halves[:, 2] < high
    )
    near = np.abs(boxes.centers[:, :2] - place) < boxes.reaches() + half
    close &= near.all(axis=1)
    free: bool = _finds_free(
        np.array([place]), 1.0, 0.0, *half, boxes.centers[close], boxes.halves[close], boxes.headings[close]
    )
    return free


def _any_free(
    surface: Surface, reach: tuple[float, float], yaw: float, half: Point, boxes: BoxArrays
) -> bool:
    counts = [math.floor(max(0.0, length) / _SPACING) for length in reach]
    x, y = np.meshgrid(*(_SPACING * np.arange(-count, count + 1) for count in counts), indexing="ij")
    cosine, sine = math.cos(surface.yaw), math.sin(surface.yaw)
    points = np.stack(
        [
            surface.center[0] + cosine * x.ravel() - sine * y.ravel(),
            surface.center[1] + sine * x.ravel() + cosine * y.ravel(),
        ],
        axis=1,
    )
    bottom = surface.center[2] + _GAP
    low, high = points.min(axis=0) - math.hypot(*half[:2]), points.max(axis=0) + math.hypot(*half[:2])
    reaches = boxes.reaches()
    centers, heights = boxes.centers, boxes.halves[:, 2]
    close = (centers[:, 2] + heights > bottom) & (centers[:, 2] - heights < bottom + 2 * half[2])
    close &= ((centers[:, :2] + reaches > low) & (centers[:, :2] - reaches < high)).all(axis=1)
    free: bool = _finds_free(
        points,
        math.cos(yaw),
        math.sin(yaw),
        half[0],
        half[1],
        centers[close],
        boxes.halves[close],
        boxes.headings[close],
    )
    return free


@numba.njit(cache=True, nogil=True)
def _finds_free(
    points: FloatArray,
    cosine: float,
    sine: float,
    half_x: float,
    half_y: float,
    centers: FloatArray,
    halves: FloatArray,
    headings: FloatArray,
) -> bool:
    """Whether at some point no rectangle overlaps the one of these half extents (separating axes)."""
    for point in range(points.shape[0]):
        free = True
        for box in range(centers.shape[0]):
            dx, dy = centers[box, 0] - points[point, 0], centers[box, 1] - points[point, 1]
            other_cosine, other_sine = headings[box, 0], headings[box, 1]
            along = abs(cosine * other_cosine + sine * other_sine)
            across = abs(cosine * other_sine - sine * other_cosine)
            other_x, other_y = halves[box, 0], halves[box, 1]
            if (
                abs(cosine * dx + sine * dy) < half_x + other_x * along + other_y * across
                and abs(cosine * dy - sine * dx) < half_y + other_x * across + other_y * along
                and abs(other_cosine * dx + other_sine * dy) < other_x + half_x * along + half_y * across
                and abs(other_cosine * dy - other_sine * dx) < other_y + half_x * across + half_y * along
            ):
                free = False
                break
        if free:
            return True
    return False
