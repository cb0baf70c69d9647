"""Small houses given directly as boxes, for tests with answers that can be computed by hand."""

from __future__ import annotations

import math

import numpy as np
from textbook_rays import holds

from adhoc.houses.house import House, Room
from adhoc.houses.solids import Box, Solid, SolidKind, Surface


def room_house(size: float) -> House:
    """One square room with a corner at the origin, and nothing listed in it."""
    corners = ((0.0, 0.0), (size, 0.0), (size, size), (0.0, size))
    return House("boxes", (Room("room", "Kitchen", corners),), (), (), ())


def shell(size: float) -> list[Solid]:
    """The floor and the four walls (0.1 m thick, outside the room, 2.5 m high) of `room_house`."""
    half = size / 2
    walls = {
        "south": ((half, -0.05), (half, 0.05)),
        "north": ((half, size + 0.05), (half, 0.05)),
        "west": ((-0.05, half), (0.05, half)),
        "east": ((size + 0.05, half), (0.05, half)),
    }
    floor = Box((half, half, -0.05), (half, half, 0.05))
    top = Surface((half, half, 0.0), (half, half), 0.0, math.inf)
    return [
        Solid("room", "Floor", SolidKind.FLOOR, (floor,), (top,)),
        *(
            Solid(name, "Wall", SolidKind.WALL, (Box((x, y, 1.25), (hx, hy, 1.25)),))
            for name, ((x, y), (hx, hy)) in walls.items()
        ),
    ]


def table(name: str, center: tuple[float, float], half: tuple[float, float], height: float) -> Solid:
    """A solid block with a free top."""
    box = Box((*center, height / 2), (*half, height / 2))
    return Solid(
        name, "Table", SolidKind.FURNITURE, (box,), (Surface((*center, height), half, 0.0, math.inf),)
    )


def item(name: str, center: tuple[float, float, float], half: tuple[float, float, float], mass=0.2) -> Solid:
    """A box that can be picked up."""
    return Solid(name, "Thing", SolidKind.ITEM, (Box(center, half),), (), mass)


def random_solids(seed: int, size: float, count: int) -> list[Solid]:
    """A room with partitions and `count` random things, a third of them made of two boxes."""
    generator = np.random.default_rng(seed)
    solids = shell(size)
    for index in range(2):
        x = size * (index + 1) / 3
        box = Box((x, size * 0.35, 1.25), (0.05, size * 0.35, 1.25))
        solids.append(Solid(f"partition {index}", "Wall", SolidKind.WALL, (box,)))
    for index in range(count):
        hx, hy, hz = (float(half) for half in generator.uniform(0.03, 0.35, 3))
        x, y = (float(place) for place in generator.uniform(0.5, size - 0.5, 2))
        z = float(generator.uniform(hz + 0.002, 1.6))
        yaw = float(generator.uniform(-math.pi, math.pi)) if index % 2 else 0.0
        boxes = [Box((x, y, z), (hx, hy, hz), yaw)]
        if index % 3 == 0:
            boxes.append(Box((x, y, z + hz + 0.05), (hx / 2, hy / 2, 0.05), yaw + 0.3))
        kind = SolidKind.ITEM if index % 4 == 0 else SolidKind.FURNITURE
        solids.append(Solid(f"thing {index}", f"Kind{index % 7}", kind, tuple(boxes), (), 0.5))
    return solids


def is_clear(solids: list[Solid], eye: tuple[float, float, float], margin: float) -> bool:
    """Whether the eye is in no box grown by `margin` metres."""
    return not any(holds(box, eye, margin) for solid in solids for box in solid.boxes)
