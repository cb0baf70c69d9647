"""What an item lies on or in, by contact in the picture and by geometry (numba)."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.perception.object_table import NO_RECEPTACLE, ON_FLOOR, SEEN, VOTES
from adhoc.perception.voxels import ITEM, STOOD

Array = NDArray[Any]


@numba.njit(cache=True, nogil=True)
def decide_holders(
    slots: Array,
    how_many: int,
    count: int,
    kinds: Array,
    known: Array,
    boxes: Array,
    can_hold: Array,
    vote_slots: Array,
    vote_counts: Array,
    holders: Array,
    floor: Array,
    origin: Array,
    cell: float,
    floor_tolerance: float,
    changed: Array,
) -> None:
    """Decide what each item lies on or in; sets `changed` where the answer is another than before.

    Contact in the picture decides first: the pixel below an item's lower edge, close to it in depth and
    height, shows what it stands on. Without it geometry decides: of the receptacles whose footprint
    contains the item's middle and whose height range contains its bottom, those whose top it stands on go
    before those that it is inside of, and the smallest footprint wins. That the item stands on top of
    something, say a table, also overrules contact with what it would be inside of, say a chair pushed under
    it. An item near the floor is on the
    `Floor` if no footprint contains it, or if floor is seen around it under a table. Otherwise it stays
    undecided: no answer is better than a wrong one.
    """
    for index in range(how_many):
        slot = slots[index]
        before = holders[slot]
        box = boxes[slot]
        answer = _by_contact(slot, vote_slots, vote_counts, boxes, known, floor_tolerance)
        if answer >= 0 and not _stands_on(box, boxes[answer]):
            below = _by_geometry(slot, count, kinds, known, boxes, can_hold)
            if below >= 0 and _stands_on(box, boxes[below]):
                answer = below
        if answer == NO_RECEPTACLE:
            answer = _by_geometry(slot, count, kinds, known, boxes, can_hold)
            if box[2] < floor_tolerance and (
                answer == NO_RECEPTACLE or _floor_around(box, floor, origin, cell) >= 2
            ):
                answer = ON_FLOOR
        if answer == NO_RECEPTACLE:
            answer = before
        holders[slot] = answer
        changed[index] = 1 if answer != before else 0


@numba.njit(cache=True, nogil=True)
def _by_contact(
    slot: int, vote_slots: Array, vote_counts: Array, boxes: Array, known: Array, floor_tolerance: float
) -> int:
    best, answer = 0, NO_RECEPTACLE
    item = boxes[slot]
    x, y = (item[0] + item[3]) / 2, (item[1] + item[4]) / 2
    for index in range(VOTES):
        if vote_counts[slot, index] <= best:
            continue
        holder = vote_slots[slot, index]
        if holder == ON_FLOOR:
            if item[2] >= floor_tolerance:
                continue
        else:
            box = boxes[holder]
            if known[holder] != SEEN or item[2] > box[5] + 0.12 or item[5] < box[2]:
                continue
            if x < box[0] - 0.1 or x > box[3] + 0.1 or y < box[1] - 0.1 or y > box[4] + 0.1:
                continue
        best, answer = vote_counts[slot, index], holder
    return answer


@numba.njit(cache=True, nogil=True)
def _by_geometry(slot: int, count: int, kinds: Array, known: Array, boxes: Array, can_hold: Array) -> int:
    item = boxes[slot]
    x, y, bottom = (item[0] + item[3]) / 2, (item[1] + item[4]) / 2, item[2]
    answer, best_top, best_area = NO_RECEPTACLE, False, np.inf
    for holder in range(count):
        if holder == slot or not can_hold[holder] or known[holder] != SEEN:
            continue
        box = boxes[holder]
        margin = 0.0 if kinds[holder] == ITEM else 0.05
        if x < box[0] - margin or x > box[3] + margin or y < box[1] - margin or y > box[4] + margin:
            continue
        if bottom < box[2] - 0.05 or bottom > box[5] + 0.12:
            continue
        on_top = _stands_on(item, box)
        area = (box[3] - box[0]) * (box[4] - box[1])
        if kinds[holder] == ITEM and area < (item[3] - item[0]) * (item[4] - item[1]):
            continue
        if (on_top and not best_top) or (on_top == best_top and area < best_area):
            answer, best_top, best_area = holder, on_top, area
    return answer


@numba.njit(cache=True, nogil=True)
def _stands_on(item: Array, holder: Array) -> bool:
    """Whether an item's bottom is at a holder's top; things in ProcTHOR houses may float 5 cm above it."""
    return bool(-0.06 <= item[2] - holder[5] <= 0.12)


@numba.njit(cache=True, nogil=True)
def _floor_around(box: Array, floor: Array, origin: Array, cell: float) -> int:
    seen = 0
    for corner in range(4):
        x = box[3] + cell if corner % 2 else box[0] - cell
        y = box[4] + cell if corner // 2 else box[1] - cell
        ix, iy = int((x - origin[0]) / cell), int((y - origin[1]) / cell)
        if 0 <= ix < floor.shape[0] and 0 <= iy < floor.shape[1] and 0 < floor[ix, iy] < STOOD:
            seen += 1
    return seen
