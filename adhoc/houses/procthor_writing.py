"""Writing houses as ProcTHOR house JSON, and raising the walls of a floor plan.

`houses.procthor` reads what is written here back as the same house.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from adhoc.houses import floor_plan
from adhoc.houses.facts import asset, wall_hole
from adhoc.houses.house import FLOOR, Corner, House, HouseObject, Opening, Room, Wall
from adhoc.houses.procthor_openings import assemble_walls
from adhoc.houses.wall_merging import WallSide, merge_walls

SCHEMA = "1.0.0"
DIGITS = 5
"""Decimals of written coordinates: a hundredth of a millimetre."""
DOOR_ASSET, WINDOW_ASSET = "Doorway_1", "Window_Fixed_60x36"
"""Written for a door or window whose asset the house does not say."""


def raise_walls(
    rooms: Sequence[Room],
    height: float,
    openings: Sequence[Opening] = (),
    open_between: Iterable[frozenset[str]] = (),
    source: str = "floor plan",
) -> tuple[tuple[Wall, ...], tuple[Opening, ...]]:
    """Walls of `height` metres on every edge of the rooms, and all openings of the house.

    `open_between` are pairs of rooms that have no wall between them. Raises HouseError if a door or window
    does not lie on one wall, or over another.
    """
    pairs = list(open_between)
    stretches = merge_walls(
        [
            WallSide(f"{room.id}|{index}", room.id, start, end, height, False)
            for room in rooms
            for index, (start, end) in enumerate(floor_plan.edges(room.polygon))
        ]
    )
    opened = [
        replace(stretch, empty=True) if frozenset(stretch.rooms) in pairs else stretch
        for stretch in stretches
    ]
    walls, left_out = assemble_walls(opened, openings, source)
    return walls, (*openings, *left_out)


def house_document(house: House) -> dict[str, Any]:
    """The house as a ProcTHOR JSON document: every shared wall once per side, children in their parents.

    Ids of walls, and of openings where a wall is left out, are derived anew from the floor plan on reading.
    """
    holes = [(wall, hole) for wall in house.walls for hole in wall.openings]
    return {
        "metadata": {"schema": SCHEMA, "houseId": house.id},
        "proceduralParameters": {},
        "rooms": [_room_document(room) for room in house.rooms],
        "walls": [side for run in _runs(house) for side in _wall_documents(*run)],
        "doors": [_hole_document(wall, hole) for wall, hole in holes if hole.kind == "door"],
        "windows": [_hole_document(wall, hole) for wall, hole in holes if hole.kind == "window"],
        "objects": [
            _object_document(thing, house) for thing in house.objects if thing.parent in (None, FLOOR)
        ],
    }


def _room_document(room: Room) -> dict[str, Any]:
    corners = [_point(x, y, 0.0) for x, y in room.polygon]
    return {
        "id": room.id,
        "roomType": room.room_type,
        "floorPolygon": corners,
        "ceilings": [],
        "children": [],
    }


Run = tuple[Corner, Corner, float, tuple[str, ...], bool]


def _runs(house: House) -> list[Run]:
    """Every wall and every left-out wall: start, end, height, rooms, empty."""
    left_out = [hole for hole in house.openings if hole.kind == "open"]
    return [
        *((wall.start, wall.end, wall.height, wall.rooms, False) for wall in house.walls),
        *((hole.start, hole.end, hole.top, hole.rooms, True) for hole in left_out),
    ]


def _wall_documents(
    start: Corner, end: Corner, height: float, rooms: tuple[str, ...], empty: bool
) -> list[dict[str, Any]]:
    low = [_point(*start, 0.0), _point(*end, 0.0)]
    high = [_point(*start, height), _point(*end, height)]
    documents: list[dict[str, Any]] = [
        {"id": _side_id(room, start, end), "roomId": room, "polygon": [*low, *high]} for room in rooms
    ]
    if len(rooms) == 1:
        outside = {"id": _side_id("exterior", start, end), "roomId": "exterior", "polygon": [*high, *low]}
        documents.append(outside)
    if empty:
        documents = [{**document, "empty": True} for document in documents]
    return documents


def _hole_document(wall: Wall, hole: Opening) -> dict[str, Any]:
    low, high = sorted(math.dist(wall.start, corner) for corner in (hole.start, hole.end))
    other = hole.rooms[1] if hole.rooms[0] != hole.rooms[1] else "exterior"
    document: dict[str, Any] = {
        "id": hole.id,
        "assetId": hole.asset or (DOOR_ASSET if hole.kind == "door" else WINDOW_ASSET),
        "room0": hole.rooms[0],
        "room1": hole.rooms[1],
        "wall0": _side_id(hole.rooms[0], wall.start, wall.end),
        "wall1": _side_id(other, wall.start, wall.end),
        "holePolygon": [_point(low, 0.0, hole.bottom), _point(high, 0.0, hole.top)],
        "assetPosition": _point((low + high) / 2, 0.0, (hole.bottom + hole.top) / 2),
    }
    if hole.kind == "door":
        document |= {"openable": hole.passable, "openness": int(hole.passable)}
    return document


def _object_document(thing: HouseObject, house: House) -> dict[str, Any]:
    document: dict[str, Any] = {
        "id": thing.id,
        "assetId": thing.asset,
        "position": _point(*thing.position),
        "rotation": _rotation(thing),
        "kinematic": not thing.pickupable,
    }
    children = [_object_document(child, house) for child in house.objects if child.parent == thing.id]
    return {**document, "children": children} if children else document


def _rotation(thing: HouseObject) -> dict[str, float]:
    """Unity's rotation in degrees: the yaw, and the quarter turns to the object's extents."""
    x, y, z = asset(thing.asset).size
    turns = {(x, y, z): (0.0, 0.0), (x, z, y): (90.0, 0.0), (z, y, x): (0.0, 90.0), (z, x, y): (90.0, 90.0)}
    about_x, about_z = turns.get(thing.size, (0.0, 0.0))
    return {"x": about_x, "y": _number(math.degrees(-thing.yaw) % 360), "z": about_z}


def standard_hole(kind: str) -> tuple[float, float]:
    """Width and height, in metres, of the doors or windows that are written by default."""
    return wall_hole(DOOR_ASSET if kind == "door" else WINDOW_ASSET)


def _side_id(room: str, start: Corner, end: Corner) -> str:
    return f"wall|{room.split('|')[-1]}|{start[0]:.2f}|{start[1]:.2f}|{end[0]:.2f}|{end[1]:.2f}"


def _point(x: float, y: float, z: float) -> dict[str, float]:
    """A point of the world frame in the Unity frame."""
    return {"x": _number(x), "y": _number(z), "z": _number(y)}


def _number(value: float) -> float:
    return round(value, DIGITS) + 0.0
