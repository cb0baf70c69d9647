"""Turning furniture askew, as ProcTHOR does with chairs, lamps and plants in its groups."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from adhoc.houses.build import WALL_THICKNESS
from adhoc.houses.floor_plan import Rectangle, edges
from adhoc.houses.generation.furniture_groups import APART, meet
from adhoc.houses.generation.pieces import Bounds, Piece
from adhoc.houses.generation.room_furnishing import LEAST_WAY, REACH, Placed, approach
from adhoc.houses.generation.turned_boxes import (
    are_apart,
    bounding_row,
    rows_of,
    stacked_rows,
    turned_rows,
)
from adhoc.houses.generation.walkways import Walkways
from adhoc.houses.house import Room

SHARES = (1.0, -1.0, 2 / 3, -2 / 3, 1 / 3, -1 / 3)
"""Shares of the wanted angle that are tried one after the other. Our own."""

_HIGH = 100.0


def turned_askew(
    placed: Sequence[Placed], room: Room, walkways: Walkways, kept_free: Sequence[Rectangle]
) -> list[Placed]:
    """The furniture of a room with every piece turned by its sway, or by less, as far as there is space.

    A piece stays straight where every angle that is tried would bring it too close to something or would keep
    robots from coming everywhere.

    Args:
        placed: what stands in the room, all of it straight.
        room: the room.
        walkways: of the house; its obstacles turn with the furniture.
        kept_free: rectangles of the floor where nothing may stand.
    """
    turned = list(placed)
    rows = [rows_of(entry.piece) for entry in placed]
    bounds = [entry.piece.bounds for entry in placed]
    shell = turned_rows([*_walls(room), *((x0, y0, 0.0, x1, y1, _HIGH) for x0, y0, x1, y1 in kept_free)])
    for number, entry in enumerate(placed):
        angles = dict.fromkeys(round(share * entry.sway, 1) for share in SHARES)
        for angle in angles if entry.sway else ():
            piece = replace(entry.piece, askew=angle)
            own, around = rows_of(piece), piece.bounds
            close = [
                rows[other] for other in range(len(rows)) if other != number and meet(around, bounds[other])
            ]
            if not are_apart(own, stacked_rows(close), APART) or not are_apart(
                bounding_row(piece), shell, APART
            ):
                continue
            turned[number] = replace(entry, piece=piece)
            if _leaves_way(entry.piece, piece, turned, walkways):
                rows[number], bounds[number] = own, around
                break
            turned[number] = entry
    return turned


def _leaves_way(straight: Piece, piece: Piece, turned: Sequence[Placed], walkways: Walkways) -> bool:
    """Whether robots still come everywhere with the piece turned; if so, it is turned for them."""
    walkways.unblock(straight.rectangle)
    walkways.block(straight.rectangle, piece.askew)
    near = np.array([approach(entry.piece) for entry in turned if entry.on is None])
    if walkways.are_sound(LEAST_WAY, near, REACH):
        return True
    walkways.unblock(straight.rectangle, piece.askew)
    walkways.block(straight.rectangle)
    return False


def _walls(room: Room) -> list[Bounds]:
    """Boxes along the outline of the room, as thick as walls."""
    half = WALL_THICKNESS / 2
    return [
        (min(ax, bx) - half, min(ay, by) - half, 0.0, max(ax, bx) + half, max(ay, by) + half, _HIGH)
        for (ax, ay), (bx, by) in edges(room.polygon)
    ]
