"""Arranging a group of furniture: which assets, and where each stands in the frame of the group."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

from numpy.random import Generator

from adhoc.houses import facts
from adhoc.houses.facts import AssetFacts
from adhoc.houses.facts_furniture import GroupFacts, Member
from adhoc.houses.floor_plan import Rectangle
from adhoc.houses.generation.pieces import RESTING_GAP, Bounds, Piece, turned

RETRIES = 5
"""How often assets are drawn anew for a group whose members would cut each other (ProcTHOR's number)."""

PUSH, MOST_PUSHES = 0.05, 6
"""Metres of a step, and the most steps, by which a chair is drawn back from a table that it would cut."""

APART = 0.005
"""Metres that stay free between two pieces."""

OUTSIZED = frozenset(
    {
        "Armchair_202_1",
        "Armchair_203_1",
        "Armchair_208_5",
        "Armchair_217_1",
        "Dining_Table_204_1",
        "Dining_Table_230_1",
        "TV_Stand_206_2",
    }
)
"""What is larger than all of its kind in ProcTHOR's training split, by its asset database. ProcTHOR offers a
group where it would fit with the largest assets of a split; these are not counted, though they are drawn."""


@dataclass(frozen=True)
class Arrangement:
    """The pieces of a group; the middle of the group's footprint is the origin, its front faces +y.

    `carried` says on which piece (by position) one stands, None for those on the floor. All stand along the
    axes; `sways` says by how many degrees each shall be turned askew once everything stands.
    """

    pieces: tuple[Piece, ...]
    carried: tuple[int | None, ...]
    width: float
    depth: float
    sways: tuple[float, ...]

    def extent(self, turn: int) -> tuple[float, float]:
        """Its extents along x and y after so many quarter turns."""
        return (self.depth, self.width) if turn % 2 else (self.width, self.depth)

    def placed(self, x: float, y: float, turn: int) -> tuple[Piece, ...]:
        """Its pieces when the group stands at (x, y), turned by quarter turns."""
        pieces = []
        for piece in self.pieces:
            dx, dy = turned(piece.x, piece.y, turn)
            pieces.append(replace(piece, x=x + dx, y=y + dy, turn=(piece.turn + turn) % 4))
        return tuple(pieces)


def single(asset_id: str, lying: bool = False) -> Arrangement:
    """One piece by itself; `lying` tilts it to its right side, as a reader of houses tilts."""
    entry = facts.asset(asset_id)
    width, depth, height = entry.size
    size = (height, depth, width) if lying else entry.size
    return Arrangement((Piece(entry, 0.0, 0.0, 0.0, 0, size),), (None,), size[0], size[1], (0.0,))


def arrange(group: GroupFacts, generator: Generator) -> Arrangement | None:
    """The group with assets that are drawn; None if its members cut each other every time."""
    for _ in range(RETRIES):
        chosen: dict[str, str] = {}
        for member in group.members:
            if member.name not in chosen:
                chosen[member.name] = member.assets[int(generator.integers(len(member.assets)))]
        turns, sways = zip(*(_drawn_turn(member, generator) for member in group.members))
        pieces = _settled(group, _raw(group, chosen, turns))
        if pieces is not None:
            return _centred(group, pieces, sways)
    return None


@cache
def largest_size(group: GroupFacts) -> tuple[float, float]:
    """Width and depth of the group with its broadest and with its deepest assets, but for `OUTSIZED` ones."""
    turns = [round(member.turn / 90) % 4 for member in group.members]
    extents = []
    for axis in (0, 1):
        chosen = {
            member.name: max(
                (name for name in member.assets if name not in OUTSIZED),
                key=lambda name: facts.asset(name).size[axis],
            )
            for member in group.members
        }
        arrangement = _centred(group, _raw(group, chosen, turns), [0.0] * len(turns))
        extents.append((arrangement.width, arrangement.depth)[axis])
    return extents[0], extents[1]


def _drawn_turn(member: Member, generator: Generator) -> tuple[int, float]:
    """An angle within the member's sway: the nearest quarter turns, and the degrees from there."""
    sway = round(float(generator.uniform(-member.sway, member.sway)), 1) if member.sway else 0.0
    quarters = round((member.turn + sway) / 90)
    return quarters % 4, round(member.turn + sway - 90 * quarters, 1)


def _raw(group: GroupFacts, chosen: Mapping[str, str], turns: Sequence[int]) -> list[Piece]:
    """The members where the group's facts put them, in the frame of the first."""
    pieces: list[Piece] = []
    for member, turn in zip(group.members, turns):
        entry = facts.asset(chosen[member.name])
        piece = Piece(entry, 0.0, 0.0, 0.0, turn, entry.size)
        if member.parent is not None:
            parent = pieces[member.parent]
            x, y = (
                middle + side * reach / 2 + offset + align * own / 2
                for middle, side, reach, offset, align, own in zip(
                    (parent.x, parent.y),
                    member.side,
                    parent.extent,
                    member.offset,
                    member.align,
                    piece.extent,
                )
            )
            bottom = _top(parent, entry) if member.above else 0.0
            piece = replace(piece, x=round(x, 3), y=round(y, 3), bottom=bottom)
        pieces.append(piece)
    return pieces


def _top(parent: Piece, on_top: AssetFacts) -> float:
    """Height of what is put on a piece: items lie on its surface, the rest stands on its highest part."""
    heights = [support.z for support in parent.supports()] if on_top.pickupable else []
    return max(heights, default=parent.bottom + parent.size[2]) + RESTING_GAP


def _settled(group: GroupFacts, pieces: list[Piece]) -> list[Piece] | None:
    """The pieces with chairs drawn back so far that nothing cuts; None if something still does."""
    settled: list[Piece] = []
    for member, piece in zip(group.members, pieces):
        if member.above:
            if piece.facts.pickupable and not _lies_well(piece, settled, member.parent):
                return None
            settled.append(piece)
            continue
        others = [other for other, fellow in zip(settled, group.members) if not fellow.above]
        for _ in range(MOST_PUSHES + 1):
            if not any(_cut(piece, other) for other in others):
                break
            if piece.facts.category != "Chair":
                return None
            dx, dy = piece.front
            piece = replace(piece, x=round(piece.x - PUSH * dx, 3), y=round(piece.y - PUSH * dy, 3))
        else:
            return None
        settled.append(piece)
    return settled


def _lies_well(item: Piece, settled: Sequence[Piece], parent: int | None) -> bool:
    """Whether an item lies wholly on its parent, clear of what lies there already."""
    x0, y0, x1, y1 = item.rectangle
    on_surface = any(
        s.x0 <= x0
        and s.y0 <= y0
        and x1 <= s.x1
        and y1 <= s.y1
        and abs(s.z + RESTING_GAP - item.bottom) < 1e-9
        for s in settled[parent or 0].supports()
    )
    items = [other for other in settled if other.facts.pickupable]
    return on_surface and not any(meet(item.bounds, other.bounds) for other in items)


def _cut(first: Piece, second: Piece) -> bool:
    if not meet(first.bounds, second.bounds):
        return False
    return any(meet(one, other) for one in first.boxes() for other in second.boxes())


def meet(one: Bounds, other: Bounds) -> bool:
    """Whether two boxes overlap or are less than `APART` from each other."""
    return all(one[k] < other[k + 3] + APART and other[k] < one[k + 3] + APART for k in range(3))


def _centred(group: GroupFacts, pieces: Sequence[Piece], sways: Sequence[float]) -> Arrangement:
    swayed = [replace(piece, askew=sway) for piece, sway in zip(pieces, sways)]
    x0, y0, x1, y1 = hull([piece.rectangle for piece in swayed])
    x, y = (x0 + x1) / 2, (y0 + y1) / 2
    moved = tuple(replace(piece, x=piece.x - x, y=piece.y - y) for piece in pieces)
    carried = tuple(member.parent if member.above else None for member in group.members)
    return Arrangement(moved, carried, x1 - x0, y1 - y0, tuple(sways))


def hull(rectangles: Sequence[Rectangle]) -> Rectangle:
    """The smallest rectangle around several."""
    x0, y0, x1, y1 = zip(*rectangles)
    return min(x0), min(y0), max(x1), max(y1)
