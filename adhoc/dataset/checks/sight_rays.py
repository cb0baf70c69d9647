"""Rays through the pixels of a robot's camera: the compiled part of `dataset.checks.sight`."""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Point
from adhoc.dataset.checks.box_arrays import FloatArray
from adhoc.houses.box_rays import along_axes, crossing

IMAGE_SIZE = 128
"""Width and height of the camera's pictures in pixels, as `PyBulletWorld` takes them by default."""

FOCAL = IMAGE_SIZE / 2
"""Focal length in pixels of a field of view of 90 degrees."""

PITCHES = (0.0, math.pi / 6, math.pi / 3, -math.pi / 6)
"""The camera's pitches in radians, down being positive: it tilts by 30 degrees, 30 up to 60 down."""

MOST_PIXELS_A_SIDE = 12
"""An object that is larger than this in a picture is sampled at so many pixels across and down."""

_NEAREST = 0.05
_TIE = 1e-6

_Camera = tuple[float, float, float, float]


@numba.njit(cache=True, nogil=True)
def is_in_a_picture(
    eyes: FloatArray,
    bounds: FloatArray,
    boxes: FloatArray,
    owners: NDArray[np.int64],
    target: int,
    reach: float,
) -> bool:
    """Whether a picture from one of the eyes shows some point of the target within reach.

    Args:
        eyes: (E, 3) camera positions, tried in this order.
        bounds: (2, 3) lowest and highest corner of the target.
        boxes: (N, 8) centres, half extents and headings of all boxes that can be in between, and the
            target's own.
        owners: (N,) the solid of each box.
        target: the solid to look for.
        reach: horizontal metres within which a seen point counts.
    """
    own = np.flatnonzero(owners == target)
    near = _boxes_around(bounds, reach, boxes, owners, target)
    others = np.empty(len(near), np.int64)
    for eye in eyes:
        count = _boxes_between(eye, bounds, boxes, near, others)
        if _glance_around(eye, bounds, boxes, own, others[:count], reach):
            return True
    return False


@numba.njit(cache=True, nogil=True)
def horizontal_distances(places: FloatArray, boxes: FloatArray, limit: float) -> FloatArray:
    """Distance (M,) on the floor plan of places (M, 2) to the nearest of some boxes (N, 8); inf if it is
    beyond `limit` metres."""
    distances = np.full(places.shape[0], math.inf)
    for box in range(boxes.shape[0]):
        x, y, cosine, sine = boxes[box, 0], boxes[box, 1], boxes[box, 6], boxes[box, 7]
        around = limit + boxes[box, 3] + boxes[box, 4]
        for place in range(places.shape[0]):
            dx, dy = places[place, 0] - x, places[place, 1] - y
            if abs(dx) > around or abs(dy) > around:
                continue
            beside = max(0.0, abs(cosine * dx + sine * dy) - boxes[box, 3])
            before = max(0.0, abs(cosine * dy - sine * dx) - boxes[box, 4])
            distances[place] = min(distances[place], math.hypot(beside, before))
    return distances


@numba.njit(cache=True, nogil=True)
def _boxes_around(
    bounds: FloatArray, reach: float, boxes: FloatArray, owners: NDArray[np.int64], target: int
) -> NDArray[np.int64]:
    """The boxes of others that can hide the target from within reach."""
    near = np.empty(boxes.shape[0], np.int64)
    count = 0
    for box in range(boxes.shape[0]):
        around = reach + boxes[box, 3] + boxes[box, 4]
        if (
            owners[box] != target
            and bounds[0, 0] - around <= boxes[box, 0] <= bounds[1, 0] + around
            and bounds[0, 1] - around <= boxes[box, 1] <= bounds[1, 1] + around
        ):
            near[count] = box
            count += 1
    return near[:count]


