"""Whether a robot somewhere in a room sees a thing: straight lines between eyes and the thing's faces."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

EYE_HEIGHTS = (0.9, 1.6)
"""Heights of the cameras of low and of tall robots, in metres."""
REACH = 1.35
"""Horizontal metres between a robot and what it sees; robots reach a little further."""
STEEPEST = 0.35
"""Metres that a robot must be away for every metre that it looks up or down; cameras see 75 degrees down."""


LEAST_PIXELS = 3.0
"""Pixels of a thing, summed over the pictures from all places, from which on it counts as seen."""
PIXEL = 1 / 64
"""Size of a pixel of a picture of 128 pixels and 90 degrees, at a distance of one."""


def is_in_view(target: FloatArray, cells: FloatArray, boxes: FloatArray) -> bool:
    """Whether robots see the middle of some face of the target, large enough to be noticed.

    Args:
        target: (6,) bounds x0, y0, z0, x1, y1, z1.
        cells: (n, 2) places of robots.
        boxes: (m, 8) rows (see `turned_boxes`) of all that can be in between; the target itself may not be
            among them.
    """
    return bool(_seen(target, cells, boxes))


@njit(cache=True)
def _seen(target: FloatArray, cells: FloatArray, boxes: FloatArray) -> bool:
    x0, y0, z0, x1, y1, z1 = target
    middle_x, middle_y, middle_z = (x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2
    pixels = 0.0
    for cell in range(len(cells)):
        x, y = cells[cell, 0], cells[cell, 1]
        level = math.hypot(x - middle_x, y - middle_y)
        if level > REACH:
            continue
        for eye in EYE_HEIGHTS:
            if abs(eye - middle_z) * STEEPEST > level:
                continue
            if not (
                (eye > z1 and _free(x, y, eye, middle_x, middle_y, z1, boxes))
                or (x < x0 and _free(x, y, eye, x0, middle_y, middle_z, boxes))
                or (x > x1 and _free(x, y, eye, x1, middle_y, middle_z, boxes))
                or (y < y0 and _free(x, y, eye, middle_x, y0, middle_z, boxes))
                or (y > y1 and _free(x, y, eye, middle_x, y1, middle_z, boxes))
            ):
                continue
            distance = math.hypot(level, eye - middle_z)
            sine_x, sine_y = abs(x - middle_x) / level, abs(y - middle_y) / level
            width = (x1 - x0) * sine_y + (y1 - y0) * sine_x
            depth = (x1 - x0) * sine_x + (y1 - y0) * sine_y
            height = ((z1 - z0) * level + depth * max(0.0, eye - z1)) / distance
            pixels += width * height / (distance * PIXEL) ** 2
            if pixels >= LEAST_PIXELS:
                return True
    return False


@njit(cache=True)
def _free(ex: float, ey: float, ez: float, tx: float, ty: float, tz: float, boxes: FloatArray) -> bool:
    """Whether no box cuts the line from an eye to a point."""
    for k in range(len(boxes)):
        low, high = 0.0, 0.999
        cosine, sine = boxes[k, 6], boxes[k, 7]
        for axis in range(3):
            if axis == 0:
                start, way = cosine * ex + sine * ey, cosine * (tx - ex) + sine * (ty - ey)
            elif axis == 1:
                start, way = cosine * ey - sine * ex, cosine * (ty - ey) - sine * (tx - ex)
            else:
                start, way = ez, tz - ez
            if abs(way) < 1e-12:
                if start < boxes[k, axis] or start > boxes[k, axis + 3]:
                    low, high = 1.0, 0.0
                    break
                continue
            first, second = (boxes[k, axis] - start) / way, (boxes[k, axis + 3] - start) / way
            low, high = max(low, min(first, second)), min(high, max(first, second))
            if low > high:
                break
        if low <= high:
            return False
    return True
