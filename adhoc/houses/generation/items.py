"""Laying items on and into the furniture of a room, by ProcTHOR's statistics and habits."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from adhoc.houses import facts
from adhoc.houses.facts import AssetFacts
from adhoc.houses.facts_furniture import standing
from adhoc.houses.floor_plan import Rectangle
from adhoc.houses.generation.pieces import RESTING_GAP, Bounds, Piece, Support
from adhoc.houses.generation.room_furnishing import Placed
from adhoc.houses.generation.sight_lines import is_in_view
from adhoc.houses.generation.turned_boxes import COLUMNS, bounding_row, rows_of, stacked_rows, turned_rows

PARENT_BIAS = 0.2
PARENT_BIASES: Mapping[str, float] = {"Chair": 0.0, "ArmChair": 0.0, "ShelvingUnit": 0.4}
"""Added to the probability of everything that a receptacle of that type may hold."""
CHILD_BIASES: Mapping[str, float] = {
    "HousePlant": 0.25,
    "SprayBottle": 0.2,
    "Pot": 0.1,
    "Pan": 0.1,
    "Bowl": 0.05,
    "BaseballBat": 0.1,
}
"""Added to the probability of every object of that type. (ProcTHOR lists `Basketball` too, which no type
is called.)"""
HOUSE_BIAS = (-0.3, 0.1, 3.5, 1.9)
"""Limits of a house's own bias, and the parameters of the beta distribution that it is drawn from."""
MOST_OF_A_TYPE = 3
"""Objects of one type on one receptacle."""
TALLEST_PLANT = 0.75
"""Metres. Taller plants stand on the floor only."""
LYING_BATS = 0.97
"""Share of baseball bats that lie."""

LAID = 0.95
LAID_BY_PARENT: Mapping[str, float] = {
    "ArmChair": 0.5,
    "Chair": 0.4,
    "Desk": 0.8,
    "Fridge": 0.78,
    "ShelvingUnit": 0.75,
    "SideTable": 0.78,
    "Sofa": 0.75,
    "Stool": 0.2,
}
"""Share of items that get laid at all, by type of receptacle, where ProcTHOR's physics drops the rest: items
per piece in 500 real one-room houses over those that this module would lay otherwise."""
LAID_BULKY = 0.7
"""The same for lamps, plants and kitchen appliances, and for pillows on seats: they are large, so that
ProcTHOR's physics drops more of them."""

INSIDE_ONLY = frozenset({"Fridge"})
"""What holds things inside and never on top, as in real houses."""
ON_TOP = 0.6
ON_TOP_BY_PARENT: Mapping[str, float] = {"Desk": 0.7, "ShelvingUnit": 0.2, "SideTable": 0.72, "TVStand": 0.5}
"""Share of items that are laid on top of furniture that also has places inside, by type of receptacle, as in
real houses. Our own, like the next three."""
TRIES, TRIES_ON_A_SIDE = 24, 16
"""Places that are tried for one item, and how many of them on the side (on top, inside) that was drawn."""
APART = 0.005
HEADROOM = 0.01
"""Metres that stay free beside and above an item."""


@dataclass(frozen=True)
class _Wish:
    """A type that a receptacle (by its number) shall hold, with its probability."""

    receptacle: int
    category: str
    probability: float


def draw_house_bias(generator: Generator) -> float:
    """How full or empty the receptacles of a house are."""
    low, high, a, b = HOUSE_BIAS
    return round(low + (high - low) * float(generator.beta(a, b)), 4)