@numba.njit(cache=True, nogil=True)
def _boxes_between(
    eye: FloatArray,
    bounds: FloatArray,
    boxes: FloatArray,
    near: NDArray[np.int64],
    others: NDArray[np.int64],
) -> int:
    """List those of `near` that meet the upright box around the eye and the target; returns how many."""
    count = 0
    for box in near:
        cosine, sine = abs(boxes[box, 6]), abs(boxes[box, 7])
        reach_x = cosine * boxes[box, 3] + sine * boxes[box, 4]
        reach_y = sine * boxes[box, 3] + cosine * boxes[box, 4]
        if (
            boxes[box, 0] - reach_x <= max(eye[0], bounds[1, 0])
            and boxes[box, 0] + reach_x >= min(eye[0], bounds[0, 0])
            and boxes[box, 1] - reach_y <= max(eye[1], bounds[1, 1])
            and boxes[box, 1] + reach_y >= min(eye[1], bounds[0, 1])
            and boxes[box, 2] - boxes[box, 5] <= max(eye[2], bounds[1, 2])
            and boxes[box, 2] + boxes[box, 5] >= min(eye[2], bounds[0, 2])
        ):
            others[count] = box
            count += 1
    return count


@numba.njit(cache=True, nogil=True)
def _glance_around(
    eye: FloatArray,
    bounds: FloatArray,
    boxes: FloatArray,
    own: NDArray[np.int64],
    others: NDArray[np.int64],
    reach: float,
) -> bool:
    """Try the camera's yaws and pitches, those that look towards the target first."""
    beside_x = min(max(eye[0], bounds[0, 0]), bounds[1, 0]) - eye[0]
    beside_y = min(max(eye[1], bounds[0, 1]), bounds[1, 1]) - eye[1]
    middle_x = (bounds[0, 0] + bounds[1, 0]) / 2 - eye[0]
    middle_y = (bounds[0, 1] + bounds[1, 1]) / 2 - eye[1]
    azimuth = math.atan2(middle_y + beside_y, middle_x + beside_x)
    first = round(azimuth / (math.pi / 2))
    second = first + 1 if azimuth > first * math.pi / 2 else first - 1
    middle_z = (bounds[0, 2] + bounds[1, 2]) / 2 - eye[2]
    below = math.atan2(-middle_z, math.hypot(middle_x + beside_x, middle_y + beside_y) / 2)
    for quarter in (first, second):
        tried = 0
        for _ in range(len(PITCHES)):
            option = _nearest_pitch(below, tried)
            tried |= 1 << option
            if _glance(eye, _camera(quarter % 4, PITCHES[option]), bounds, boxes, own, others, reach):
                return True
    return False


@numba.njit(cache=True, nogil=True)
def _nearest_pitch(below: float, tried: int) -> int:
    """Which of `PITCHES` is nearest to an angle, of those whose bit is not set."""
    best = -1
    for option in range(len(PITCHES)):
        if tried & (1 << option) == 0 and (
            best < 0 or abs(PITCHES[option] - below) < abs(PITCHES[best] - below)
        ):
            best = option
    return best


@numba.njit(cache=True, nogil=True)
def _camera(quarter: int, pitch: float) -> _Camera:
    """Cosine and sine of a camera's yaw, a number of quarter turns, and of its pitch."""
    cos_yaw, sin_yaw = (1.0, 0.0, -1.0, 0.0)[quarter], (0.0, 1.0, 0.0, -1.0)[quarter]
    return cos_yaw, sin_yaw, math.cos(pitch), math.sin(pitch)


