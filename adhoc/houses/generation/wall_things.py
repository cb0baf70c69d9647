"""Hanging televisions and paintings on the walls of a room, after ProcTHOR's habits and numbers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from adhoc.houses import facts
from adhoc.houses.floor_plan import edges
from adhoc.houses.generation.pieces import DIGITS, Piece, drawn
from adhoc.houses.generation.sight_lines import is_in_view
from adhoc.houses.generation.turned_boxes import rows_of, stacked_rows
from adhoc.houses.house import Corner, Opening, Room

WALL_TELEVISIONS = (
    "Television_14",
    "Television_16",
    "Television_25",
    "Television_27",
    "Television_3",
    "Television_9",
)
TELEVISION_PROBABILITY = {"LivingRoom": 0.8, "Kitchen": 0.25, "Bedroom": 0.4}
"""Probability of a television on a wall of a room that has none otherwise."""
PAINTINGS = ((0, 0.05), (1, 0.1), (2, 0.5), (3, 0.25), (4, 0.1))
"""How many paintings a room gets where they fit, with probabilities."""
OFF_WALL = 0.012
"""Metres between a hanging thing and the middle line of its wall. ProcTHOR has 5 mm; walls are 10 mm thick
to either side here, and nothing hangs in them."""
TALL = 1.15
"""Nothing hangs above furniture of this height in metres."""
HIGHEST = 3.0
"""Walls count as if they ended here, in metres."""
HEIGHT_SHAPE = 12.0
"""Both parameters of the beta distribution of heights."""
BESIDE = 0.01
"""Metres that stay free beside doors, windows and other hanging things. Our own, like the next two."""
ABOVE = 0.03
NEAR_WALL = 0.12
"""Furniture within so many metres of a wall's middle line counts as standing at it."""
TRIES = 3
"""How often a place is drawn for one thing."""


@dataclass(frozen=True)
class _Stretch:
    """A free stretch of wall: axis 0 if it runs along x, the interval on it, the coordinate across it, and
    the direction of the room as seen from it."""

    axis: int
    low: float
    high: float
    across: float
    inward: int


def hang_things(
    room: Room,
    openings: Iterable[Opening],
    height: float,
    standing: Sequence[Piece],
    cells: NDArray[np.float64],
    used: set[str],
    generator: Generator,
) -> list[Piece]:
    """What hangs on the walls of a room.

    Args:
        room: the room.
        openings: the openings of the house.
        height: of the ceiling.
        standing: the furniture of the room.
        cells: (n, 2) places of robots.
        used: paintings that the house has already; those that are hung are added.
        generator: the random numbers.
    """
    stretches = _free_stretches(room, openings, standing)
    hung: list[Piece] = []
    boxes = stacked_rows(rows_of(piece) for piece in standing)
    has_television = any(piece.facts.category == "Television" for piece in standing)
    probability = TELEVISION_PROBABILITY.get(room.room_type, 0.0)
    if generator.random() < probability and not has_television:
        _hang(WALL_TELEVISIONS, stretches, height, standing, cells, boxes, hung, generator)
    for _ in range(drawn(PAINTINGS, generator)):
        candidates = [name for name in facts.assets_of("Painting") if name not in used]
        _hang(candidates, stretches, height, standing, cells, boxes, hung, generator)
        used.update(piece.facts.asset for piece in hung)
    return hung


def _hang(
    candidates: Sequence[str],
    stretches: list[_Stretch],
    height: float,
    standing: Sequence[Piece],
    cells: NDArray[np.float64],
    boxes: NDArray[np.float64],
    hung: list[Piece],
    generator: Generator,
) -> None:
    """Hang one of the assets on one of the stretches, and cut what it covers out of them."""
    for _ in range(TRIES):
        if _try_to_hang(candidates, stretches, height, standing, cells, boxes, hung, generator):
            return


