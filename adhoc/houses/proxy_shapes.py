"""The shapes of furniture: seats, beds, tables, cabinets, basins and lamps, each of a few boxes.

Every shape takes the object and the things that lie in or on it. Proportions are round numbers of our own,
near those of real furniture; they are set aside where the things inside say better.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from adhoc.houses.house import HouseObject
from adhoc.houses.proxy_parts import (
    RESTING_GAP,
    SAME_LEVEL,
    Area,
    Board,
    Load,
    Part,
    Proxy,
    corner_posts,
    footprint,
    shelf_levels,
    stacked,
)

MARGIN = 0.01
"""Metres kept free at the edges of places to put things."""


def chair(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A seat and a back."""
    return _seat(thing, loads, back=0.12, arm=0.0)


def arm_chair(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A seat, a back and two arms."""
    return _seat(thing, loads, back=0.2, arm=0.12)


def sofa(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A seat, a back and two arms, broader than an armchair's."""
    return _seat(thing, loads, back=0.22, arm=0.07)


def bed(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A mattress with a headboard; on posts if it is high or if something lies below it."""
    area, height = footprint(thing.size), thing.size[2]
    usual = min(0.6, 0.85 * height)
    lying = [load.bottom for load in loads if 0.3 <= load.bottom < height - SAME_LEVEL]
    top = min(lying) - RESTING_GAP if lying else usual
    below = [load for load in loads if load.bottom < top - 0.15]
    head = Part(Area(area.x0, area.x1, area.y0, area.y0 + 0.04 * thing.size[1]), 0.0, height)
    mattress_area = Area(area.x0, area.x1, head.area.y1, area.y1)
    board = Board(mattress_area.inset(MARGIN), top, math.inf)
    if not below and top <= 1.0:
        return Proxy((head, Part(mattress_area, 0.0, top)), (board,))
    bottom = max([top - 0.2, *(load.top for load in below if load.top < top - 0.01)])
    under = stacked(mattress_area, shelf_levels(below, bottom, ()), below, 0.02, MARGIN)
    posts = corner_posts(mattress_area, bottom, 0.06)
    boards = [under_board._replace(clearance=bottom - under_board.z) for under_board in under.boards]
    return Proxy((head, Part(mattress_area, bottom, top), *posts, *under.parts), (board, *boards))


def table(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A slab on four legs, with a shelf below where things lie."""
    levels = [*shelf_levels(loads, thing.size[2], ()), thing.size[2]]
    return _on_legs(thing, loads, levels)


def desk(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A table; a high one has its worktop at the usual height and a shelf along the back on top."""
    height = thing.size[2]
    if height < 0.95:
        return table(thing, loads)
    levels = shelf_levels(loads, height, (0.74,))
    if any(load.bottom >= height - SAME_LEVEL for load in loads):
        return _on_legs(thing, loads, [*levels, height])
    area = footprint(thing.size)
    lower = _on_legs(thing, loads, levels)
    hutch_area = Area(area.x0, area.x1, area.y0, area.y0 + 0.3 * thing.size[1])
    back = Part(Area(area.x0, area.x1, area.y0, area.y0 + 0.02), max(levels), height - 0.02)
    top = Part(hutch_area, height - 0.02, height)
    return Proxy((*lower.parts, back, top), lower.boards)


def counter_top(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A closed counter: straight, L-shaped or C-shaped as its asset's name says.

    The arms of real counters are 0.61 m deep; one runs along the back, the others along +x and -x.
    """
    area, height, depth = footprint(thing.size), thing.size[2], 0.61
    back = Area(area.x0, area.x1, area.y0, area.y0 + depth)
    right = Area(area.x1 - depth, area.x1, back.y1, area.y1)
    left = Area(area.x0, area.x0 + depth, back.y1, area.y1)
    if "_C_" in thing.asset:
        areas = [back, left, right]
    elif "_L_" in thing.asset:
        areas = [back, right]
    else:
        areas = [area]
    boards = tuple(Board(part.inset(MARGIN), height, math.inf) for part in areas)
    return Proxy(tuple(Part(part, 0.0, height) for part in areas), boards)


def fridge(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A cabinet that is open in front (robots have no action that opens a door), with shelves."""
    return _cabinet(thing, loads, thickness=0.04, spacing=0.4)


def shelving_unit(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """An open cabinet with shelves."""
    return _cabinet(thing, loads, thickness=0.02, spacing=0.4)


def dresser(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """An open cabinet with a shelf for each drawer."""
    return _cabinet(thing, loads, thickness=0.02, spacing=0.3)


def tv_stand(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A low open cabinet."""
    return _cabinet(thing, loads, thickness=0.02, spacing=0.3)


def sink(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A basin with a ledge along the back, in a solid foot."""
    height = thing.size[2]
    shallow = height < 0.3
    usual = 0.2 * height if shallow else height - 0.08
    lying = [load.bottom for load in loads if load.bottom < height - SAME_LEVEL]
    return _basin(thing, min(lying, default=usual), ledge=0.3, low_front=False)


def garbage_can(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """An open bin, filled so high that even low cameras see what lies in it.

    Where something lies deep in it, its front wall ends below the thing instead.
    """
    lying = [load.bottom for load in loads if load.bottom < thing.size[2] - SAME_LEVEL]
    return _basin(thing, min(lying, default=0.7 * thing.size[2]), ledge=0.0, low_front=bool(lying))


def toilet(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A bowl, and a tank on which things can be put."""
    area, height = footprint(thing.size), thing.size[2]
    tank = Area(area.x0, area.x1, area.y0, area.y0 + 0.35 * thing.size[1])
    bowl = Area(area.x0, area.x1, tank.y1, area.y1)
    parts = (Part(tank, 0.0, height), Part(bowl, 0.0, 0.45 * height))
    return Proxy(parts, (Board(tank.inset(MARGIN), height, math.inf),))


def television(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A panel, and a foot that is as deep as the whole."""
    area, height = footprint(thing.size), thing.size[2]
    half_depth = min(0.04, thing.size[1] / 2)
    panel = Area(area.x0, area.x1, -half_depth, half_depth)
    foot = Area(area.x0 / 2, area.x1 / 2, area.y0, area.y1)
    return Proxy((Part(foot, 0.0, 0.02), Part(panel, 0.02, height)))


def floor_lamp(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """A foot, a pole and a shade."""
    area, height = footprint(thing.size), thing.size[2]
    foot = Area(area.x0 * 0.7, area.x1 * 0.7, area.y0 * 0.7, area.y1 * 0.7)
    pole = Area(-0.02, 0.02, -0.02, 0.02)
    return Proxy((Part(foot, 0.0, 0.03), Part(pole, 0.03, 0.8 * height), Part(area, 0.8 * height, height)))


def _seat(thing: HouseObject, loads: Sequence[Load], back: float, arm: float) -> Proxy:
    """A seat with a back and arms; `back` and `arm` are shares of the depth and of the width."""
    area, height = footprint(thing.size), thing.size[2]
    lying = [load.bottom for load in loads if 0.2 * height < load.bottom < 0.8 * height]
    seat = min(lying) - RESTING_GAP if lying else 0.5 * height
    back_y, arm_x = area.y0 + back * thing.size[1], arm * thing.size[0]
    free = Area(area.x0 + arm_x, area.x1 - arm_x, back_y, area.y1)
    parts = [Part(free, 0.0, seat), Part(Area(area.x0, area.x1, area.y0, back_y), 0.0, height)]
    if arm:
        arm_top = seat + 0.4 * (height - seat)
        parts.append(Part(Area(area.x0, free.x0, back_y, area.y1), 0.0, arm_top))
        parts.append(Part(Area(free.x1, area.x1, back_y, area.y1), 0.0, arm_top))
    return Proxy(tuple(parts), (Board(free.inset(MARGIN), seat, math.inf),))


def _on_legs(thing: HouseObject, loads: Sequence[Load], levels: Sequence[float]) -> Proxy:
    area = footprint(thing.size)
    boards = stacked(area, levels, loads, 0.03, MARGIN)
    legs = corner_posts(area, boards.parts[-1].z0, min(0.05, *(extent / 4 for extent in thing.size[:2])))
    return Proxy((*boards.parts, *legs), boards.boards)


def _cabinet(thing: HouseObject, loads: Sequence[Load], thickness: float, spacing: float) -> Proxy:
    """Sides, a back, a bottom and a top, open in front, with shelves about `spacing` metres apart."""
    area, height = footprint(thing.size), thing.size[2]
    count = max(1, round((height - 0.05) / spacing))
    usual = [0.05 + index * (height - 0.05) / count for index in range(count)]
    inside = Area(area.x0 + thickness, area.x1 - thickness, area.y0 + thickness, area.y1)
    shelves = stacked(inside, [*shelf_levels(loads, height, usual), height], loads, thickness, MARGIN)
    sides = (
        Part(Area(area.x0, inside.x0, area.y0, area.y1), 0.0, height),
        Part(Area(inside.x1, area.x1, area.y0, area.y1), 0.0, height),
        Part(Area(inside.x0, inside.x1, area.y0, inside.y0), 0.0, height),
    )
    return Proxy((*sides, *shelves.parts), shelves.boards)


def _basin(thing: HouseObject, bottom: float, ledge: float, low_front: bool) -> Proxy:
    """An open container with its bottom at that height; `ledge` is the depth of its back as a share."""
    area, height, rim = footprint(thing.size), thing.size[2], 0.03
    bottom = max(RESTING_GAP, bottom - RESTING_GAP)
    inside = Area(area.x0 + rim, area.x1 - rim, area.y0 + max(rim, ledge * thing.size[1]), area.y1 - rim)
    back = Part(Area(area.x0, area.x1, area.y0, inside.y0), 0.0, height)
    front = Part(Area(inside.x0, inside.x1, inside.y1, area.y1), 0.0, bottom if low_front else height)
    left = Part(Area(area.x0, inside.x0, inside.y0, area.y1), 0.0, height)
    right = Part(Area(inside.x1, area.x1, inside.y0, area.y1), 0.0, height)
    board = Board(inside.inset(MARGIN), bottom, math.inf)
    return Proxy((Part(inside, 0.0, bottom), back, front, left, right), (board,))
