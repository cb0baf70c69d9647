"""Growing rooms over the cells of a house, group by group, after the constrained growth that ProcTHOR uses.

Every member of a group starts at a cell; members then grow in turn by whole sides as long as they are
rectangles, later by the longest free part of a side; what is left goes to the neighbour that surrounds it
most. Each member's cells are then divided among its own members in the same way. (Lopes et al., 'A
constrained growth method for procedural floor plan generation', 2010; ProcTHOR, 2022, appendix.)
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.houses.generation.floor_judging import OUTSIDE, is_sound, neighbour, score
from adhoc.houses.generation.room_specs import RoomGroup, RoomShare

TRIES = 100
"""Floors that are grown, of which the best is kept; as in ProcTHOR."""
CELLS_PER_SHARE = 4
"""Cells that a member covers at most, per unit of its share, while members are still rectangles."""

_DRAWS = 1024
"""Random numbers for one try; the few tries that need more start them over."""

Array = NDArray[Any]


def grow_rooms(
    rooms: RoomGroup, inside: NDArray[np.bool_], generator: np.random.Generator, tries: int = TRIES
) -> list[NDArray[np.int8]]:
    """Floors on which every room has cells, best first; may be empty.

    A floor has the position of a room among `rooms.leaves()` on each of its cells and OUTSIDE elsewhere.
    Every room has at least FEWEST_CELLS cells. Every room and every group is connected; a room has no hole,
    and touches itself at no corner alone. The best floor gives the rooms most nearly their shares and has
    fewest narrow places.
    """
    tree = _Tree(rooms)
    floors = np.empty((tries, *inside.shape), dtype=np.int8)
    scores = np.empty(tries)
    draws = generator.random((tries, _DRAWS))
    _grow_all(tree.first, tree.count, tree.share, tree.part, inside, draws, floors, scores)
    order = np.argsort(-scores, kind="stable")
    floors = np.where(floors >= 0, tree.leaf[floors], OUTSIDE).astype(np.int8)
    return [floors[index] for index in order if scores[index] >= 0]


class _Tree:
    """The groups and rooms as arrays: node 0 is the house, the members of a node come one after another."""

    def __init__(self, rooms: RoomGroup) -> None:
        nodes: list[RoomShare | RoomGroup] = [rooms]
        first, count, part = [], [], [1.0]
        for index, node in enumerate(nodes):
            members = node.members if isinstance(node, RoomGroup) else ()
            first.append(len(nodes))
            count.append(len(members))
            nodes.extend(members)
            whole = sum(member.share for member in members)
            part.extend(part[index] * member.share / whole for member in members)
        names = _leaf_positions(rooms)
        self.first, self.count = np.array(first), np.array(count)
        self.share = np.array([node.share for node in nodes])
        self.part = np.array(part)
        """Each node's part of the whole floor."""
        self.leaf = np.array(
            [names.pop(0) if isinstance(node, RoomShare) else OUTSIDE for node in nodes], dtype=np.int8
        )


def _leaf_positions(rooms: RoomGroup) -> list[int]:
    """For each room, level by level from the house down, its position among `rooms.leaves()`."""
    numbered: list[tuple[RoomShare | RoomGroup, int]] = [(rooms, 0)]
    order = []
    for node, start in numbered:
        if isinstance(node, RoomShare):
            order.append(start)
            continue
        for member in node.members:
            numbered.append((member, start))
            start += 1 if isinstance(member, RoomShare) else len(list(member.leaves()))
    return order


@numba.njit(cache=True, nogil=True)
def _grow_all(
    first: Array,
    count: Array,
    share: Array,
    part: Array,
    inside: Array,
    draws: Array,
    floors: Array,
    scores: Array,
) -> None:
    boxes = np.zeros((first.size, 4), np.int64)
    cursor = np.zeros(1, np.int64)
    for index in range(floors.shape[0]):
        floor = floors[index]
        for row in range(inside.shape[0]):
            for column in range(inside.shape[1]):
                floor[row, column] = 0 if inside[row, column] else OUTSIDE
        cursor[0] = 0
        scores[index] = -1.0
        grown = True
        for node in range(first.size):
            if grown and count[node] > 0:
                grown = _divide(floor, node, first[node], count[node], share, boxes, draws[index], cursor)
        if grown and is_sound(floor, count):
            scores[index] = score(floor, count, part)


@numba.njit(cache=True, nogil=True)
def _divide(
    floor: Array,
    parent: int,
    first: int,
    count: int,
    share: Array,
    boxes: Array,
    draws: Array,
    cursor: Array,
) -> bool:
    """Give every cell of `parent` to one of its members; False if there is not enough room."""
    for child in range(first, first + count):
        if not _start(floor, parent, child, first, boxes, draws, cursor):
            return False
    for rectangular in (True, False):
        growing = np.ones(count, np.bool_)
        while growing.any():
            child = first + _pick(growing, share[first : first + count], draws, cursor)
            box = boxes[child]
            cells = (box[1] - box[0]) * (box[3] - box[2])
            full = rectangular and cells > CELLS_PER_SHARE * share[child]
            if full or not _grow(floor, parent, child, box, rectangular, draws, cursor):
                growing[child - first] = False
    return bool(_fill(floor, parent))


