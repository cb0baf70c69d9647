"""Which lattice nodes are a goal: near a point, in a room, where a thing can be reached and seen (numba)."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.perception.semantic_map import NEAR_TARGET
from adhoc.perception.sight_lines import first_obstruction
from adhoc.perception.voxels import STOOD

Array = NDArray[Any]

NO_GOAL = -1
"""Value of a node that is no goal; another value is the extra cost of ending there."""

_INSIDE = 0.1
_WIDEST_VIEW = 0.75


@numba.njit(cache=True, nogil=True)
def mark_standing_places(
    box: Array,
    slot: int,
    room: int,
    kinds: Array,
    eye_height: float,
    reach: float,
    frame: Array,
    cell: float,
    origin: Array,
    voxels: Array,
    topmost: Array,
    floor: Array,
    costs: Array,
    tried: Array,
    needs_sight: bool,
    goals: Array,
) -> int:
    """Mark the lattice nodes from which `box` can be reached and, with `needs_sight`, seen; returns how many.

    The box must be within `reach` metres horizontally. Sight goes from the camera to a point a little inside
    the box or to its middle. The best distance is 0.4 m; a metre more or less costs as much as eight moves. A
    diagonal view costs six: quarter turns leave the thing at the edge of the picture. Another room than
    number `room` (0: unknown) costs forty: there is a wall between, or a door to look through.
    """
    size = costs.shape[0]
    total = 0
    eye, nearest, inside, centre = np.empty(3), np.empty(3), np.empty(3), (box[:3] + box[3:]) / 2
    for a in range(size):
        for b in range(size):
            goals[a, b] = NO_GOAL
            if costs[a, b] == 0 or tried[a * size + b]:
                continue
            eye[0], eye[1] = _point(a, b, size, frame)
            eye[2] = eye_height
            for axis in range(3):
                nearest[axis] = min(max(eye[axis], box[axis]), box[axis + 3])
                shrink = min(_INSIDE, (box[axis + 3] - box[axis]) / 2) if axis < 2 else 0.0
                inside[axis] = min(max(eye[axis], box[axis] + shrink), box[axis + 3] - shrink)
            distance = ((eye[0] - nearest[0]) ** 2 + (eye[1] - nearest[1]) ** 2) ** 0.5
            if distance > reach:
                continue
            if needs_sight:
                grid = (kinds, origin, cell, voxels, topmost)
                hidden = first_obstruction(eye, inside, slot, *grid) > NEAR_TARGET
                if hidden and first_obstruction(eye, centre, slot, *grid) > NEAR_TARGET:
                    continue
            here = floor[int((eye[0] - origin[0]) / cell), int((eye[1] - origin[1]) / cell)]
            extra = 400 if room > 0 and here != room and 0 < here < STOOD else 0
            goals[a, b] = int(80 * abs(distance - 0.4)) + _diagonal_cost(nearest - eye, frame) + extra
            total += 1
    return total


@numba.njit(cache=True, nogil=True)
def mark_near_point(x: float, y: float, radius: float, frame: Array, costs: Array, goals: Array) -> int:
    """Mark the lattice nodes within `radius` metres of a point, the nearest best; returns how many."""
    size = costs.shape[0]
    total = 0
    for a in range(size):
        for b in range(size):
            goals[a, b] = NO_GOAL
            if costs[a, b] == 0:
                continue
            node_x, node_y = _point(a, b, size, frame)
            away = ((node_x - x) ** 2 + (node_y - y) ** 2) ** 0.5
            if away <= radius:
                goals[a, b] = int(40 * away)
                total += 1
    return total


@numba.njit(cache=True, nogil=True)
def mark_room(
    number: int,
    margin: float,
    frame: Array,
    cell: float,
    origin: Array,
    floor: Array,
    costs: Array,
    goals: Array,
) -> int:
    """Mark the lattice nodes on the floor of a room, at least `margin` metres from its neighbours' floors."""
    size, side, reach = costs.shape[0], floor.shape[0], int(margin / cell)
    total = 0
    for a in range(size):
        for b in range(size):
            goals[a, b] = NO_GOAL
            if costs[a, b] == 0:
                continue
            x, y = _point(a, b, size, frame)
            ix, iy = int((x - origin[0]) / cell), int((y - origin[1]) / cell)
            inside = floor[ix, iy] == number
            for k in range(4):
                nx = min(max(ix + reach * ((k == 0) - (k == 1)), 0), side - 1)
                ny = min(max(iy + reach * ((k == 2) - (k == 3)), 0), side - 1)
                inside = inside and (floor[nx, ny] == number or floor[nx, ny] == 0)
            if inside:
                goals[a, b] = 0
                total += 1
    return total


@numba.njit(cache=True, nogil=True)
def _diagonal_cost(away: Array, frame: Array) -> int:
    along = abs(away[0] * frame[2] + away[1] * frame[3])
    across = abs(away[1] * frame[2] - away[0] * frame[3])
    return 60 if min(along, across) > _WIDEST_VIEW * max(along, across) else 0


@numba.njit(cache=True, nogil=True)
def _point(a: int, b: int, size: int, frame: Array) -> tuple[float, float]:
    along, across = a - size // 2, b - size // 2
    return frame[0] + along * frame[2] - across * frame[3], frame[1] + along * frame[3] + across * frame[2]