class ItemLaying:
    """Lays items in one room.

    Args:
        room_type: of the room.
        placed: what stands in the room; what is laid is appended.
        hung: what hangs on its walls.
        cells: (n, 2) places of robots.
        generator: the random numbers.
    """

    def __init__(
        self,
        room_type: str,
        placed: list[Placed],
        hung: Sequence[Piece],
        cells: NDArray[np.float64],
        generator: Generator,
    ) -> None:
        self._room_type = room_type
        self._placed = placed
        self._cells = cells
        self._generator = generator
        self._hung = [piece.bounds for piece in hung]
        self._lying: dict[int, list[Bounds]] = {}
        rows = stacked_rows([*(rows_of(entry.piece) for entry in placed), turned_rows(self._hung)])
        self._boxes = np.concatenate([rows, np.empty((256, COLUMNS))])
        self._count = len(rows)
        for entry in placed:
            if entry.on is not None:
                self._lying.setdefault(entry.on, []).extend(entry.piece.boxes())

    def run(self, house_bias: float) -> None:
        """Draw what every receptacle of the room shall hold, and lay it where there is a place for it."""
        wishes = self._wishes(house_bias)
        for index in self._generator.permutation(len(wishes)):
            wish = wishes[int(index)]
            for _ in range(self._draw_number(wish.probability)):
                if not standing(wish.category).multiple and self._has(wish.category):
                    break
                if self._generator.random() < self._share_laid(wish):
                    self._lay(wish)
        self._drop_unseen()

    def _wishes(self, house_bias: float) -> list[_Wish]:
        wishes = []
        for number, entry in enumerate(self._placed):
            if entry.on is None:
                holder = entry.piece.facts.category
                for category, probability, bias in _contents(holder, self._room_type):
                    if self._generator.random() <= probability + bias + house_bias:
                        wishes.append(_Wish(number, category, probability))
        return wishes

    def _draw_number(self, probability: float) -> int:
        number = 1
        while number < MOST_OF_A_TYPE and self._generator.random() <= probability:
            number += 1
        return number

    def _has(self, category: str) -> bool:
        return any(entry.piece.facts.category == category for entry in self._placed)

    def _share_laid(self, wish: _Wish) -> float:
        holder = self._placed[wish.receptacle].piece.facts.category
        share = LAID_BY_PARENT.get(holder, LAID)
        bulky = not facts.category_facts(wish.category).pickupable
        return share * LAID_BULKY if bulky or (wish.category == "Pillow" and holder != "Bed") else share

    def _lay(self, wish: _Wish) -> None:
        assets = _assets(wish.category)
        entry = assets[int(self._generator.integers(len(assets)))]
        size = entry.size
        if wish.category == "BaseballBat" and self._generator.random() < LYING_BATS:
            size = (size[0], size[2], size[1])
        standing_holder = self._placed[wish.receptacle].piece
        holder = standing_holder.straight()
        supports = [part for part in holder.supports() if part.clearance > size[2] + RESTING_GAP + HEADROOM]
        if holder.facts.category in INSIDE_ONLY:
            supports = [part for part in supports if part.clearance < math.inf]
        if not supports:
            return
        sides = self._drawn_sides(supports, ON_TOP_BY_PARENT.get(holder.facts.category, ON_TOP))
        covers = self._covers(wish.receptacle)
        own = holder.boxes()
        others = self._lying.setdefault(wish.receptacle, [])
        for side in sides:
            draws = self._generator.random(4)
            areas = np.cumsum([(part.x1 - part.x0) * (part.y1 - part.y0) for part in side])
            part = side[min(int(np.searchsorted(areas, draws[0] * areas[-1])), len(side) - 1)]
            unplaced = Piece(entry, 0.0, 0.0, round(part.z + RESTING_GAP, 6), int(draws[1] * 4), size)
            piece = _somewhere(unplaced, part, draws[2], draws[3])
            if piece is None or any(_overlap(piece.bounds, box) for box in own):
                continue
            piece = piece.turned_with(standing_holder)
            bounds = piece.bounds
            if not self._is_clear(bounds, covers, others):
                continue
            if not is_in_view(np.array(bounds), self._cells, self._boxes[: self._count]):
                continue
            others.append(bounds)
            self._placed.append(Placed(piece, wish.receptacle))
            self._add_box(bounding_row(piece))
            return

    def _drop_unseen(self) -> None:
        """Take away items that others have come to hide."""
        boxes = self._boxes[: self._count]
        kept = []
        for entry in self._placed:
            if entry.piece.facts.pickupable:
                others = boxes[(np.abs(boxes - bounding_row(entry.piece)) > 1e-9).any(axis=1)]
                if not is_in_view(np.array(entry.piece.bounds), self._cells, others):
                    continue
            kept.append(entry)
        # No item carries another, so numbers of receptacles only have to follow the removed ones.
        renumbered = {id(entry): number for number, entry in enumerate(kept)}
        self._placed[:] = [
            entry if entry.on is None else Placed(entry.piece, renumbered[id(self._placed[entry.on])])
            for entry in kept
        ]

    def _drawn_sides(self, supports: list[Support], share_on_top: float) -> list[list[Support]]:
        """What to choose from at every try: the surfaces on top or those inside, then the others."""
        top = [part for part in supports if part.clearance == math.inf]
        inside = [part for part in supports if part.clearance < math.inf]
        if not top or not inside:
            return [supports] * TRIES
        first, second = (top, inside) if self._generator.random() < share_on_top else (inside, top)
        return [first] * TRIES_ON_A_SIDE + [second] * (TRIES - TRIES_ON_A_SIDE)

    def _covers(self, receptacle: int) -> list[Rectangle]:
        """Footprints of other furniture that reaches over the receptacle, like a table over its chairs."""
        x0, y0, x1, y1 = self._placed[receptacle].piece.rectangle
        return [
            (ax0, ay0, ax1, ay1)
            for number, entry in enumerate(self._placed)
            if entry.on is None and number != receptacle
            for ax0, ay0, ax1, ay1 in [entry.piece.rectangle]
            if ax0 < x1 and x0 < ax1 and ay0 < y1 and y0 < ay1
        ]

    def _is_clear(self, bounds: Bounds, covers: Sequence[Rectangle], others: Sequence[Bounds]) -> bool:
        x0, y0, z0, x1, y1, z1 = bounds
        for ax0, ay0, ax1, ay1 in covers:
            if ax0 < x1 + APART and x0 < ax1 + APART and ay0 < y1 + APART and y0 < ay1 + APART:
                return False
        for ax0, ay0, az0, ax1, ay1, az1 in (*others, *self._hung):
            if (
                ax0 < x1 + APART
                and x0 < ax1 + APART
                and ay0 < y1 + APART
                and y0 < ay1 + APART
                and az0 < z1 + APART
                and z0 < az1 + APART
            ):
                return False
        return True

    def _add_box(self, row: NDArray[np.float64]) -> None:
        if self._count == len(self._boxes):
            self._boxes = np.concatenate([self._boxes, np.empty((256, COLUMNS))])
        self._boxes[self._count] = row
        self._count += 1


