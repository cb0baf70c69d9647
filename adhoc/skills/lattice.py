"""Path search over the lattice of poses that a robot's steps can reach (numba)."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

STEP_COST = 10
"""Cost of a step over known, roomy floor; other costs are in the same unit."""

_BUCKETS = 128
UNREACHED = 2**31 - 1
"""Distance of a node to which there is no way."""

_DIRECTIONS = np.array([[1, 0], [0, 1], [-1, 0], [0, -1]])

Array = NDArray[Any]


@numba.njit(cache=True, nogil=True)
def node_costs(
    frame: Array,
    cell: float,
    origin: Array,
    floor: Array,
    blocked: Array,
    known: Array,
    told: Array,
    per_tile: int,
    robots: Array,
    robot_clearance: float,
    tight_cost: int,
    unknown_cost: int,
    costs: Array,
) -> None:
    """Cost of stepping onto each lattice node, 0 where a robot cannot stand as far as is known.

    `frame` is (x, y, step * cos, step * sin) of the node in the middle of `costs`. Only square metres of
    which something is known, and their neighbours, can be entered: that bounds the search.
    """
    costs[:] = 0
    tiles = floor.shape[0] // per_tile
    width = per_tile * cell
    step = frame[2] * frame[2] + frame[3] * frame[3]
    across = width * (abs(frame[2]) + abs(frame[3])) / step
    open_tiles = _tiles_to_enter(known, told, tiles)
    for tile in range(tiles * tiles):
        if not open_tiles[tile]:
            continue
        dx = origin[0] + (tile // tiles + 0.5) * width - frame[0]
        dy = origin[1] + (tile % tiles + 0.5) * width - frame[1]
        a = (dx * frame[2] + dy * frame[3]) / step + costs.shape[0] // 2
        b = (dy * frame[2] - dx * frame[3]) / step + costs.shape[0] // 2
        for node_a in range(max(int(a - across / 2), 0), min(int(a + across / 2) + 2, costs.shape[0])):
            for node_b in range(max(int(b - across / 2), 0), min(int(b + across / 2) + 2, costs.shape[0])):
                if costs[node_a, node_b] == 0:
                    costs[node_a, node_b] = _node_cost(
                        node_a,
                        node_b,
                        costs.shape[0] // 2,
                        frame,
                        cell,
                        origin,
                        floor,
                        blocked,
                        open_tiles,
                        per_tile,
                        robots,
                        robot_clearance,
                        tight_cost,
                        unknown_cost,
                    )


@numba.njit(cache=True, nogil=True)
def _node_cost(
    a: int,
    b: int,
    middle: int,
    frame: Array,
    cell: float,
    origin: Array,
    floor: Array,
    blocked: Array,
    open_tiles: Array,
    per_tile: int,
    robots: Array,
    robot_clearance: float,
    tight_cost: int,
    unknown_cost: int,
) -> int:
    near, side = 2, floor.shape[0]
    x = frame[0] + (a - middle) * frame[2] - (b - middle) * frame[3]
    y = frame[1] + (a - middle) * frame[3] + (b - middle) * frame[2]
    ix, iy = int((x - origin[0]) / cell), int((y - origin[1]) / cell)
    if ix < near or iy < near or ix >= side - near or iy >= side - near or blocked[ix, iy]:
        return 0
    if not open_tiles[ix // per_tile * (side // per_tile) + iy // per_tile]:
        return 0
    for index in range(robots.shape[0]):
        if (robots[index, 0] - x) ** 2 + (robots[index, 1] - y) ** 2 < robot_clearance**2:
            return 0
    cost = STEP_COST
    if blocked[ix - near, iy] or blocked[ix + near, iy] or blocked[ix, iy - near] or blocked[ix, iy + near]:
        cost += tight_cost
    if floor[ix, iy] == 0:
        cost += unknown_cost
    return cost


@numba.njit(cache=True, nogil=True)
def _tiles_to_enter(known: Array, told: Array, tiles: int) -> Array:
    """The square metres of which something is known, by own eyes or by telling, and their neighbours."""
    entered = np.zeros(tiles * tiles, np.uint8)
    for tile in range(tiles * tiles):
        if known[tile] == 0 and not told[tile]:
            continue
        tx, ty = tile // tiles, tile % tiles
        for nx in range(max(tx - 1, 0), min(tx + 2, tiles)):
            for ny in range(max(ty - 1, 0), min(ty + 2, tiles)):
                entered[nx * tiles + ny] = 1
    return entered


@numba.njit(cache=True, nogil=True)
def spread(
    start: int,
    costs: Array,
    closed_edges: Array,
    frame: Array,
    cell: float,
    origin: Array,
    blocked: Array,
    goals: Array,
    distances: Array,
) -> int:
    """Cheapest costs from `start` to all nodes, or until the best goal is certain (Dial's algorithm).

    `goals` holds the extra cost of ending at a node, -1 where that is no goal; `closed_edges[node,
    direction]` is set where a robot bumped. Fills `distances`; returns the best goal, or -1 if none can be
    reached.
    """
    size = costs.shape[0]
    flat_costs, flat_goals = costs.ravel(), goals.ravel()
    distances[:] = UNREACHED
    capacity = 4 * size * size + 1
    entry_node = np.empty(capacity, np.int32)
    entry_next = np.empty(capacity, np.int32)
    heads = np.full(_BUCKETS, -1, np.int32)
    distances[start] = 0
    entry_node[0], entry_next[0] = start, -1
    heads[0] = 0
    entries, waiting, current = 1, 1, 0
    best, best_cost = -1, UNREACHED
    while waiting > 0:
        entry = heads[current % _BUCKETS]
        if entry < 0:
            current += 1
            continue
        heads[current % _BUCKETS] = entry_next[entry]
        waiting -= 1
        node = entry_node[entry]
        if distances[node] != current:
            continue
        if best >= 0 and current >= best_cost:
            break
        if flat_goals[node] >= 0 and current + flat_goals[node] < best_cost:
            best, best_cost = node, current + flat_goals[node]
        for direction in range(4):
            follower = _step(node, direction, size, flat_costs, closed_edges, frame, cell, origin, blocked)
            if follower < 0:
                continue
            cost = current + flat_costs[follower]
            if cost < distances[follower] and entries < capacity:
                distances[follower] = cost
                entry_node[entries] = follower
                entry_next[entries] = heads[cost % _BUCKETS]
                heads[cost % _BUCKETS] = entries
                entries += 1
                waiting += 1
    return best


@numba.njit(cache=True, nogil=True)
def trace(
    start: int,
    goal: int,
    costs: Array,
    closed_edges: Array,
    frame: Array,
    cell: float,
    origin: Array,
    blocked: Array,
    distances: Array,
    path: Array,
) -> int:
    """Directions of a cheapest path, first to last, into `path`; returns its length. Prefers few corners."""
    size = costs.shape[0]
    flat_costs = costs.ravel()
    node, length, last = goal, 0, -1
    while node != start and length < path.shape[0]:
        chosen = -1
        for offset in range(5):
            direction = last if offset == 0 else offset - 1
            if direction < 0:
                continue
            a = node // size - _DIRECTIONS[direction, 0]
            b = node % size - _DIRECTIONS[direction, 1]
            if a < 0 or b < 0 or a >= size or b >= size:
                continue
            before = a * size + b
            if distances[before] == UNREACHED or distances[before] + flat_costs[node] != distances[node]:
                continue
            if _step(before, direction, size, flat_costs, closed_edges, frame, cell, origin, blocked) == node:
                chosen = direction
                break
        if chosen < 0:
            return 0
        path[length] = chosen
        length += 1
        last = chosen
        node = (node // size - _DIRECTIONS[chosen, 0]) * size + node % size - _DIRECTIONS[chosen, 1]
    path[:length] = path[:length][::-1].copy()
    return length


@numba.njit(cache=True, nogil=True)
def _step(
    node: int,
    direction: int,
    size: int,
    flat_costs: Array,
    closed_edges: Array,
    frame: Array,
    cell: float,
    origin: Array,
    blocked: Array,
) -> int:
    a, b = node // size + _DIRECTIONS[direction, 0], node % size + _DIRECTIONS[direction, 1]
    if a < 0 or b < 0 or a >= size or b >= size or closed_edges[node, direction]:
        return -1
    follower = a * size + b
    if flat_costs[follower] == 0:
        return -1
    middle = size // 2
    half_a = (node // size + a) / 2 - middle
    half_b = (node % size + b) / 2 - middle
    x = frame[0] + half_a * frame[2] - half_b * frame[3]
    y = frame[1] + half_a * frame[3] + half_b * frame[2]
    ix, iy = int((x - origin[0]) / cell), int((y - origin[1]) / cell)
    return -1 if flat_costs[node] > 0 and blocked[ix, iy] else int(follower)
