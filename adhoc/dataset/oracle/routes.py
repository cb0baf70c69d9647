"""Routes in space and time: the way to a deed, and the way out of others' way (numba)."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.oracle.fields import FAR
from adhoc.dataset.oracle.stances import AIMS, HEADINGS, TILTS, Deed

Ints = NDArray[np.int32]
Counts = NDArray[np.uint8]
Mask = NDArray[np.bool_]

_ACT, _WAIT = int(Deed.ACT), int(Deed.WAIT)
_TURN_LEFT, _TURN_RIGHT = int(Deed.TURN_LEFT), int(Deed.TURN_RIGHT)
_LOOK_DOWN, _LOOK_UP = int(Deed.LOOK_DOWN), int(Deed.LOOK_UP)


class Reservations:
    """Which cells are taken at which time, by robots whose routes are settled.

    A robot takes its cell and those around it, from one step before it is there to one step after: robots
    act one after the other within a step, and no order of acting must matter.

    Args:
        near: (cells, 9), the cells that a robot keeps others from.
        horizon: the number of steps that are looked at.
    """

    def __init__(self, near: Ints, horizon: int) -> None:
        self._near = near
        self.taken: Counts = np.zeros((horizon + 2, len(near)), np.uint8)

    def add(self, cells: NDArray[np.int64], start: int, sign: int = 1) -> None:
        """Enter (or, with sign -1, take out) a robot that is on these cells from time `start` on."""
        _enter(self.taken, self._near, cells, start, sign)


def route_to_deed(
    stance: int,
    start: int,
    end: int,
    value: Ints,
    rest: Ints,
    moves: Ints,
    taken: Counts,
    most_delay: int,
    most_nodes: int,
) -> list[int] | None:
    """The deeds (`stances.Deed`) that lead to the best stance for an act, and the act; nobody is met.

    A* with the cost to go without other robots, which is exact as long as nobody is in the way.

    Args:
        stance: where the robot is at time `start`.
        start: the time, in steps.
        end: when it has to be done.
        value: (cells, 16), the cost of everything that is left, from each stance.
        rest: (cells, 16), the cost of what is left after the act, `FAR` where it cannot be done.
        moves: (cells, 4), where moves lead.
        taken: (times, cells), not 0 where others are.
        most_delay: steps by which others may delay the robot.
        most_nodes: when to give up.
    """
    first = int(value.reshape(-1)[stance])
    if first >= FAR:
        return None
    span = min(first + most_delay, end - start, len(taken) - 2 - start) + 1
    if span <= 0:
        return None
    visited = np.zeros((span, value.size), np.bool_)
    deeds = np.empty(span + 1, np.int8)
    count = _search(stance, start, span, value, rest, moves, taken, most_delay, most_nodes, visited, deeds)
    return None if count < 0 else deeds[:count].tolist()


def route_aside(
    cell: int, start: int, end: int, moves: Ints, taken: Counts, most_moves: int
) -> NDArray[np.int64] | None:
    """The cells of a robot from time `start` to `end` that is in nobody's way, with the fewest moves.

    None if there is no such route with at most `most_moves` moves.
    """
    if not taken[start : end + 1, cell].any():
        return np.full(end - start + 1, cell, np.int64)
    cells = np.empty(end - start + 1, np.int64)
    return cells if _dodge(cell, start, end, moves, taken, most_moves, cells) else None


@numba.njit(cache=True, nogil=True)
def _enter(taken: Counts, near: Ints, cells: NDArray[np.int64], start: int, sign: int) -> None:
    for index in range(cells.shape[0]):
        for time in range(start + index - 1, start + index + 2):
            if time < 0 or time >= taken.shape[0]:
                continue
            for other in range(near.shape[1]):
                cell = near[cells[index], other]
                if cell >= 0:
                    taken[time, cell] += sign


@numba.njit(cache=True, nogil=True)
def _search(
    stance: int,
    start: int,
    span: int,
    value: Ints,
    rest: Ints,
    moves: Ints,
    taken: Counts,
    most_delay: int,
    most_nodes: int,
    visited: Mask,
    deeds: NDArray[np.int8],
) -> int:
    """Best-first search in buckets of equal delay and, among those, of equal waste of battery, the latest
    node first; returns the number of deeds, or -1.

    A delay by waiting wastes nothing, one by useless moves does.
    """
    stances = np.empty(most_nodes, np.int32)
    times = np.empty(most_nodes, np.int32)
    parents = np.empty(most_nodes, np.int32)
    done = np.empty(most_nodes, np.int8)
    following = np.empty(most_nodes, np.int32)
    wastes = np.empty(most_nodes, np.int32)
    width = most_delay + 1
    latest = np.full(width * width, -1, np.int32)
    least = value[stance // AIMS, stance % AIMS]
    stances[0], times[0], parents[0], done[0], following[0] = stance, 0, -1, _WAIT, -1
    latest[0], wastes[0] = 0, 0
    used, bucket = 1, 0
    found = -1
    while bucket < len(latest) and found < 0:
        node = latest[bucket]
        if node < 0:
            bucket += 1
            continue
        latest[bucket] = following[node]
        if done[node] == _ACT:
            found = node
            break
        here, time = stances[node], times[node]
        if visited[time, here]:
            continue
        visited[time, here] = True
        if time + 1 >= span:
            continue
        if used + 10 > most_nodes:
            return -1
        cell, aim = here // AIMS, here % AIMS
        heading, tilt = aim // TILTS, aim % TILTS
        late_here = bucket // width
        # The last one pushed is tried first: waiting is the last resort, acting the first.
        for deed in (8, 4, 5, 6, 7, 0, 1, 2, 3, 9):
            goal_cell, goal_aim = cell, aim
            if deed < 4:
                goal_cell = moves[cell, deed]
                if goal_cell < 0:
                    continue
            elif deed == _TURN_LEFT:
                goal_aim = TILTS * ((heading + 1) % HEADINGS) + tilt
            elif deed == _TURN_RIGHT:
                goal_aim = TILTS * ((heading + HEADINGS - 1) % HEADINGS) + tilt
            elif deed == _LOOK_DOWN:
                if tilt == TILTS - 1:
                    continue
                goal_aim = aim + 1
            elif deed == _LOOK_UP:
                if tilt == 0:
                    continue
                goal_aim = aim - 1
            if taken[start + time + 1, goal_cell] > 0:
                continue
            left = rest[cell, aim] - 1 if deed == _ACT else value[goal_cell, goal_aim]
            late = time + 1 + left - least
            if left >= FAR or late > most_delay:
                continue
            if deed != _ACT and visited[time + 1, goal_cell * AIMS + goal_aim]:
                continue
            stances[used] = goal_cell * AIMS + goal_aim
            times[used], parents[used], done[used] = time + 1, node, deed
            waste = wastes[node] if deed == _WAIT else wastes[node] + late - late_here
            wastes[used] = waste
            following[used] = latest[late * width + waste]
            latest[late * width + waste] = used
            used += 1
    if found < 0:
        return -1
    count = int(times[found])
    node = found
    for index in range(count - 1, -1, -1):
        deeds[index] = done[node]
        node = parents[node]
    return count


@numba.njit(cache=True, nogil=True)
def _dodge(
    cell: int,
    start: int,
    end: int,
    moves: Ints,
    taken: Counts,
    most_moves: int,
    cells: NDArray[np.int64],
) -> bool:
    """Fewest moves to each cell, time after time; waiting costs nothing."""
    count, length = moves.shape[0], end - start + 1
    unreached = most_moves + 1
    costs = np.full(count, unreached, np.int32)
    costs[cell] = 0
    origins = np.full((length, count), -1, np.int32)
    for index in range(1, length):
        coming = np.full(count, unreached, np.int32)
        any_left = False
        for here in range(count):
            cost = costs[here]
            if cost >= unreached:
                continue
            for move in range(-1, 4):
                there = here if move < 0 else moves[here, move]
                price = cost if move < 0 else cost + 1
                if there < 0 or price >= unreached or taken[start + index, there] > 0:
                    continue
                if price < coming[there]:
                    coming[there] = price
                    origins[index, there] = here
                    any_left = True
        if not any_left:
            return False
        costs = coming
    best = 0
    for here in range(count):
        if costs[here] < costs[best]:
            best = here
    for index in range(length - 1, -1, -1):
        cells[index] = best
        best = origins[index, best]
    return True


def stances_along(stance: int, deeds: list[int], moves: Ints) -> list[int]:
    """The stance before each deed and after the last one."""
    passed = [stance]
    for deed in deeds:
        cell, aim = divmod(passed[-1], AIMS)
        heading, tilt = divmod(aim, TILTS)
        if deed < Deed.TURN_LEFT:
            cell = int(moves[cell, deed])
        elif deed in (_TURN_LEFT, _TURN_RIGHT):
            heading = (heading + (1 if deed == _TURN_LEFT else -1)) % HEADINGS
        elif deed in (_LOOK_DOWN, _LOOK_UP):
            tilt += 1 if deed == _LOOK_DOWN else -1
        passed.append(AIMS * cell + TILTS * heading + tilt)
    return passed


def battery_of(deeds: list[int]) -> int:
    """What the deeds cost: waiting is free."""
    return sum(deed != _WAIT for deed in deeds)
