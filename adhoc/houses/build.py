"""From a house to boxes: floors, walls, doors, furniture and items, as `Solid`s."""

from __future__ import annotations

from collections.abc import Iterable

from adhoc.houses.house import House, HouseObject
from adhoc.houses.proxies import proxy_of
from adhoc.houses.proxy_parts import Load, placed_box, placed_surface
from adhoc.houses.shell_solids import closures_of, floor_of, wall_solid
from adhoc.houses.solids import Solid, SolidKind

WALL_THICKNESS = 0.02
"""Metres. ProcTHOR's walls have no thickness, its furniture stands 25 mm off them, and its pictures hang
5 mm off them and are at least 16 mm deep: walls of 20 mm, 10 mm to each side, leave both free and seen."""


def build_solids(house: House, wall_thickness: float = WALL_THICKNESS) -> tuple[Solid, ...]:
    """Every floor, wall, closed door, window pane and object of a house; ids are unique.

    Furniture is built of several boxes, so that what really lies in or on it is seen and can be reached from
    its free side; where things lie inside a piece, its seat, shelves or bottom are set to their height.
    """
    loads = _loads_by_parent(house.objects)
    return (
        *(floor_of(room) for room in house.rooms),
        *(wall_solid(wall, wall_thickness) for wall in house.walls),
        *(solid for wall in house.walls for solid in closures_of(wall, wall_thickness)),
        *(object_solid(thing, loads.get(thing.id, ())) for thing in house.objects),
    )


def object_solid(thing: HouseObject, loads: Iterable[Load] = ()) -> Solid:
    """The solid of one object; `loads` are the things that lie in or on it, relative to its bottom."""
    proxy = proxy_of(thing, tuple(loads))
    base = (thing.position[0], thing.position[1], thing.position[2] - thing.size[2] / 2)
    return Solid(
        thing.id,
        thing.category,
        SolidKind.ITEM if thing.pickupable else SolidKind.FURNITURE,
        tuple(placed_box(part, base, thing.yaw) for part in proxy.parts),
        tuple(placed_surface(board, base, thing.yaw) for board in proxy.boards),
        thing.mass,
    )


def _loads_by_parent(objects: Iterable[HouseObject]) -> dict[str, list[Load]]:
    by_id = {thing.id: thing for thing in objects}
    loads: dict[str, list[Load]] = {}
    for thing in by_id.values():
        parent = by_id.get(thing.parent or "")
        if parent is not None:
            base = parent.position[2] - parent.size[2] / 2
            bottom = thing.position[2] - thing.size[2] / 2 - base
            loads.setdefault(parent.id, []).append(Load(bottom, bottom + thing.size[2]))
    return loads
