"""Whether everything in a house lies still under gravity."""

from __future__ import annotations

import math
from collections.abc import Sequence

from adhoc.dataset.checks.house_checks import Inspection, Violation
from adhoc.houses.house import House
from adhoc.houses.solids import Solid, SolidKind
from adhoc.worlds.bullet import LIGHTEST, MOST_BOXES_A_BODY, Bullet
from adhoc.worlds.rigid_shape import Placement, RigidShape, rigid_shape

SECONDS = 1.0
"""How long gravity acts."""

LIMIT = 0.02
"""No object may move further than this, in metres."""

STEPS_A_SECOND = 240

_NO_COLOUR = (0.0, 0.0, 0.0)


def check_gravity(house: House, seconds: float = SECONDS, limit: float = LIMIT) -> list[Violation]:
    """Every object that moves by more than `limit` metres within some time, by PyBullet.

    All objects that can be picked up are let go at once, with their masses; furniture stays where it is, as
    in ProcTHOR. The result does not depend on what was simulated before. Raises MissingDependency if PyBullet
    is not installed.
    """
    return gravity_violations(Inspection(house), seconds, limit)


def gravity_violations(
    inspection: Inspection, seconds: float = SECONDS, limit: float = LIMIT
) -> list[Violation]:
    """`check_gravity` of a house whose boxes are known already."""
    items = [solid for solid in inspection.solids if solid.kind is SolidKind.ITEM]
    fixed = [solid for solid in inspection.solids if solid.kind is not SolidKind.ITEM]
    simulation = _FallingThings()
    try:
        moved = simulation.let_go(items, fixed, seconds)
    finally:
        simulation.close()
    return [
        Violation(
            "gravity",
            item.id,
            f"moves by {100 * distance:.1f} cm within {seconds:g} s, more than {100 * limit:g} cm",
        )
        for item, distance in zip(items, moved)
        if not distance <= limit
    ]


class _FallingThings(Bullet):
    """A simulation in which many things fall at once."""

    def let_go(self, falling: Sequence[Solid], fixed: Sequence[Solid], seconds: float) -> list[float]:
        """How far each of the falling solids has moved when time is up, in metres."""
        self.reset()
        for solid in fixed:
            self.add_shape(*rigid_shape(solid.boxes), _NO_COLOUR)
        things = [(solid, *rigid_shape(solid.boxes)) for solid in falling]
        bodies = [self._drop(solid.mass, shape, placement) for solid, shape, placement in things]
        for _ in range(round(seconds * STEPS_A_SECOND)):
            self._api.stepSimulation(physicsClientId=self._client)
        return [
            math.dist(placement.center, self._position(body))
            for body, (_, _, placement) in zip(bodies, things)
        ]

    def _drop(self, mass: float, shape: RigidShape, placement: Placement) -> int:
        collision = self._collision_shape(shape.boxes[:MOST_BOXES_A_BODY])
        body = self._create(max(mass, LIGHTEST), collision, -1, placement.center, placement.yaw, None)
        self._api.changeDynamics(
            body,
            -1,
            lateralFriction=0.8,
            rollingFriction=0.02,
            spinningFriction=0.02,
            physicsClientId=self._client,
        )
        return body

    def _position(self, body: int) -> tuple[float, float, float]:
        position: tuple[float, float, float]
        position, _ = self._api.getBasePositionAndOrientation(body, physicsClientId=self._client)
        return position
