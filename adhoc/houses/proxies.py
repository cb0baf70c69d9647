"""Which shape stands for which object.

The shapes follow how things really lie: measured in 501 real ProcTHOR houses, what belongs to a fridge, a
sofa or a chair lies inside its bounding box, and so do most things on beds and shelving units; a solid box
would hide them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from adhoc.houses import proxy_shapes as shapes
from adhoc.houses.house import HouseObject
from adhoc.houses.proxy_parts import Board, Load, Part, Proxy, footprint

Shape = Callable[[HouseObject, Sequence[Load]], Proxy]


def proxy_of(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """The proxy of an object that carries `loads`.

    Items are single boxes. Furniture without a shape of its own is a single box too, on top of which things
    can be put if it is a receptacle.
    """
    if thing.pickupable:
        return block(thing, loads)
    return _SHAPES.get(thing.category, block)(thing, loads)


def block(thing: HouseObject, loads: Sequence[Load]) -> Proxy:
    """One box as large as the object."""
    area = footprint(thing.size)
    boards = (Board(area, thing.size[2], math.inf),) if thing.is_receptacle else ()
    return Proxy((Part(area, 0.0, thing.size[2]),), boards)


_SHAPES: dict[str, Shape] = {
    "ArmChair": shapes.arm_chair,
    "Bed": shapes.bed,
    "Chair": shapes.chair,
    "CoffeeTable": shapes.table,
    "CounterTop": shapes.counter_top,
    "Desk": shapes.desk,
    "DiningTable": shapes.table,
    "Dresser": shapes.dresser,
    "FloorLamp": shapes.floor_lamp,
    "Fridge": shapes.fridge,
    "GarbageCan": shapes.garbage_can,
    "ShelvingUnit": shapes.shelving_unit,
    "SideTable": shapes.table,
    "Sink": shapes.sink,
    "Sofa": shapes.sofa,
    "Stool": shapes.table,
    "Television": shapes.television,
    "Toilet": shapes.toilet,
    "TVStand": shapes.tv_stand,
}