@numba.njit(cache=True, nogil=True)
def _glance(
    eye: FloatArray,
    camera: _Camera,
    bounds: FloatArray,
    boxes: FloatArray,
    own: NDArray[np.int64],
    others: NDArray[np.int64],
    reach: float,
) -> bool:
    """Whether one picture shows the target within reach at a sampled pixel, the middle ones first."""
    left, right, top, bottom = _window(eye, camera, bounds)
    across, down = right - left + 1, bottom - top + 1
    if across <= 0 or down <= 0:
        return False
    samples_across, samples_down = min(across, MOST_PIXELS_A_SIDE), min(down, MOST_PIXELS_A_SIDE)
    samples = samples_across * samples_down
    for sample in range(samples):
        turned = (sample + samples // 2 + samples_across // 2 * (1 - samples_down % 2)) % samples
        column = left + ((turned % samples_across) * 2 + 1) * across // (2 * samples_across)
        row = top + ((turned // samples_across) * 2 + 1) * down // (2 * samples_down)
        way = _way_through(camera, column, row)
        if _meets_target_first(eye, way, boxes, own, others, reach / math.hypot(way[0], way[1])):
            return True
    return False


@numba.njit(cache=True, nogil=True)
def _window(eye: FloatArray, camera: _Camera, bounds: FloatArray) -> tuple[int, int, int, int]:
    """First and last column, first and last row of the pixels that can show what is within bounds.

    The last is before the first where none can; all pixels where a corner is not in front of the camera.
    """
    cos_yaw, sin_yaw, cos_pitch, sin_pitch = camera
    last = IMAGE_SIZE - 1
    left, right, top, bottom = math.inf, -math.inf, math.inf, -math.inf
    behind = 0
    for corner in range(8):
        dx = bounds[corner & 1, 0] - eye[0]
        dy = bounds[(corner >> 1) & 1, 1] - eye[1]
        dz = bounds[corner >> 2, 2] - eye[2]
        ahead = cos_yaw * dx + sin_yaw * dy
        z = ahead * cos_pitch - dz * sin_pitch
        if z < _NEAREST:
            behind += 1
            continue
        u = (sin_yaw * dx - cos_yaw * dy) / z
        v = (-ahead * sin_pitch - dz * cos_pitch) / z
        left, right = min(left, u), max(right, u)
        top, bottom = min(top, v), max(bottom, v)
    if 0 < behind < 8:
        return 0, last, 0, last
    if behind == 8 or left > 1.0 or right < -1.0 or top > 1.0 or bottom < -1.0:
        return 0, -1, 0, -1
    return (
        max(0, math.ceil(max(left, -1.0) * FOCAL + IMAGE_SIZE / 2)),
        min(last, math.floor(min(right, 1.0) * FOCAL + IMAGE_SIZE / 2)),
        max(0, math.ceil(max(top, -1.0) * FOCAL + IMAGE_SIZE / 2 - 1)),
        min(last, math.floor(min(bottom, 1.0) * FOCAL + IMAGE_SIZE / 2 - 1)),
    )


@numba.njit(cache=True, nogil=True)
def _way_through(camera: _Camera, column: int, row: int) -> Point:
    """The direction in the world of the ray through a pixel, 1 m deep in the picture."""
    cos_yaw, sin_yaw, cos_pitch, sin_pitch = camera
    u = (column - IMAGE_SIZE / 2) / FOCAL
    v = (row - (IMAGE_SIZE / 2 - 1)) / FOCAL
    return (
        cos_yaw * cos_pitch + u * sin_yaw - v * cos_yaw * sin_pitch,
        sin_yaw * cos_pitch - u * cos_yaw - v * sin_yaw * sin_pitch,
        -sin_pitch - v * cos_pitch,
    )


@numba.njit(cache=True, nogil=True)
def _meets_target_first(
    eye: FloatArray,
    way: Point,
    boxes: FloatArray,
    own: NDArray[np.int64],
    others: NDArray[np.int64],
    farthest: float,
) -> bool:
    """Whether the target is the first thing that a ray hits, at most `farthest` times `way` from the eye.

    Ties count as not. The box that was in the way moves to the front of `others`: it often is again.
    """
    depth = math.inf
    for box in own:
        depth = min(depth, _entry(eye, way, boxes[box]))
    if depth > farthest:
        return False
    for place in range(len(others)):
        if _entry(eye, way, boxes[others[place]]) * (1.0 - _TIE) <= depth:
            others[0], others[place] = others[place], others[0]
            return False
    return True


@numba.njit(cache=True, nogil=True)
def _entry(eye: FloatArray, way: Point, box: FloatArray) -> float:
    """How far along the ray it enters the box; inf if it does not, or begins inside."""
    cosine, sine = box[6], box[7]
    start = along_axes((eye[0] - box[0], eye[1] - box[1], eye[2] - box[2]), cosine, sine)
    x, y, z = box[3], box[4], box[5]
    enter, _ = crossing(start, along_axes(way, cosine, sine), (-x, -y, -z), (x, y, z), math.inf)
    return enter if enter > 0.0 else math.inf
