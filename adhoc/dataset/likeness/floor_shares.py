"""Where furniture stands and what it leaves of a room's floor, as shares between 0 and 1."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.houses import floor_plan
from adhoc.houses.build import build_solids
from adhoc.houses.house import House, HouseObject, Room

AT_WALL_WITHIN = 0.1
"""Metres between furniture and the outline of its room, at most, to stand at a wall."""
TURNED_BY = math.radians(2.0)
"""More than this off the axes of the floor plan is turned."""
LATTICE = 0.025
"""Metres between the points at which shares of the floor are measured: finer than robots move, so that it
hardly matters how rooms lie on the lattice."""


def share_at_wall(room: Room, furniture: Sequence[HouseObject]) -> float:
    """Share of the pieces that stand within `AT_WALL_WITHIN` of the room's outline. Needs at least one."""
    return sum(_gap_to_wall(room, thing) <= AT_WALL_WITHIN for thing in furniture) / len(furniture)


def share_turned(furniture: Sequence[HouseObject]) -> float:
    """Share of the pieces that are turned away from the axes of the floor plan."""
    quarters = [thing.yaw / (math.pi / 2) for thing in furniture]
    return sum(abs(q - round(q)) * math.pi / 2 > TURNED_BY for q in quarters) / len(furniture)


def covered_share(room: Room, furniture: Sequence[HouseObject]) -> float:
    """Share of the room's floor below the bounding boxes of its furniture."""
    points = _floor_points(room)
    covered = np.zeros(len(points), dtype=bool)
    for thing in furniture:
        cosine, sine = np.cos(thing.yaw), np.sin(thing.yaw)
        dx, dy = points[:, 0] - thing.position[0], points[:, 1] - thing.position[1]
        across, along = cosine * dx + sine * dy, cosine * dy - sine * dx
        covered |= (np.abs(across) <= thing.size[0] / 2) & (np.abs(along) <= thing.size[1] / 2)
    return float(covered.mean())


def free_shares(house: House) -> dict[str, float]:
    """By room, the share of its floor where a robot fits."""
    cells = FreeCells(house.rooms, build_solids(house), LATTICE)
    return {
        room.id: float((cells.free & (cells.room == number)).sum())
        * LATTICE**2
        / floor_plan.area(room.polygon)
        for number, room in enumerate(house.rooms)
    }


def _gap_to_wall(room: Room, thing: HouseObject) -> float:
    """Metres from an object's extents along the walls to the nearest edge of its room's outline."""
    (x, y, _), (across, along, _) = thing.position, thing.size
    cosine, sine = abs(math.cos(thing.yaw)), abs(math.sin(thing.yaw))
    half_x, half_y = (cosine * across + sine * along) / 2, (sine * across + cosine * along) / 2
    gaps = []
    for (ax, ay), (bx, by) in floor_plan.edges(room.polygon):
        gap_x = max(min(ax, bx) - x, x - max(ax, bx), 0.0) - half_x
        gap_y = max(min(ay, by) - y, y - max(ay, by), 0.0) - half_y
        gaps.append(math.hypot(max(0.0, gap_x), max(0.0, gap_y)))
    return min(gaps)


def _floor_points(room: Room) -> NDArray[np.float64]:
    """Points of a lattice over the room's floor, the first half a step from its corner; shape (n, 2)."""
    parts = []
    for x0, y0, x1, y1 in floor_plan.rectangles(room.polygon):
        columns, rows = (max(1, round(length / LATTICE)) for length in (x1 - x0, y1 - y0))
        xs = x0 + (np.arange(columns) + 0.5) * (x1 - x0) / columns
        ys = y0 + (np.arange(rows) + 0.5) * (y1 - y0) / rows
        parts.append(np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2))
    return np.concatenate(parts)
