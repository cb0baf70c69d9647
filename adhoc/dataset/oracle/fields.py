"""Distance fields over cells and over stances (numba)."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.oracle.stances import AIMS, HEADINGS, TILTS

FAR = 100_000
"""The cost of what cannot be reached."""

Ints = NDArray[np.int32]


def cell_field(moves: Ints, costs: Ints, labels: Ints) -> tuple[Ints, Ints]:
    """The cost of reaching every cell from the cells that have a cost, one a move.

    Args:
        moves: (cells, 4), where moves lead, -1 where they are not free.
        costs: (cells,), the costs to begin with, `FAR` where nothing begins.
        labels: (cells,), a number for each source.

    Returns:
        The costs (cells,), and the label of the source that each cell is reached from.
    """
    costs, labels = costs.copy(), labels.copy()
    _spread_cells(moves, costs, labels)
    return costs, labels


def stance_field(moves: Ints, costs: Ints) -> Ints:
    """The cost (cells, 16) of reaching every stance from the stances that have a cost; a move, a quarter turn
    and a tilt cost one each."""
    costs = costs.copy()
    _spread_stances(moves, costs)
    return costs


@numba.njit(cache=True, nogil=True)
def _spread_cells(moves: Ints, costs: Ints, labels: Ints) -> None:
    count = costs.shape[0]
    first, most = FAR, 0
    for cell in range(count):
        if costs[cell] < FAR:
            first = min(first, costs[cell])
            most = max(most, costs[cell])
    if first == FAR:
        return
    starts = np.full(most - first + 1, -1, np.int32)
    following = np.empty(count, np.int32)
    for cell in range(count - 1, -1, -1):
        if costs[cell] < FAR:
            following[cell] = starts[costs[cell] - first]
            starts[costs[cell] - first] = cell
    front = np.empty(count, np.int32)
    coming = np.empty(count, np.int32)
    reached, cost = 0, first
    while reached > 0 or cost <= most:
        if cost <= most:
            source = starts[cost - first]
            while source >= 0:
                if costs[source] == cost:
                    front[reached] = source
                    reached += 1
                source = following[source]
        ahead = 0
        for index in range(reached):
            cell = front[index]
            for move in range(4):
                neighbour = moves[cell, move]
                if neighbour >= 0 and costs[neighbour] > cost + 1:
                    costs[neighbour] = cost + 1
                    labels[neighbour] = labels[cell]
                    coming[ahead] = neighbour
                    ahead += 1
        front, coming = coming, front
        reached = ahead
        cost += 1


@numba.njit(cache=True, nogil=True)
def _spread_stances(moves: Ints, costs: Ints) -> None:
    """Moves keep the aim and aims change in place, so that turning first and moving then is as good as any
    other order: the field over cells is spread for each aim by itself."""
    count = costs.shape[0]
    labels = np.zeros(count, np.int32)
    for cell in range(count):
        _spread_aims(costs[cell])
    for aim in range(AIMS):
        layer = costs[:, aim].copy()
        _spread_cells(moves, layer, labels)
        costs[:, aim] = layer


@numba.njit(cache=True, nogil=True)
def _spread_aims(costs: Ints) -> None:
    least = FAR
    for aim in range(AIMS):
        least = min(least, costs[aim])
    if least == FAR:
        return
    for heading in range(HEADINGS):
        base = TILTS * heading
        for tilt in range(1, TILTS):
            costs[base + tilt] = min(costs[base + tilt], costs[base + tilt - 1] + 1)
        for tilt in range(TILTS - 2, -1, -1):
            costs[base + tilt] = min(costs[base + tilt], costs[base + tilt + 1] + 1)
    for tilt in range(TILTS):
        for _ in range(2):
            for heading in range(HEADINGS):
                left = costs[TILTS * ((heading + 1) % HEADINGS) + tilt] + 1
                right = costs[TILTS * ((heading + HEADINGS - 1) % HEADINGS) + tilt] + 1
                costs[TILTS * heading + tilt] = min(costs[TILTS * heading + tilt], min(left, right))