def _overlap(one: Bounds, other: Bounds) -> bool:
    return all(one[k] < other[k + 3] and other[k] < one[k + 3] for k in range(3))


def _somewhere(piece: Piece, part: Support, first: float, second: float) -> Piece | None:
    """The piece somewhere on a surface; None if it is too large for it."""
    width, depth = piece.extent
    slack_x, slack_y = part.x1 - part.x0 - width - 0.002, part.y1 - part.y0 - depth - 0.002
    if slack_x < 0 or slack_y < 0:
        return None
    return replace(
        piece,
        x=round(part.x0 + 0.001 + width / 2 + first * slack_x, 3),
        y=round(part.y0 + 0.001 + depth / 2 + second * slack_y, 3),
    )


@cache
def _contents(holder: str, room_type: str) -> tuple[tuple[str, float, float], ...]:
    """What such a receptacle may hold in such a room: type, probability, and bias without the house's."""
    if not facts.category_facts(holder).is_receptacle:
        return ()
    bias = PARENT_BIASES.get(holder, PARENT_BIAS)
    return tuple(
        (category, facts.receptacle_probability(holder, category), bias + CHILD_BIASES.get(category, 0.0))
        for category in facts.categories()
        if facts.is_reasonable(category, holder, room_type) and not standing(category).fixed
    )


@cache
def _assets(category: str) -> tuple[AssetFacts, ...]:
    entries = tuple(facts.asset(name) for name in facts.assets_of(category))
    if category == "HousePlant":
        return tuple(entry for entry in entries if entry.size[2] < TALLEST_PLANT)
    return entries
