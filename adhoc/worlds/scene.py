"""A house as bodies and boxes: every thing in it, where it is now, and where it was put."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.core.errors import HouseError
from adhoc.core.values import Label
from adhoc.houses.floor_plan import contains, distance
from adhoc.houses.house import FLOOR, House, Room
from adhoc.houses.solids import Box, Solid, SolidKind, Surface
from adhoc.worlds.bullet import MOST_BOXES_A_BODY, Bullet
from adhoc.worlds.colours import colour_of
from adhoc.worlds.rigid_shape import Placement, RigidShape, rigid_shape
from adhoc.worlds.sensor.box_table import BoxTable, Layer

ROBOT = "Robot"
"""The category of robots in instance segmentation."""

_OUTLINE = 0.01


@dataclass
class Thing:
    """One solid of the house and its present state."""

    id: str
    category: str
    kind: SolidKind
    instance: int
    shape: RigidShape
    placement: Placement
    """Where it is, or, while a robot holds it, where it was."""
    bodies: tuple[int, ...]
    mass: float
    is_receptacle: bool
    receptacle: str | None
    """The receptacle it is in or on, `Floor`, or None if it is fixed to the house or held."""
    room: str | None
    holder: str | None = None

    @property
    def pickupable(self) -> bool:
        return self.kind is SolidKind.ITEM

    @property
    def surfaces(self) -> tuple[Surface, ...]:
        """Where things can be put, in the world frame, as it stands now."""
        return self.shape.surfaces_at(self.placement)


class Scene:
    """All things of one house, kept alike in the simulation and in the sensor's table of boxes.

    Args:
        bullet: the simulation; it is emptied first.
        house: rooms and objects.
        solids: the boxes of the house and of each object.

    Raises:
        HouseError: ids are not unique, a solid has no boxes, an item has too many, or an object's parent
            is not in the house.
    """

    def __init__(self, bullet: Bullet, house: House, solids: Sequence[Solid]) -> None:
        bullet.reset()
        self.bullet = bullet
        self.rooms: tuple[Room, ...] = house.rooms
        self._room_bounds = [(*_bounds(room), room) for room in house.rooms]
        self.table = BoxTable()
        self.labels: list[Label] = []
        self.things: dict[str, Thing] = {}
        self.floor_bodies: set[int] = set()
        self._instance_of_body: dict[int, int] = {}
        self._bodies_of_instance: list[tuple[int, ...]] = []
        self._bodies_changed = True
        self._instances_by_body: NDArray[np.int32] = np.zeros(0, np.int32)
        self._on_first_move: list[Callable[[int], None]] = []
        objects = {thing.id: thing for thing in house.objects}
        _check(house, solids)
        for solid in solids:
            shape, placement = rigid_shape(solid.boxes, solid.surfaces)
            bodies = bullet.add_shape(shape, placement, colour_of(solid.category))
            listed = objects.get(solid.id)
            thing = Thing(
                solid.id,
                solid.category,
                solid.kind,
                self._register(Label(solid.id, solid.category), bodies),
                shape,
                placement,
                bodies,
                solid.mass,
                bool(solid.surfaces) if listed is None else listed.is_receptacle or bool(solid.surfaces),
                None if listed is None else listed.parent,
                None if listed is None else listed.room,
            )
            self.things[solid.id] = thing
            if solid.kind is SolidKind.FLOOR:
                self.floor_bodies.update(bodies)
        self.table.add([solid.boxes for solid in solids], Layer.STATIC)

    def watch(self, on_first_move: Callable[[int], None]) -> None:
        """Call back with the instance whenever one leaves the static layer, before it does."""
        self._on_first_move.append(on_first_move)

    def add_robot(self, robot_id: str, bodies: tuple[int, ...], boxes: Sequence[Box]) -> int:
        """Enter a robot's body into the segmentation; returns its instance."""
        instance = self._register(Label(robot_id, ROBOT), bodies)
        self.table.add([boxes], Layer.MOVED)
        return instance

    def move_robot(self, instance: int, boxes: Sequence[Box]) -> None:
        """Show a robot's body elsewhere."""
        self.table.place(instance, boxes, Layer.MOVED)

    def hide_robot(self, instance: int) -> None:
        """Show a robot's body nowhere."""
        self.table.set_layer(instance, Layer.HIDDEN)

    def take(self, thing: Thing, holder: str | None) -> None:
        """Take a thing out of the scene: into a robot's hand, or nowhere while it is being placed."""
        self._leave_static_layer(thing)
        self.table.set_layer(thing.instance, Layer.HIDDEN)
        for body in thing.bodies:
            self.bullet.put_aside(body)
        thing.holder = holder
        thing.receptacle, thing.room = None, None

    def put(self, thing: Thing, placement: Placement, receptacle: str | None) -> None:
        """Put a thing that was taken back into the scene."""
        for body in thing.bodies:
            self.bullet.place(body, placement)
        self.table.place(thing.instance, thing.shape.boxes_at(placement), Layer.MOVED)
        thing.placement, thing.receptacle, thing.holder = placement, receptacle, None
        thing.room = self.room_at(placement.center[:2])

    def contents(self, thing: Thing) -> list[Thing]:
        """The things that were put into or onto a receptacle."""
        return [other for other in self.things.values() if other.receptacle == thing.id]

    def room_at(self, point: tuple[float, float]) -> str | None:
        """The id of the room whose floor is below the point; None outside the house."""
        x, y = point
        for x0, x1, y0, y1, room in self._room_bounds:
            if x0 <= x <= x1 and y0 <= y <= y1 and contains(room.polygon, point):
                return room.id
        nearest = min(self.rooms, key=lambda room: distance(room.polygon, point))
        return nearest.id if distance(nearest.polygon, point) <= _OUTLINE else None

    def receptacle_category(self, receptacle: str | None) -> str | None:
        """The category of a receptacle's id; `Floor` for `Floor`."""
        if receptacle is None or receptacle == FLOOR:
            return receptacle
        return self.things[receptacle].category

    def name_of_body(self, body: int) -> str:
        """The id of the thing or robot that a body belongs to."""
        return self.labels[self._instance_of_body[body]].id

    def bodies_of(self, instance: int) -> tuple[int, ...]:
        """The bodies of an instance."""
        return self._bodies_of_instance[instance]

    def instances_by_body(self) -> NDArray[np.int32]:
        """The instance of every body number, -1 where there is none."""
        if self._bodies_changed:
            table = np.full(max(self._instance_of_body, default=-1) + 1, -1, np.int32)
            for body, instance in self._instance_of_body.items():
                table[body] = instance
            self._instances_by_body, self._bodies_changed = table, False
        return self._instances_by_body

    def _register(self, label: Label, bodies: tuple[int, ...]) -> int:
        instance = len(self.labels)
        self.labels.append(label)
        self._bodies_of_instance.append(bodies)
        self._instance_of_body.update(dict.fromkeys(bodies, instance))
        self._bodies_changed = True
        return instance

    def _leave_static_layer(self, thing: Thing) -> None:
        if self.table.layer(thing.instance) is Layer.STATIC:
            for notify in self._on_first_move:
                notify(thing.instance)


def _bounds(room: Room) -> tuple[float, float, float, float]:
    xs, ys = zip(*room.polygon)
    return min(xs), max(xs), min(ys), max(ys)


def _check(house: House, solids: Sequence[Solid]) -> None:
    if not house.rooms:
        raise HouseError(f"house {house.id!r}: rooms is empty; a house needs at least one room")
    seen: set[str] = set()
    for solid in solids:
        if solid.id in seen:
            raise HouseError(f"house {house.id!r}: two solids have the id {solid.id!r}; ids must be unique")
        seen.add(solid.id)
        if not solid.boxes:
            raise HouseError(f"house {house.id!r}: solid {solid.id!r} has no boxes; it needs at least one")
        if solid.kind is SolidKind.ITEM and len(solid.boxes) > MOST_BOXES_A_BODY:
            raise HouseError(
                f"house {house.id!r}: item {solid.id!r} has {len(solid.boxes)} boxes; "
                f"an item can have at most {MOST_BOXES_A_BODY}"
            )
    for thing in house.objects:
        if thing.parent not in (None, FLOOR) and thing.parent not in seen:
            raise HouseError(
                f"house {house.id!r}: the parent of object {thing.id!r} is {thing.parent!r}, "
                "which is not in the house"
            )
