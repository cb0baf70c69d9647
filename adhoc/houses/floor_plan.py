"""Rectilinear polygons of the floor plan: containment, distance, and decomposition into rectangles."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from adhoc.houses.house import Corner

Rectangle = tuple[float, float, float, float]
"""x0, y0, x1, y1 with x0 < x1 and y0 < y1."""


def contains(polygon: Sequence[Corner], point: Corner) -> bool:
    """Whether the point is inside the polygon (even-odd rule; a point on the outline may be either)."""
    x, y = point
    inside = False
    for (ax, ay), (bx, by) in edges(polygon):
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            inside = not inside
    return inside


def distance(polygon: Sequence[Corner], point: Corner) -> float:
    """Distance in metres from the point to the polygon, 0 inside."""
    if contains(polygon, point):
        return 0.0
    return min(_distance_to_edge(edge, point) for edge in edges(polygon))


def edges(polygon: Sequence[Corner]) -> list[tuple[Corner, Corner]]:
    """The edges in order, the last of which closes the outline."""
    return list(zip(polygon, [*polygon[1:], polygon[0]]))


def rectangles(polygon: Sequence[Corner]) -> tuple[Rectangle, ...]:
    """Disjoint rectangles that cover a rectilinear polygon: slabs between its y levels, joined upward."""
    levels = sorted({y for _, y in polygon})
    finished: list[Rectangle] = []
    running: dict[tuple[float, float], float] = {}
    for low, high in pairwise(levels):
        spans = _spans(polygon, (low + high) / 2)
        finished += [(x0, y0, x1, low) for (x0, x1), y0 in running.items() if (x0, x1) not in spans]
        running = {span: running.get(span, low) for span in spans}
    finished += [(x0, y0, x1, levels[-1]) for (x0, x1), y0 in running.items()]
    return tuple(finished)


def area(polygon: Sequence[Corner]) -> float:
    """Area in square metres, whichever way round the corners go."""
    return abs(sum(ax * by - bx * ay for (ax, ay), (bx, by) in edges(polygon))) / 2


def overlap(first: Sequence[Rectangle], second: Sequence[Rectangle]) -> float:
    """The area that two sets of disjoint rectangles share, in square metres."""
    return sum(
        max(0.0, min(a[2], b[2]) - max(a[0], b[0])) * max(0.0, min(a[3], b[3]) - max(a[1], b[1]))
        for a in first
        for b in second
    )


def _spans(polygon: Sequence[Corner], y: float) -> list[tuple[float, float]]:
    crossings = sorted(ax for (ax, ay), (_, by) in edges(polygon) if (ay > y) != (by > y))
    return list(zip(crossings[::2], crossings[1::2]))


def _distance_to_edge(edge: tuple[Corner, Corner], point: Corner) -> float:
    (ax, ay), (bx, by) = edge
    px, py = point
    length_squared = (bx - ax) ** 2 + (by - ay) ** 2
    along = ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / length_squared if length_squared else 0.0
    along = min(1.0, max(0.0, along))
    return math.hypot(px - ax - along * (bx - ax), py - ay - along * (by - ay))
