"""Side tables beside beds.

A choice of our own: ProcTHOR has no such group, its side tables stand anywhere along walls. Here a side table
that a room gets anyway stands beside the head of a bed where there is space, so that rooms hold as many beds
and side tables as in ProcTHOR. A second one takes the other side.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from adhoc.houses.facts_furniture import EDGE
from adhoc.houses.floor_plan import Rectangle
from adhoc.houses.generation.anchors import BESIDE, FRONT, WALL_GAP, Anchor, lies_on_outline
from adhoc.houses.generation.furniture_groups import Arrangement
from adhoc.houses.generation.pieces import Piece, turned
from adhoc.houses.house import Corner

NEAREST, FARTHEST = 0.032, 0.048
"""Metres between a bed and the side table beside it."""

_MILLIMETRE = 3


def bedside_places(
    arrangement: Arrangement, standing: Iterable[Piece], outline: Sequence[Corner]
) -> list[tuple[Rectangle, Anchor, int]]:
    """Where a side table may stand left and right of the head of a bed, its back to the bed's wall.

    Each place is a rectangle, which need not be free; the wall that the table stands at; and how it is turned
    by quarters.

    Args:
        arrangement: what is to be put up; there are places only for a single side table.
        standing: the pieces in the room.
        outline: of the room.
    """
    if [piece.facts.category for piece in arrangement.pieces] != ["SideTable"]:
        return []
    places = []
    for bed in (piece for piece in standing if piece.facts.category == "Bed"):
        front_x, front_y = bed.front
        anchor = Anchor(EDGE, ((-front_x, -front_y),))
        for side in (-1, 1):
            near, far = _corners(arrangement, bed, side)
            # The rectangle's back goes from `near` to `end`; all of it has to be wall.
            end = (near[0], far[1]) if front_x else (far[0], near[1])
            if lies_on_outline(outline, near, end):
                (x0, x1), (y0, y1) = sorted((near[0], far[0])), sorted((near[1], far[1]))
                places.append(((x0, y0, x1, y1), anchor, bed.turn))
    return places


def _corners(arrangement: Arrangement, bed: Piece, side: int) -> tuple[Corner, Corner]:
    """The corner at the wall next to a bed, and the opposite one, of the place left (-1) or right of it."""
    near, far = NEAREST - BESIDE, FARTHEST + arrangement.width + BESIDE
    wall, front = -WALL_GAP, WALL_GAP + arrangement.depth + FRONT
    width, depth, _ = bed.size
    first = turned(side * (width / 2 + near), wall - depth / 2, bed.turn)
    second = turned(side * (width / 2 + far), front - depth / 2, bed.turn)
    return (
        (round(bed.x + first[0], _MILLIMETRE), round(bed.y + first[1], _MILLIMETRE)),
        (round(bed.x + second[0], _MILLIMETRE), round(bed.y + second[1], _MILLIMETRE)),
    )
