"""Putting furniture on the floor of one room, after ProcTHOR's habits.

Again and again: a free rectangle, mostly the largest; a place in it (a corner of the room, an edge, the
middle); and a group or a single piece that is usual in such rooms, stands at such places and fits. What
would be in the way of robots is taken back.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from adhoc.houses.facts_furniture import GroupFacts
from adhoc.houses.floor_plan import Rectangle
from adhoc.houses.generation.anchors import Anchor, draw_anchor
from adhoc.houses.generation.bedside import bedside_places
from adhoc.houses.generation.floor_space import FloorSpace
from adhoc.houses.generation.furniture_choice import FurnitureChoice
from adhoc.houses.generation.furniture_groups import Arrangement
from adhoc.houses.generation.pieces import Piece, rotated
from adhoc.houses.generation.walkways import Walkways
from adhoc.houses.house import Room

LARGEST_RECTANGLE = 0.8
"""Probability of the largest free rectangle; else one is drawn by area (ProcTHOR's number, like the next)."""
SMALLEST_SIDE = 0.5

LEAST_WAY = 0.25
"""Share of a room's cells that robots must still reach. Our own, like the next four."""
REACH, CHAIR_REACH = 0.7, 1.1
"""Metres within which robots must come to every piece; chairs may stand behind their tables."""
OPEN_IN_FRONT = frozenset({"Fridge", "Dresser", "ShelvingUnit", "TVStand", "Sofa", "ArmChair"})
"""What robots must come in front of, since it holds things that are seen from there only..."""
AHEAD = 0.65
"""... namely to within REACH of a point so many metres before it."""


@dataclass(frozen=True)
class Placed:
    """A piece with the number of the piece that carries it, in the order of placing; None for the floor.

    `sway` is by how many degrees it shall be turned askew once everything stands.
    """

    piece: Piece
    on: int | None
    sway: float = 0.0


class RoomFurnishing:
    """Furnishes one room.

    Args:
        room: the room.
        walkways: of the whole house; furniture is added to its obstacles.
        kept_free: rectangles of the floor where nothing may stand.
        generator: the random numbers.

    Attributes:
        placed: what stands in the room, each piece before what it carries.
    """

    def __init__(
        self, room: Room, walkways: Walkways, kept_free: Sequence[Rectangle], generator: Generator
    ) -> None:
        self.placed: list[Placed] = []
        self._polygon = room.polygon
        self._walkways = walkways
        self._generator = generator
        self._space = FloorSpace(room.polygon)
        for rectangle in kept_free:
            self._space.take(rectangle)
        self._choice = FurnitureChoice(room.room_type, generator)
        self._near: list[Rectangle] = []

    def run(self, tries: int) -> None:
        """Try so many times to put up a piece or a group."""
        rectangles: NDArray[np.float64] | None = None
        for _ in range(tries):
            if rectangles is None:
                rectangles = self._space.free_rectangles()
            index = self._draw_rectangle(rectangles)
            if index is None:
                return
            x0, y0, x1, y1 = rectangles[index].tolist()
            rectangles = None if self._fill((x0, y0, x1, y1)) else np.delete(rectangles, index, axis=0)

    def _draw_rectangle(self, rectangles: NDArray[np.float64]) -> int | None:
        sides = rectangles[:, 2:] - rectangles[:, :2]
        areas = sides[:, 0] * sides[:, 1]
        if len(areas) == 0:
            return None
        if self._generator.random() < LARGEST_RECTANGLE:
            return int(areas.argmax())
        sums = np.cumsum(np.where(sides.min(axis=1) >= SMALLEST_SIDE, areas, 0.0))
        if sums[-1] == 0:
            return None
        drawn = np.searchsorted(sums, self._generator.random() * sums[-1], side="right")
        return int(min(drawn, len(sums) - 1))

    def _fill(self, rectangle: Rectangle) -> bool:
        """Put something into a free rectangle; whether it succeeded."""
        anchor = draw_anchor(self._polygon, rectangle, self._generator)
        chosen = self._choice.draw(rectangle, anchor)
        if chosen is None:
            return False
        arrangement, group = chosen
        turns = anchor.turns(arrangement.width, arrangement.depth, rectangle)
        if not turns:
            return False
        if self._put_beside_bed(arrangement):
            return True
        turn = turns[int(self._generator.integers(len(turns)))]
        return self._put(rectangle, anchor, arrangement, turn, group)

    def _put_beside_bed(self, arrangement: Arrangement) -> bool:
        """Put a side table up beside a bed; whether it is one and there is space."""
        standing = [entry.piece for entry in self.placed]
        places = bedside_places(arrangement, standing, self._polygon)
        free = [place for place in places if self._space.is_free(place[0])]
        for index in self._generator.permutation(len(free)).tolist():
            rectangle, anchor, turn = free[index]
            if self._put(rectangle, anchor, arrangement, turn, None):
                return True
        return False

    def _put(
        self,
        rectangle: Rectangle,
        anchor: Anchor,
        arrangement: Arrangement,
        turn: int,
        group: GroupFacts | None,
    ) -> bool:
        width, depth = arrangement.extent(turn)
        x, y = anchor.middle(rectangle, (width, depth), self._generator)
        pieces = arrangement.placed(x, y, turn)
        on_floor = [piece for piece, on in zip(pieces, arrangement.carried) if on is None]
        in_the_way = [piece.rectangle for piece in pieces if piece in on_floor or not piece.facts.pickupable]
        for occupied in in_the_way:
            self._walkways.block(occupied)
        near = [*self._near, *(approach(piece) for piece in on_floor)]
        if not self._walkways.are_sound(LEAST_WAY, np.array(near), REACH):
            for occupied in in_the_way:
                self._walkways.unblock(occupied)
            return False
        self._near = near
        footprint = (x - width / 2, y - depth / 2, x + width / 2, y + depth / 2)
        self._space.take(anchor.with_margin(footprint, turn))
        first = len(self.placed)
        for piece, on, sway in zip(pieces, arrangement.carried, arrangement.sways):
            self.placed.append(Placed(piece, None if on is None else first + on, sway))
        self._choice.forget({piece.facts.category for piece in pieces}, group)
        return True


def approach(piece: Piece) -> Rectangle:
    """What a robot must come near to: the piece, or a point on the floor in front of it."""
    x0, y0, x1, y1 = piece.rectangle
    if piece.facts.category not in OPEN_IN_FRONT:
        more = CHAIR_REACH - REACH if piece.facts.category == "Chair" else 0.0
        return x0 - more, y0 - more, x1 + more, y1 + more
    ahead = piece.size[1] / 2 + AHEAD
    dx, dy = rotated(ahead * piece.front[0], ahead * piece.front[1], piece.askew)
    x, y = piece.x + dx, piece.y + dy
    return x, y, x, y
