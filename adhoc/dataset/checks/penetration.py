"""Which boxes of a house are inside each other, and how deep."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.checks.box_arrays import FloatArray, box_arrays
from adhoc.houses.solids import Solid, SolidKind

LIMIT = 0.002
"""Boxes may be this deep inside each other, in metres."""

_GROUPS = {
    SolidKind.FLOOR: 0,
    SolidKind.WALL: 1,
    SolidKind.DOOR: 1,
    SolidKind.FURNITURE: 2,
    SolidKind.ITEM: 2,
}
"""Walls and what closes their holes meet in the corners of rooms and are not held against each other."""

_SHELL = 1


class Penetration(NamedTuple):
    """Two solids of which a box of each is inside the other by `depth` metres."""

    first: str
    second: str
    depth: float


def penetrations(solids: Sequence[Solid], limit: float = LIMIT) -> Iterator[Penetration]:
    """All pairs of solids that are deeper than `limit` metres inside each other, deepest boxes counted.

    The depth is the least distance by which one box would have to move to leave the other, exact for upright
    boxes with any yaw (separating axes: the four directions of their sides, and the vertical). Boxes of one
    solid may overlap, and walls may overlap walls, where they meet.
    """
    boxes = box_arrays(solid.boxes for solid in solids)
    groups = np.array([_GROUPS[solid.kind] for solid in solids], np.int64)
    order = np.argsort(boxes.centers[:, 0] - boxes.reaches()[:, 0], kind="stable")
    table = np.concatenate([boxes.centers, boxes.halves, boxes.headings, boxes.reaches()], axis=1)[order]
    owners = boxes.owners[order]
    deepest: dict[tuple[int, int], float] = {}
    for first, second, depth in _deep_pairs(table, owners, groups[owners], limit):
        pair = (int(min(first, second)), int(max(first, second)))
        deepest[pair] = max(depth, deepest.get(pair, 0.0))
    for (first, second), depth in sorted(deepest.items()):
        yield Penetration(solids[first].id, solids[second].id, float(depth))


@numba.njit(cache=True, nogil=True)
def _deep_pairs(
    table: FloatArray, owners: NDArray[np.int64], groups: NDArray[np.int64], limit: float
) -> list[tuple[int, int, float]]:
    """Owners and depth of all pairs of boxes, which are sorted by their lowest x, beyond the limit."""
    found = [(0, 0, 0.0)]
    found.clear()
    for one in range(table.shape[0]):
        for other in range(one + 1, table.shape[0]):
            if table[other, 0] - table[other, 8] >= table[one, 0] + table[one, 8] - limit:
                break
            if owners[one] == owners[other] or (groups[one] == _SHELL and groups[other] == _SHELL):
                continue
            depth = _depth(table[one], table[other], limit)
            if depth > limit:
                found.append((owners[one], owners[other], depth))
    return found


@numba.njit(cache=True, nogil=True)
def _depth(one: FloatArray, other: FloatArray, limit: float) -> float:
    """How deep two boxes are inside each other; something up to `limit` if it is not more than that."""
    depth: float = one[5] + other[5] - abs(one[2] - other[2])
    dx, dy = other[0] - one[0], other[1] - one[1]
    depth = min(depth, one[8] + other[8] - abs(dx), one[9] + other[9] - abs(dy))
    if depth <= limit:
        return depth
    for axis in range(4):
        cosine, sine = (one[6], one[7]) if axis < 2 else (other[6], other[7])
        if axis % 2 == 1:
            cosine, sine = -sine, cosine
        depth = min(
            depth, _span(one, cosine, sine) + _span(other, cosine, sine) - abs(cosine * dx + sine * dy)
        )
    return depth


@numba.njit(cache=True, nogil=True)
def _span(box: FloatArray, cosine: float, sine: float) -> float:
    """Half the extent of a box on the floor plan along a direction."""
    along = abs(box[6] * cosine + box[7] * sine)
    across = abs(box[6] * sine - box[7] * cosine)
    span: float = box[3] * along + box[4] * across
    return span
