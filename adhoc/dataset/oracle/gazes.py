"""From which stances a robot sees a solid within reach: by rays at boxes (numba)."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.checks.box_arrays import BoxArrays, FloatArray, box_arrays
from adhoc.dataset.oracle.stances import AIMS, HEADINGS, LEVEL, TILT_STEP, TILTS
from adhoc.houses.box_rays import along_axes, crossing
from adhoc.houses.solids import Box

_FRAME = 0.98
"""Part of the picture's half width that counts: pixels are sampled inside the frame."""
_NEARER = 0.01
"""Metres by which a point is nearer than the reach."""
_PATCH = 0.12
"""Metres between the points that are tried on a face, at most `_MOST_POINTS` along each edge."""
_MOST_POINTS = 8
_SHORT = 0.999
"""Part of the way to a point that has to be free; a box that is only touched hides nothing."""
_AXES = ((0, 1, 2), (1, 0, 2), (2, 0, 1))


def gazes(
    boxes: Sequence[Box], others: BoxArrays, points: FloatArray, height: float, reach: float
) -> NDArray[np.bool_]:
    """The stances (cells, 16) from which some point of the boxes is in the picture, in reach and not hidden.

    Args:
        boxes: the solid to see.
        others: the boxes that may hide it.
        points: (cells, 2), where the robot could stand, in metres.
        height: of its camera, in metres.
        reach: metres from the robot's axis, horizontally.
    """
    samples, normals = _samples(boxes)
    near = _near(boxes, others, reach)
    seen = np.zeros((len(points), AIMS), np.bool_)
    _look(
        points,
        height,
        samples,
        normals,
        near.centers,
        near.halves,
        near.headings,
        reach - _NEARER,
        _FRAME,
        TILT_STEP,
        seen,
    )
    return seen


def _near(boxes: Sequence[Box], others: BoxArrays, reach: float) -> BoxArrays:
    """Those of the other boxes that lie between the solid and any place in reach of it."""
    own = box_arrays([boxes])
    own_reach, reaches = own.reaches(), others.reaches()
    low = (own.centers[:, :2] - own_reach).min(axis=0) - reach
    high = (own.centers[:, :2] + own_reach).max(axis=0) + reach
    centers = others.centers[:, :2]
    kept = ((centers + reaches >= low) & (centers - reaches <= high)).all(axis=1)
    return BoxArrays(others.centers[kept], others.halves[kept], others.headings[kept], others.owners[kept])


def _samples(boxes: Sequence[Box]) -> tuple[FloatArray, FloatArray]:
    """Points (N, 3) on the faces of boxes, a little inside their edges, and the outward normals (N, 3)."""
    points, normals = [], []
    for box in boxes:
        cosine, sine = math.cos(box.yaw), math.sin(box.yaw)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        for axis, first, second in _AXES:
            grid = np.array([(a, b) for a in _along(box.half[first]) for b in _along(box.half[second])])
            for side in (-1.0, 1.0):
                local, normal = np.empty((len(grid), 3)), np.zeros(3)
                local[:, axis], normal[axis] = side * box.half[axis], side
                local[:, first], local[:, second] = grid[:, 0], grid[:, 1]
                points.append(local @ turn.T + np.array(box.center))
                normals.append(np.tile(turn @ normal, (len(grid), 1)))
    return np.concatenate(points), np.concatenate(normals)


def _along(half: float) -> list[float]:
    count = min(_MOST_POINTS, max(2, math.ceil(2 * half / _PATCH)))
    return [0.92 * half * (2 * index / (count - 1) - 1) for index in range(count)]


@numba.njit(cache=True, nogil=True)
def _look(
    points: FloatArray,
    height: float,
    samples: FloatArray,
    normals: FloatArray,
    centers: FloatArray,
    halves: FloatArray,
    headings: FloatArray,
    reach: float,
    frame: float,
    tilt_step: float,
    seen: NDArray[np.bool_],
) -> None:
    shown = np.zeros(AIMS, np.bool_)
    for cell in range(points.shape[0]):
        for sample in range(samples.shape[0]):
            dx = samples[sample, 0] - points[cell, 0]
            dy = samples[sample, 1] - points[cell, 1]
            dz = samples[sample, 2] - height
            if dx * dx + dy * dy > reach * reach:
                continue
            facing = dx * normals[sample, 0] + dy * normals[sample, 1] + dz * normals[sample, 2]
            if facing > -1e-3:
                continue
            news = False
            for aim in range(AIMS):
                shown[aim] = not seen[cell, aim] and _in_frame(dx, dy, dz, aim, frame, tilt_step)
                news = news or shown[aim]
            if news and _is_clear(points[cell], height, dx, dy, dz, centers, halves, headings):
                for aim in range(AIMS):
                    seen[cell, aim] = seen[cell, aim] or shown[aim]


@numba.njit(cache=True, nogil=True)
def _in_frame(dx: float, dy: float, dz: float, aim: int, frame: float, tilt_step: float) -> bool:
    """Whether a direction is in the picture at an aim; the field of view is 90 degrees."""
    heading, tilt = aim // TILTS, aim % TILTS
    ahead, left = dx, dy
    for _ in range(heading % HEADINGS):
        ahead, left = left, -ahead
    pitch = (tilt - LEVEL) * tilt_step
    depth = ahead * math.cos(pitch) - dz * math.sin(pitch)
    down = -ahead * math.sin(pitch) - dz * math.cos(pitch)
    return depth > 0.02 and abs(left) <= frame * depth and abs(down) <= frame * depth


@numba.njit(cache=True, nogil=True)
def _is_clear(
    point: FloatArray,
    height: float,
    dx: float,
    dy: float,
    dz: float,
    centers: FloatArray,
    halves: FloatArray,
    headings: FloatArray,
) -> bool:
    """Whether no box lies between the eye and the point at (dx, dy, dz) from it."""
    for box in range(centers.shape[0]):
        cosine, sine = headings[box, 0], headings[box, 1]
        eye = (point[0] - centers[box, 0], point[1] - centers[box, 1], height - centers[box, 2])
        start, way = along_axes(eye, cosine, sine), along_axes((dx, dy, dz), cosine, sine)
        x, y, z = halves[box, 0], halves[box, 1], halves[box, 2]
        enter, leave = crossing(start, way, (-x, -y, -z), (x, y, z), _SHORT)
        if enter < leave:
            return False
    return True
