"""A house as plain values, in the world frame of `core.geometry` (z up, metres, yaw counter-clockwise).

The values keep what ProcTHOR house JSON says and no more; `houses.procthor` reads the JSON,
`houses.procthor_writing` writes it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

from adhoc.core.values import Point

FLOOR = "Floor"
"""The receptacle of an object that lies on the floor."""

Corner = tuple[float, float]


@dataclass(frozen=True)
class Room:
    """One room: `polygon` is its floor outline in order, corners in metres."""

    id: str
    room_type: str
    """Kitchen, LivingRoom, Bedroom, Bathroom, or our own Corridor."""
    polygon: tuple[Corner, ...]


@dataclass(frozen=True)
class Opening:
    """A hole in a wall: a door, an open frame or a window. `passable` if a robot can drive through."""

    id: str
    kind: str
    """`door`, `window`, or `open` (a wall left out between two rooms)."""
    rooms: tuple[str, str]
    start: Corner
    """Where the hole begins and ends along the wall, on the floor plan."""
    end: Corner
    bottom: float
    top: float
    passable: bool
    asset: str = ""
    """Door or window asset of ProcTHOR; empty for an opening without one."""


@dataclass(frozen=True)
class Wall:
    """One merged wall segment of the floor plan, `height` metres tall, with the openings cut into it."""

    id: str
    start: Corner
    end: Corner
    height: float
    rooms: tuple[str, ...]
    """The rooms on its sides: two for an interior wall, one for an exterior wall."""
    openings: tuple[Opening, ...] = ()


@dataclass(frozen=True)
class HouseObject:
    """One object: furniture or small thing. `position` is the centre of its bounding box."""

    id: str
    asset: str
    category: str
    """Object type of the asset, e.g. `Fridge`; always looked up by asset, never parsed from the id."""
    position: Point
    yaw: float
    size: Point
    """Full extents of its bounding box in metres, before rotation by `yaw`."""
    room: str
    """Id of the room whose floor is below its centre."""
    parent: str | None
    """Id of the receptacle it is in or on, `FLOOR` if it lies on the floor, None if fixed to the house."""
    pickupable: bool
    mass: float
    """Kilograms; meaningful for pickupable objects."""
    is_receptacle: bool


@dataclass(frozen=True)
class House:
    """A whole house. Ids are unique over rooms, walls, openings and objects."""

    id: str
    rooms: tuple[Room, ...]
    walls: tuple[Wall, ...]
    openings: tuple[Opening, ...]
    objects: tuple[HouseObject, ...]
    source: str = ""
    """Where it came from: a file and line, or a generator with its seed."""

    def room(self, room_id: str) -> Room:
        """The room of that id; raises KeyError."""
        return _find(self.rooms, room_id)

    def object(self, object_id: str) -> HouseObject:
        """The object of that id; raises KeyError."""
        return _find(self.objects, object_id)


_Named = TypeVar("_Named", Room, HouseObject)


def _find(things: tuple[_Named, ...], wanted: str) -> _Named:
    for thing in things:
        if thing.id == wanted:
            return thing
    raise KeyError(wanted)
