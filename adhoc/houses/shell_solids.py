"""The solids of the house itself: floors, walls around their openings, closed doors and window panes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from adhoc.core.values import Point
from adhoc.houses import floor_plan
from adhoc.houses.house import Corner, Opening, Room, Wall
from adhoc.houses.solids import Box, Solid, SolidKind, Surface

FLOOR_THICKNESS = 0.1
"""Metres; the top of every floor is at height 0."""
PANE_SHARE = 0.5
"""Thickness of closed doors and panes as a share of their wall's, so that no face of theirs is the wall's."""
SLIVER = 1e-6


def floor_of(room: Room) -> Solid:
    """The floor of a room: one slab per rectangle of its outline, on which things can be put.

    Outlines of neighbouring rooms meet in the middle of their walls, so doorways have a floor too.
    """
    boxes, surfaces = [], []
    for x0, y0, x1, y1 in floor_plan.rectangles(room.polygon):
        middle, half = ((x0 + x1) / 2, (y0 + y1) / 2), ((x1 - x0) / 2, (y1 - y0) / 2)
        boxes.append(Box((*middle, -FLOOR_THICKNESS / 2), (*half, FLOOR_THICKNESS / 2)))
        surfaces.append(Surface((*middle, 0.0), half, 0.0, math.inf))
    return Solid(room.id, "Floor", SolidKind.FLOOR, tuple(boxes), tuple(surfaces))


def wall_solid(wall: Wall, thickness: float) -> Solid:
    """A wall as boxes beside, below and above its openings."""
    boxes = []
    cuts = sorted({0.0, _length(wall), *(end for hole in wall.openings for end in _span(wall, hole))})
    for low, high in pairwise(cuts):
        if high - low > SLIVER:
            for bottom, top in _solid_heights(wall, (low + high) / 2):
                boxes.append(_upright_box(wall, (low, high), (bottom, top), thickness))
    return Solid(wall.id, "Wall", SolidKind.WALL, tuple(boxes))


def closures_of(wall: Wall, thickness: float) -> Iterator[Solid]:
    """The closed doors and the panes of a wall; openings that a robot can pass have none."""
    for hole in wall.openings:
        if not hole.passable:
            box = _upright_box(wall, _span(wall, hole), (hole.bottom, hole.top), thickness * PANE_SHARE)
            category = "Window" if hole.kind == "window" else "Door"
            yield Solid(hole.id, category, SolidKind.DOOR, (box,))


def _solid_heights(wall: Wall, along: float) -> Iterator[tuple[float, float]]:
    """The intervals of height where the wall is solid, `along` metres from its start."""
    bottom = 0.0
    holes = [hole for hole in wall.openings if _span(wall, hole)[0] < along < _span(wall, hole)[1]]
    for hole in sorted(holes, key=lambda hole: hole.bottom):
        if hole.bottom - bottom > SLIVER:
            yield bottom, hole.bottom
        bottom = max(bottom, hole.top)
    if wall.height - bottom > SLIVER:
        yield bottom, wall.height


def _upright_box(wall: Wall, span: Corner, heights: Corner, thickness: float) -> Box:
    (ax, ay), (bx, by) = wall.start, wall.end
    share = (span[0] + span[1]) / 2 / _length(wall)
    center: Point = (ax + (bx - ax) * share, ay + (by - ay) * share, (heights[0] + heights[1]) / 2)
    half_length, half_height = (span[1] - span[0]) / 2, (heights[1] - heights[0]) / 2
    if by == ay:
        return Box(center, (half_length, thickness / 2, half_height))
    return Box(center, (thickness / 2, half_length, half_height))


def _span(wall: Wall, hole: Opening) -> Corner:
    """Where the hole begins and ends, in metres from the wall's start."""
    ends = [math.dist(wall.start, corner) for corner in (hole.start, hole.end)]
    return max(0.0, min(ends)), min(_length(wall), max(ends))


def _length(wall: Wall) -> float:
    return math.dist(wall.start, wall.end)
