"""Distance fields, against answers by hand and against plain searches."""

from __future__ import annotations

from collections import deque

import numpy as np
import pytest

from adhoc.dataset.oracle.fields import FAR, cell_field, stance_field
from adhoc.dataset.oracle.stances import AIMS, HEADINGS, TILTS

LINE = np.array([[1, -1, -1, -1], [2, 0, -1, -1], [3, 1, -1, -1], [-1, 2, -1, -1]], np.int32)
"""Four cells in a row."""


def random_moves(generator, columns=5, rows=5):
    """A lattice in which a third of the cells is walled off."""
    free = generator.random((columns, rows)) < 0.67
    moves = np.full((columns * rows, 4), -1, np.int32)
    for i in range(columns):
        for j in range(rows):
            for move, (di, dj) in enumerate(((1, 0), (-1, 0), (0, 1), (0, -1))):
                inside = 0 <= i + di < columns and 0 <= j + dj < rows
                if inside and free[i, j] and free[i + di, j + dj]:
                    moves[i * rows + j, move] = (i + di) * rows + j + dj
    return moves


def test_costs_and_labels_spread_from_several_sources_along_a_row():
    costs, labels = cell_field(LINE, np.array([5, FAR, FAR, 3], np.int32), np.array([7, 0, 0, 9], np.int32))
    assert costs.tolist() == [5, 5, 4, 3]
    assert labels.tolist() == [7, 9, 9, 9]


def test_sources_that_are_reached_cheaper_from_elsewhere_are_overruled():
    costs, labels = cell_field(LINE, np.array([50, FAR, FAR, 0], np.int32), np.array([7, 0, 0, 9], np.int32))
    assert costs.tolist() == [3, 2, 1, 0]
    assert labels.tolist() == [9, 9, 9, 9]


def test_without_sources_nothing_is_reached():
    costs, _ = cell_field(LINE, np.full(4, FAR, np.int32), np.zeros(4, np.int32))
    assert costs.tolist() == [FAR] * 4


def test_turns_and_tilts_count_along_the_row():
    start = np.full((4, AIMS), FAR, np.int32)
    start[0, 0] = 0
    costs = stance_field(LINE, start)
    assert costs[3, 0] == 3
    assert costs[0, TILTS * 2 + 3] == 2 + 3
    assert costs[3, TILTS * 3 + 1] == 3 + 1 + 1


@pytest.mark.parametrize("seed", range(5))
def test_fields_of_stances_are_those_of_a_plain_search(seed):
    generator = np.random.default_rng(seed)
    moves = random_moves(generator)
    start = np.full((len(moves), AIMS), FAR, np.int32)
    for stance in generator.integers(0, start.size, 3):
        start.reshape(-1)[stance] = int(generator.integers(0, 8))
    assert (stance_field(moves, start) == plainly(moves, start)).all()


def plainly(moves, start):
    """Bellman-Ford with a queue."""
    costs = start.reshape(-1).copy()
    waiting = deque(np.flatnonzero(costs < FAR).tolist())
    while waiting:
        stance = waiting.popleft()
        cell, aim = divmod(stance, AIMS)
        heading, tilt = divmod(aim, TILTS)
        neighbours = [other * AIMS + aim for other in moves[cell] if other >= 0]
        neighbours += [cell * AIMS + TILTS * ((heading + turn) % HEADINGS) + tilt for turn in (1, -1)]
        neighbours += [stance + step for step in (1, -1) if 0 <= tilt + step < TILTS]
        for neighbour in neighbours:
            if costs[stance] + 1 < costs[neighbour]:
                costs[neighbour] = costs[stance] + 1
                waiting.append(neighbour)
    return costs.reshape(start.shape)
