"""Where a ray runs through an upright box: the loop over three slabs that every search for views shares.

Compiled by numba, whose cache does not notice that a function compiled into another file has changed: after
an edit here, empty the folder of `NUMBA_CACHE_DIR` (or `__pycache__` where it is not set), or callers keep
the old version.
"""

from __future__ import annotations

import math

import numba

from adhoc.core.values import Point

_PARALLEL = 1e-12


@numba.njit(cache=True, nogil=True)
def crossing(start: Point, way: Point, low: Point, high: Point, longest: float) -> tuple[float, float]:
    """Between which multiples of `way` a ray is in a box, faces included.

    The same number twice is a touch. What a touch counts for, and a start in the box, is left to callers:
    they ask different questions.

    Args:
        start: where the ray begins, along the box's axes (see `along_axes`).
        way: its direction along them, of any length.
        low: the box's lowest corner along them.
        high: the highest one.
        longest: the multiple of `way` at which the ray ends; may be infinite.

    Returns:
        The first and the last multiple, from 0 to `longest`; (inf, -inf) if the ray misses the box.
    """
    enter, leave = 0.0, longest
    for axis in range(3):
        if abs(way[axis]) < _PARALLEL:
            if start[axis] < low[axis] or start[axis] > high[axis]:
                return math.inf, -math.inf
            continue
        one, two = (low[axis] - start[axis]) / way[axis], (high[axis] - start[axis]) / way[axis]
        enter, leave = max(enter, min(one, two)), min(leave, max(one, two))
        if enter > leave:
            return math.inf, -math.inf
    return enter, leave


@numba.njit(cache=True, nogil=True)
def along_axes(vector: Point, cosine: float, sine: float) -> Point:
    """A vector of the world along axes that are turned counter-clockwise about the vertical."""
    x, y, z = vector
    return cosine * x + sine * y, cosine * y - sine * x, z
