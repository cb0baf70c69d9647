"""From the instances of one frame to beliefs about objects: where each is, in which room, and what is gone
(numba). For what an item lies on or in see `holders`."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.perception.object_table import NO_RECEPTACLE, ON_FLOOR, SEEN, UNSEEN, VOTES
from adhoc.perception.voxels import FLOOR_KIND, FURNITURE, ITEM, STOOD

SAME, NEW, MOVED, GROWN = range(4)
"""What a frame did to a belief."""

_SAME_PLACE = 0.05
_GROWTH = 0.02

Array = NDArray[Any]


@numba.njit(cache=True, nogil=True)
def merge_instances(
    found: int,
    slots: Array,
    frame_boxes: Array,
    votes: Array,
    camera: Array,
    focal: float,
    step: int,
    kinds: Array,
    known: Array,
    boxes: Array,
    last_seen: Array,
    rooms: Array,
    room_gaps: Array,
    holders: Array,
    vote_slots: Array,
    vote_counts: Array,
    can_hold: Array,
    misses: Array,
    floor: Array,
    origin: Array,
    cell: float,
    codes: Array,
    room_changed: Array,
    old_boxes: Array,
    old_rooms: Array,
    old_holders: Array,
) -> None:
    """Merge what a frame shows of each instance into the columns of an `ObjectTable`.

    Boxes grow over frames, since one frame shows one side. An item whose new points lie apart from its box
    (by more than 5 cm and a pixel) has moved and starts anew. `codes`, `room_changed` and the old values
    are filled per instance of the frame.
    """
    for local in range(found):
        slot = slots[local]
        kind = kinds[slot]
        codes[local] = SAME
        room_changed[local] = 0
        if kind != ITEM and kind != FURNITURE:
            continue
        old_boxes[local] = boxes[slot]
        old_rooms[local] = rooms[slot]
        old_holders[local] = holders[slot]
        frame = frame_boxes[local]
        if known[slot] != SEEN:
            codes[local] = NEW
        elif kind == ITEM and _gap(frame, boxes[slot]) > _SAME_PLACE + _distance(frame, camera) / focal:
            codes[local] = MOVED
        if codes[local] != SAME:
            boxes[slot] = frame
            room_gaps[slot] = np.inf
            holders[slot] = NO_RECEPTACLE
            vote_counts[slot, :] = 0
            if codes[local] == NEW:
                rooms[slot] = 0
        elif _unite(boxes[slot], frame) > _GROWTH:
            codes[local] = GROWN
        known[slot] = SEEN
        last_seen[slot] = step
        misses[slot] = 0
        if kind == ITEM:
            _count_votes(votes[local], found, slots, kinds, can_hold, vote_slots[slot], vote_counts[slot])
        room, gap = _room_toward(boxes[slot], camera, floor, origin, cell)
        if room > 0 and gap <= room_gaps[slot] + cell:
            room_gaps[slot] = gap
            if rooms[slot] != room:
                rooms[slot] = room
                room_changed[local] = 1


@numba.njit(cache=True, nogil=True)
def find_gone(
    depth: Array,
    instances: Array,
    slot_of: Array,
    intrinsics: Array,
    world_from_camera: Array,
    gone_range: float,
    count: int,
    step: int,
    kinds: Array,
    known: Array,
    boxes: Array,
    last_seen: Array,
    misses: Array,
    looks: int,
    gone: Array,
) -> int:
    """Items believed where frames look right through; returns how many, their slots in `gone`.

    The middle of what was seen of a convex thing lies inside it, so were it there, no pixel around that
    middle could be farther than the middle, but for very thin things that fall between pixels: `looks` frames
    must agree. What is smaller than about two pixels, beyond `gone_range`, occluded or out of the frame is
    not judged.
    """
    height, width = depth.shape
    focal, centre_u, centre_v = intrinsics[0, 0], intrinsics[0, 2], intrinsics[1, 2]
    total = 0
    for slot in range(count):
        if kinds[slot] != ITEM or known[slot] == UNSEEN or last_seen[slot] >= step:
            continue
        box = boxes[slot]
        x = (box[0] + box[3]) / 2 - world_from_camera[0, 3]
        y = (box[1] + box[4]) / 2 - world_from_camera[1, 3]
        z = (box[2] + box[5]) / 2 - world_from_camera[2, 3]
        along = world_from_camera[0, 2] * x + world_from_camera[1, 2] * y + world_from_camera[2, 2] * z
        if along < 0.2 or along > gone_range or x * x + y * y > gone_range * gone_range:
            continue
        u = focal * (world_from_camera[0, 0] * x + world_from_camera[1, 0] * y) / along + centre_u
        across = world_from_camera[0, 1] * x + world_from_camera[1, 1] * y + world_from_camera[2, 1] * z
        v = focal * across / along + centre_v
        if focal * (box[3] - box[0] + box[4] - box[1]) / along < 4 or focal * (box[5] - box[2]) / along < 0.5:
            continue
        j0, i0 = int(u + 0.5) - 1, int(v + 0.5) - 1
        if j0 < 0 or i0 < 0 or j0 + 2 >= width or i0 + 2 >= height:
            continue
        through = True
        for i in range(i0, i0 + 2):
            for j in range(j0, j0 + 3):
                instance = instances[i, j]
                is_it = 0 <= instance < slot_of.shape[0] and slot_of[instance] == slot
                if is_it or depth[i, j] <= along + 0.01:
                    through = False
        misses[slot] = misses[slot] + 1 if through else misses[slot]
        if through and misses[slot] >= looks and total < gone.shape[0]:
            gone[total] = slot
            total += 1
    return total


@numba.njit(cache=True, nogil=True)
def _room_toward(box: Array, camera: Array, floor: Array, origin: Array, cell: float) -> tuple[int, float]:
    """Walk on the floor plan from the middle of a box toward the camera to the first floor seen."""
    x, y = (box[0] + box[3]) / 2, (box[1] + box[4]) / 2
    dx, dy = camera[0] - x, camera[1] - y
    distance = (dx * dx + dy * dy) ** 0.5
    steps = int(distance / cell) + 1
    for index in range(steps + 1):
        share = index / steps
        ix = int((x + dx * share - origin[0]) / cell)
        iy = int((y + dy * share - origin[1]) / cell)
        if 0 <= ix < floor.shape[0] and 0 <= iy < floor.shape[1] and 0 < floor[ix, iy] < STOOD:
            return int(floor[ix, iy]), distance * share
    return 0, np.inf


@numba.njit(cache=True, nogil=True)
def _count_votes(
    row: Array, found: int, slots: Array, kinds: Array, can_hold: Array, names: Array, counts: Array
) -> None:
    for local in range(found):
        if row[local] == 0:
            continue
        below = slots[local]
        if kinds[below] == FLOOR_KIND:
            below = ON_FLOOR
        elif not can_hold[below]:
            continue
        for index in range(VOTES):
            if counts[index] == 0 or names[index] == below:
                names[index] = below
                counts[index] += row[local]
                break


@numba.njit(cache=True, nogil=True)
def _gap(first: Array, second: Array) -> float:
    total = 0.0
    for axis in range(3):
        apart = max(first[axis] - second[axis + 3], second[axis] - first[axis + 3], 0.0)
        total += apart * apart
    return float(total**0.5)


@numba.njit(cache=True, nogil=True)
def _distance(box: Array, camera: Array) -> float:
    total = 0.0
    for axis in range(3):
        apart = (box[axis] + box[axis + 3]) / 2 - camera[axis]
        total += apart * apart
    return float(total**0.5)


@numba.njit(cache=True, nogil=True)
def _unite(box: Array, other: Array) -> float:
    """Grow `box` to hold `other`; returns by how much it grew along the axis that grew most."""
    growth = 0.0
    for axis in range(3):
        growth = max(growth, box[axis] - other[axis], other[axis + 3] - box[axis + 3])
        box[axis] = min(box[axis], other[axis])
        box[axis + 3] = max(box[axis + 3], other[axis + 3])
    return growth
