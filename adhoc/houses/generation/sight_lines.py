"""Whether a robot somewhere in a room sees a thing: straight lines between eyes and the thing's faces."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from adhoc.houses.box_rays import along_axes, crossing

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
_SHORT = 0.999
"""Part of the line to a face that has to be free; the thing itself is beyond."""


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
    """Whether no box cuts or touches the line from an eye to a point."""
    for box in boxes:
        cosine, sine = box[6], box[7]
        start = along_axes((ex, ey, ez), cosine, sine)
        way = along_axes((tx - ex, ty - ey, tz - ez), cosine, sine)
        low, high = (box[0], box[1], box[2]), (box[3], box[4], box[5])
        enter, leave = crossing(start, way, low, high, _SHORT)
        if enter <= leave:
            return False
    return True
