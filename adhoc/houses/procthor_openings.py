"""Doors, windows and left-out walls of ProcTHOR house JSON, cut into the merged walls."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from adhoc.core.errors import HouseError
from adhoc.houses.house import Corner, Opening, Room, Wall
from adhoc.houses.json_fields import Fields
from adhoc.houses.wall_merging import TOLERANCE, Stretch, WallSide

KINDS = {"doors": "door", "windows": "window"}
CORNER_DIGITS = 9
"""Decimals of a hole's ends that are kept: a nanometre."""


def parse_openings(house: Fields, rooms: Sequence[Room], sides: Sequence[WallSide]) -> tuple[Opening, ...]:
    """The doors and windows, in file order, placed on the floor plan.

    A hole runs along its first wall from that wall's first ground point. A door between two rooms counts
    as open, since none of the paper's actions opens a door; a door to the outside is closed. Raises
    HouseError if a hole has no wall, no size, or does not fit into its wall.
    """
    room_ids = {room.id for room in rooms}
    by_id = {side.id: side for side in sides}
    return tuple(
        _parse_opening(fields, kind, room_ids, by_id)
        for name, kind in KINDS.items()
        for fields in house.items(name)
    )


def assemble_walls(
    stretches: Sequence[Stretch], openings: Sequence[Opening], source: str
) -> tuple[tuple[Wall, ...], tuple[Opening, ...]]:
    """The walls with their openings, and the openings where two rooms have no wall between them.

    Raises HouseError if an opening lies on no wall, or over another opening of its wall.
    """
    holes: dict[Stretch, list[Opening]] = {}
    for opening in openings:
        holes.setdefault(_stretch_of(opening, stretches, source), []).append(opening)
    walls = []
    for stretch in stretches:
        if not stretch.empty:
            own = sorted(holes.get(stretch, ()), key=lambda hole: hole.start[stretch.axis])
            _check_apart(own, stretch.axis, source)
            wall_id = _name("wall", stretch)
            walls.append(Wall(wall_id, stretch.start, stretch.end, stretch.height, stretch.rooms, tuple(own)))
    return tuple(walls), tuple(_left_out(stretch) for stretch in stretches if stretch.empty)


def _parse_opening(fields: Fields, kind: str, room_ids: set[str], sides: dict[str, WallSide]) -> Opening:
    asset_id = fields.asset("assetId").asset
    rooms = fields.text("room0"), fields.text("room1")
    for name, room in zip(("room0", "room1"), rooms):
        if room not in room_ids:
            raise fields.error(name, "the id of a room")
    side = sides.get(fields.text("wall0"))
    if side is None:
        raise fields.error("wall0", "the id of a wall")
    low, high = _parse_hole(fields, side)
    start, end = sorted(_rounded(side.point(along)) for along in (low[0], high[0]))
    passable = kind == "door" and rooms[0] != rooms[1]
    return Opening(fields.text("id"), kind, rooms, start, end, low[1], high[1], passable, asset_id)


def _rounded(corner: Corner) -> Corner:
    """Free of the rounding errors of going along a wall, so that a house is read back exactly as written."""
    return round(corner[0], CORNER_DIGITS), round(corner[1], CORNER_DIGITS)


def _parse_hole(fields: Fields, side: WallSide) -> tuple[tuple[float, float], tuple[float, float]]:
    """(along the wall, above the floor) of the hole's lowest and highest corner."""
    corners = [(corner.number("x"), corner.number("y")) for corner in fields.items("holePolygon")]
    if len(corners) != 2:
        raise fields.error("holePolygon", "a list of two corners")
    low, high = corners
    if high[0] - low[0] < TOLERANCE or high[1] - low[1] < TOLERANCE:
        raise fields.error("holePolygon", f"its lowest and its highest corner, not {low} and {high}")
    length = side.high - side.low
    if low[0] < -TOLERANCE or high[0] > length + TOLERANCE:
        along = f"{low[0]:g} to {high[0]:g} m along it"
        raise fields.error("holePolygon", f"inside the wall {length:g} m long, not {along}")
    if low[1] < -TOLERANCE or high[1] > side.height + TOLERANCE:
        up = f"{low[1]:g} to {high[1]:g} m above the floor"
        raise fields.error("holePolygon", f"inside the wall {side.height:g} m high, not {up}")
    return (max(low[0], 0.0), max(low[1], 0.0)), (min(high[0], length), min(high[1], side.height))


def _stretch_of(opening: Opening, stretches: Sequence[Stretch], source: str) -> Stretch:
    for stretch in stretches:
        if not stretch.empty and stretch.holds(opening.start) and stretch.holds(opening.end):
            return stretch
    raise HouseError(f"{source}: {opening.kind} {opening.id!r} does not lie on one wall between its rooms")


def _check_apart(openings: list[Opening], axis: int, source: str) -> None:
    for first, second in pairwise(openings):
        beside = second.start[axis] >= first.end[axis] - TOLERANCE
        if not beside and first.bottom < second.top and second.bottom < first.top:
            raise HouseError(f"{source}: openings {first.id!r} and {second.id!r} overlap in one wall")


def _left_out(stretch: Stretch) -> Opening:
    rooms = (stretch.rooms[0], stretch.rooms[1])
    return Opening(
        _name("open", stretch), "open", rooms, stretch.start, stretch.end, 0.0, stretch.height, True
    )


def _name(kind: str, stretch: Stretch) -> str:
    (ax, ay), (bx, by) = stretch.start, stretch.end
    return f"{kind}|{ax:.2f}|{ay:.2f}|{bx:.2f}|{by:.2f}"