@numba.njit(cache=True, nogil=True)
def _next(draws: Array, cursor: Array) -> float:
    value = draws[cursor[0] % draws.size]
    cursor[0] += 1
    return float(value)


@numba.njit(cache=True, nogil=True)
def _start(
    floor: Array, parent: int, child: int, first: int, boxes: Array, draws: Array, cursor: Array
) -> bool:
    """Put a member on a random cell that is no neighbour of another member's first cell."""
    rows, columns = floor.shape
    free = 0
    for row in range(rows):
        for column in range(columns):
            free += floor[row, column] == parent and not _is_near(row, column, first, child, boxes)
    if free == 0:
        return False
    wanted = int(_next(draws, cursor) * free)
    for row in range(rows):
        for column in range(columns):
            if floor[row, column] == parent and not _is_near(row, column, first, child, boxes):
                if wanted == 0:
                    floor[row, column] = child
                    boxes[child, 0], boxes[child, 1] = row, row + 1
                    boxes[child, 2], boxes[child, 3] = column, column + 1
                    return True
                wanted -= 1
    return False


@numba.njit(cache=True, nogil=True)
def _is_near(row: int, column: int, first: int, last: int, boxes: Array) -> bool:
    for other in range(first, last):
        if abs(boxes[other, 0] - row) <= 1 and abs(boxes[other, 2] - column) <= 1:
            return True
    return False


@numba.njit(cache=True, nogil=True)
def _pick(growing: Array, share: Array, draws: Array, cursor: Array) -> int:
    """A member that still grows, with a chance in proportion to its share."""
    total = 0
    for index in range(growing.size):
        total += share[index] if growing[index] else 0
    rest = _next(draws, cursor) * total
    last = 0
    for index in range(growing.size):
        if growing[index]:
            last = index
            rest -= share[index]
            if rest < 0:
                break
    return last


@numba.njit(cache=True, nogil=True)
def _grow(
    floor: Array, parent: int, child: int, box: Array, whole: bool, draws: Array, cursor: Array
) -> bool:
    """Grow a member by its longest free stretch of a side, or by a `whole` side; False if none is free."""
    starts = np.zeros(4, np.int64)
    lengths = np.zeros(4, np.int64)
    for side in range(4):
        starts[side], lengths[side] = _free_stretch(floor, parent, child, box, side)
        low, high = (box[2], box[3]) if side < 2 else (box[0], box[1])
        if whole and lengths[side] < high - low:
            lengths[side] = 0
    longest = lengths.max()
    if longest == 0:
        return False
    wanted = int(_next(draws, cursor) * (lengths == longest).sum())
    for side in range(4):
        if lengths[side] == longest:
            if wanted == 0:
                _widen(floor, child, box, side, starts[side], longest)
                return True
            wanted -= 1
    return False


@numba.njit(cache=True, nogil=True)
def _free_stretch(floor: Array, parent: int, child: int, box: Array, side: int) -> tuple[int, int]:
    """Where the longest stretch of a side begins that the member can step out over, and its length.

    Sides 0 and 1 are the rows below and above the box, 2 and 3 the columns before and after it.
    """
    inner = box[side] - side % 2
    outer = inner - 1 + 2 * (side % 2)
    limit = floor.shape[0] if side < 2 else floor.shape[1]
    best_start, best_length = 0, 0
    if outer < 0 or outer >= limit:
        return best_start, best_length
    low, high = (box[2], box[3]) if side < 2 else (box[0], box[1])
    length = 0
    for along in range(low, high):
        if side < 2:
            free = floor[outer, along] == parent and floor[inner, along] == child
        else:
            free = floor[along, outer] == parent and floor[along, inner] == child
        length = length + 1 if free else 0
        if length > best_length:
            best_start, best_length = along - length + 1, length
    return best_start, best_length


@numba.njit(cache=True, nogil=True)
def _widen(floor: Array, child: int, box: Array, side: int, start: int, length: int) -> None:
    outer = box[side] if side % 2 else box[side] - 1
    box[side] += 1 if side % 2 else -1
    for along in range(start, start + length):
        if side < 2:
            floor[outer, along] = child
        else:
            floor[along, outer] = child


@numba.njit(cache=True, nogil=True)
def _fill(floor: Array, parent: int) -> bool:
    """Give what is left to the neighbour that surrounds it most; False if some cell has none."""
    rows, columns = floor.shape
    left = True
    for _ in range(rows * columns):
        left, changed = False, False
        for row in range(rows):
            for column in range(columns):
                if floor[row, column] == parent:
                    heir = _heir(floor, parent, row, column)
                    left = left or heir < 0
                    if heir >= 0:
                        floor[row, column] = heir
                        changed = True
        if not left or not changed:
            break
    return not left


@numba.njit(cache=True, nogil=True)
def _heir(floor: Array, parent: int, row: int, column: int) -> int:
    """The member of `parent` on most sides of a cell, -1 if there is none: members come after parents."""
    best, most = -1, 0
    for step in range(4):
        other = neighbour(floor, row, column, step)
        if other > parent:
            sides = 0
            for again in range(4):
                sides += neighbour(floor, row, column, again) == other
            if sides > most:
                best, most = other, sides
    return best
