"""What the oracle knows of a scenario whatever happens in it: the house, and the rules of the world."""

from __future__ import annotations

from dataclasses import dataclass

from adhoc.dataset.oracle.reach import Walls
from adhoc.houses.build import build_solids
from adhoc.houses.facts import is_reasonable
from adhoc.houses.house import House
from adhoc.houses.solids import Solid, SolidKind
from adhoc.worlds.rigid_shape import Placement, RigidShape, rigid_shape
from adhoc.worlds.world import ObjectTruth


@dataclass(frozen=True)
class Rules:
    """What the oracle assumes of the world, and how hard it tries. The defaults are those of
    `PyBulletWorld`; lattice, tilts and the size of robots are fixed to them."""

    reach: float = 1.5
    """Metres within which a robot can pick up and put down (`visibility_distance`)."""
    mass_scale: float = 1.0
    """Factor on all masses, as in the world."""
    image_size: int = 128
    """Pixels of the pictures."""
    receptacles: int = 6
    """How many receptacles are considered for an object: the nearest with room."""
    most_plans: int = 20
    """How often a run is planned at most; a refused action makes a new plan necessary."""


@dataclass(frozen=True)
class Refusals:
    """What the world refused in a run, and what is therefore not tried again."""

    stances: frozenset[tuple[str, float, float, float, int]] = frozenset()
    """(object or receptacle, camera height, x, y, aim) where an action failed."""
    receptacles: frozenset[tuple[str, str]] = frozenset()
    """(object, receptacle) without a free place."""
    steps: frozenset[tuple[float, float, int]] = frozenset()
    """(x, y, move) that was blocked."""


PYBULLET = Rules()
NOTHING_REFUSED = Refusals()


class HouseKnowledge:
    """What stays the same in one scenario: the rooms, the shape of every solid, and the masses."""

    def __init__(self, house: House) -> None:
        self.rooms = house.rooms
        self.solids: tuple[Solid, ...] = build_solids(house)
        self.things = {thing.id: thing for thing in house.objects}
        self.room_types = tuple(room.room_type for room in house.rooms)
        self.walls = Walls(self.solids)
        self.room_of = {thing.id: self.room_index(thing.room) for thing in house.objects}
        self._by_id = {solid.id: solid for solid in self.solids}
        self._shapes: dict[str, tuple[RigidShape, Placement]] = {}

    def room_index(self, room_id: str | None) -> int:
        """The number of a room in their order; -1 if there is none of that id."""
        return next((index for index, room in enumerate(self.rooms) if room.id == room_id), -1)

    def solid(self, object_id: str) -> Solid:
        """The solid of an object, where it was in the tidy house."""
        return self._by_id[object_id]

    def mass(self, object_id: str) -> float:
        """Kilograms, before any factor of the world."""
        return self._by_id[object_id].mass

    def shape(self, object_id: str) -> tuple[RigidShape, Placement]:
        """The boxes of an object in its own frame, and where it was in the tidy house."""
        if object_id not in self._shapes:
            solid = self._by_id[object_id]
            self._shapes[object_id] = rigid_shape(solid.boxes, solid.surfaces)
        return self._shapes[object_id]

    def moved(self, solid: Solid, truth: ObjectTruth) -> Solid:
        """The solid where the object really is."""
        shape, _ = self.shape(solid.id)
        placement = Placement(truth.position, truth.yaw)
        return Solid(
            solid.id,
            solid.category,
            solid.kind,
            shape.boxes_at(placement),
            shape.surfaces_at(placement),
            solid.mass,
        )

    def receptacles_for(self, category: str) -> list[Solid]:
        """Everything fixed on or in which objects of the category belong, and which has a place for them."""
        found = []
        for solid in self.solids:
            thing = self.things.get(solid.id)
            if thing is None or solid.kind is not SolidKind.FURNITURE or not solid.surfaces:
                continue
            room_type = self.room_types[self.room_of[thing.id]]
            if is_reasonable(category, thing.category, room_type):
                found.append(solid)
        return found