def _try_to_hang(
    candidates: Sequence[str],
    stretches: list[_Stretch],
    height: float,
    standing: Sequence[Piece],
    cells: NDArray[np.float64],
    boxes: NDArray[np.float64],
    hung: list[Piece],
    generator: Generator,
) -> bool:
    widths = [facts.asset(name).size[0] for name in candidates]
    wide = [part for part in stretches if widths and part.high - part.low > min(widths)]
    if not wide:
        return False
    lengths = np.cumsum([part.high - part.low for part in wide])
    part = wide[min(int(np.searchsorted(lengths, generator.random() * lengths[-1])), len(wide) - 1)]
    fitting = [name for name, width in zip(candidates, widths) if width < part.high - part.low]
    entry = facts.asset(fitting[int(generator.integers(len(fitting)))])
    width, depth, own_height = entry.size
    start = part.low + float(generator.random()) * (part.high - part.low - width)
    middle = round(start + width / 2, 3)
    share = round(float(generator.beta(HEIGHT_SHAPE, HEIGHT_SHAPE)), 3)
    across = round(part.across + part.inward * (OFF_WALL + depth / 2), DIGITS)
    turn = (0 if part.inward > 0 else 2) if part.axis == 0 else (3 if part.inward > 0 else 1)
    x, y = (middle, across) if part.axis == 0 else (across, middle)
    piece = Piece(entry, x, y, 0.0, turn, entry.size)
    lowest = max((_top(other) for other in standing if _meet(piece, other)), default=0.0)
    room_above = min(HIGHEST, height) - lowest - own_height
    if room_above < ABOVE + 0.01:
        return False
    bottom = round(lowest + max(ABOVE, share * room_above), 3)
    piece = Piece(entry, x, y, bottom, turn, entry.size)
    if not is_in_view(np.array(piece.bounds), cells, boxes):
        return False
    hung.append(piece)
    stretches.remove(part)
    ends = ((part.low, middle - width / 2 - BESIDE), (middle + width / 2 + BESIDE, part.high))
    stretches.extend(_Stretch(part.axis, *end, part.across, part.inward) for end in ends if end[1] > end[0])
    return True


def _top(piece: Piece) -> float:
    return piece.bottom + piece.size[2]


def _meet(hanging: Piece, other: Piece) -> bool:
    """Whether something stands below or before it, at its wall."""
    ax0, ay0, ax1, ay1 = hanging.rectangle
    bx0, by0, bx1, by1 = other.rectangle
    return ax0 < bx1 + BESIDE and bx0 < ax1 + BESIDE and ay0 < by1 + BESIDE and by0 < ay1 + BESIDE


def _free_stretches(room: Room, openings: Iterable[Opening], standing: Sequence[Piece]) -> list[_Stretch]:
    holes = [hole for hole in openings if room.id in hole.rooms]
    tall = [piece for piece in standing if _top(piece) >= TALL]
    area = sum(ax * by - bx * ay for (ax, ay), (bx, by) in edges(room.polygon))
    stretches = []
    for start, end in edges(room.polygon):
        axis = 0 if start[1] == end[1] else 1
        across = start[1 - axis]
        forward = end[axis] > start[axis]
        inward = 1 if (area > 0) == (forward == (axis == 0)) else -1
        low, high = sorted((start[axis], end[axis]))
        covered = [_on_line(hole.start, hole.end, axis) for hole in holes if _lies_on(hole, axis, across)]
        for piece in tall:
            x0, y0, x1, y1 = piece.rectangle
            spans = ((x0, x1), (y0, y1))
            if spans[1 - axis][0] - NEAR_WALL < across < spans[1 - axis][1] + NEAR_WALL:
                covered.append(spans[axis])
        free = [(low + 0.05, high - 0.05)]
        for left, right in covered:
            free = [
                part
                for a, b in free
                for part in ((a, min(b, left - BESIDE)), (max(a, right + BESIDE), b))
                if part[1] > part[0]
            ]
        stretches += [_Stretch(axis, a, b, across, inward) for a, b in free]
    return stretches


def _on_line(start: Corner, end: Corner, axis: int) -> tuple[float, float]:
    return min(start[axis], end[axis]), max(start[axis], end[axis])


def _lies_on(hole: Opening, axis: int, across: float) -> bool:
    return abs(hole.start[1 - axis] - across) < 1e-3 and abs(hole.end[1 - axis] - across) < 1e-3
