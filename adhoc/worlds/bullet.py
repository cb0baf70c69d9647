"""One PyBullet client: bodies made of boxes, contacts, a short fall, and pictures. No house, no robot."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adhoc.core.errors import MissingDependency
from adhoc.core.values import Point
from adhoc.houses.solids import Box
from adhoc.worlds.rigid_shape import Placement, RigidShape

MOST_BOXES_A_BODY = 16
"""PyBullet's limit for compound shapes; a shape with more boxes becomes several bodies."""

CONTACT = -1e-4
"""Two bodies touch if they penetrate each other deeper than this, in metres (touching faces do not)."""

LIGHTEST = 0.005
"""A falling body weighs at least this, in kilograms: PyBullet holds a body without mass for fixed."""

_ASIDE = -1000.0


class Bullet:
    """A private simulation without a window. All bodies stand still but for the one that `fall` drops.

    Raises MissingDependency if PyBullet is not installed.
    """

    def __init__(self) -> None:
        self._api = _pybullet()
        self._client: int | None = self._api.connect(self._api.DIRECT)
        self._collision_shapes: dict[tuple[Box, ...], int] = {}
        self._visual_shapes: dict[tuple[Box, ...], int] = {}

    def reset(self) -> None:
        """Remove everything."""
        self._api.resetSimulation(physicsClientId=self._client)
        self._api.setGravity(0.0, 0.0, -9.81, physicsClientId=self._client)
        self._collision_shapes.clear()
        self._visual_shapes.clear()

    def close(self) -> None:
        """Disconnect. Idempotent."""
        if self._client is not None and self._api.isConnected(self._client):
            self._api.disconnect(physicsClientId=self._client)
        self._client = None

    def add_shape(
        self, shape: RigidShape, placement: Placement, colour: tuple[float, float, float]
    ) -> tuple[int, ...]:
        """Bodies that together are the shape; they do not move by themselves."""
        return tuple(
            self._add_body(boxes, placement, colour) for boxes in _chunks(shape.boxes, MOST_BOXES_A_BODY)
        )

    def add_cylinder(
        self,
        radius: float,
        height: float,
        center: Point,
        visual: Box | None,
        colour: tuple[float, float, float],
    ) -> int:
        """An upright cylinder that looks like the box `visual` (given around its centre), or like nothing."""
        api = self._api
        collision = api.createCollisionShape(
            api.GEOM_CYLINDER, radius=radius, height=height, physicsClientId=self._client
        )
        appearance = -1 if visual is None else self._visual_shape((visual,))
        return self._create(0.0, collision, appearance, center, 0.0, colour)

    def place(self, body: int, placement: Placement) -> None:
        """Put a body somewhere at once, without passing through what lies between."""
        self._api.resetBasePositionAndOrientation(
            body, placement.center, _quaternion(placement.yaw), physicsClientId=self._client
        )

    def put_aside(self, body: int) -> None:
        """Take a body out of the scene without removing it: far below, where nothing else comes."""
        self.place(body, Placement((0.0, 0.0, _ASIDE - 10.0 * body), 0.0))

    @contextmanager
    def set_aside(self, bodies: Sequence[int]) -> Iterator[None]:
        """For a while, take bodies out of the scene."""
        poses = [
            self._api.getBasePositionAndOrientation(body, physicsClientId=self._client) for body in bodies
        ]
        for body in bodies:
            self.put_aside(body)
        try:
            yield
        finally:
            for body, (position, orientation) in zip(bodies, poses):
                self._api.resetBasePositionAndOrientation(
                    body, position, orientation, physicsClientId=self._client
                )

    def bodies_near(self, low: Point, high: Point) -> set[int]:
        """The bodies whose bounding boxes meet an upright box; no other body can touch what is inside it."""
        pairs = self._api.getOverlappingObjects(low, high, physicsClientId=self._client) or ()
        return {number for number, _ in pairs}

    def touched_by(self, body: int, ignored: Collection[int] = ()) -> int | None:
        """The lowest-numbered body, but for the ignored ones, that this one penetrates; None without any."""
        api, client = self._api, self._client
        low, high = api.getAABB(body, -1, physicsClientId=client)
        for other in sorted(self.bodies_near(low, high)):
            if other == body or other in ignored:
                continue
            contacts = api.getClosestPoints(body, other, 0.0, physicsClientId=client)
            if any(contact[8] < CONTACT for contact in contacts):
                return int(other)
        return None

    def fall(
        self, shape: RigidShape, placement: Placement, mass: float, seconds: float
    ) -> tuple[Placement, float]:
        """Where a body of that shape is some time after it is let go at `placement`, and its tilt in radians.

        The body exists during the fall only; everything else stands still.
        """
        api, client = self._api, self._client
        collision = self._collision_shape(shape.boxes[:MOST_BOXES_A_BODY])
        body = self._create(max(mass, LIGHTEST), collision, -1, placement.center, placement.yaw, None)
        api.changeDynamics(
            body, -1, lateralFriction=0.8, rollingFriction=0.02, spinningFriction=0.02, physicsClientId=client
        )
        for _ in range(round(seconds * 240)):
            api.stepSimulation(physicsClientId=client)
        position, orientation = api.getBasePositionAndOrientation(body, physicsClientId=client)
        api.removeBody(body, physicsClientId=client)
        x, y, z, w = orientation
        upright = 1.0 - 2.0 * (x * x + y * y)
        yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        return Placement(position, yaw), math.acos(max(-1.0, min(1.0, upright)))

    def projection(self, field_of_view: float, near: float, far: float) -> Sequence[float]:
        """The projection matrix of a square picture, for `picture`."""
        matrix: Sequence[float] = self._api.computeProjectionMatrixFOV(
            math.degrees(field_of_view), 1.0, near, far
        )
        return matrix

    def picture(
        self, world_from_camera: NDArray[np.float64], projection: Sequence[float], size: int
    ) -> tuple[NDArray[np.uint8], NDArray[np.float32], NDArray[np.int64]]:
        """Colours (H, W, 4), depth buffer (H, W) and body numbers (H, W; -1 for nothing), by TinyRenderer."""
        eye, forward, down = world_from_camera[:3, 3], world_from_camera[:3, 2], world_from_camera[:3, 1]
        view = self._api.computeViewMatrix(eye.tolist(), (eye + forward).tolist(), (-down).tolist())
        _, _, colours, depth, bodies = self._api.getCameraImage(
            size,
            size,
            view,
            projection,
            lightDirection=[2.0, 1.0, 4.0],
            lightAmbientCoeff=0.65,
            lightDiffuseCoeff=0.4,
            lightSpecularCoeff=0.0,
            shadow=0,
            renderer=self._api.ER_TINY_RENDERER,
            physicsClientId=self._client,
        )
        return (
            np.reshape(np.asarray(colours, np.uint8), (size, size, 4)),
            np.reshape(np.asarray(depth, np.float32), (size, size)),
            np.reshape(np.asarray(bodies, np.int64), (size, size)),
        )

    def _add_body(
        self, boxes: tuple[Box, ...], placement: Placement, colour: tuple[float, float, float]
    ) -> int:
        return self._create(
            0.0,
            self._collision_shape(boxes),
            self._visual_shape(boxes),
            placement.center,
            placement.yaw,
            colour,
        )

    def _create(
        self,
        mass: float,
        collision: int,
        visual: int,
        center: Point,
        yaw: float,
        colour: tuple[float, float, float] | None,
    ) -> int:
        body = int(
            self._api.createMultiBody(
                mass, collision, visual, center, _quaternion(yaw), physicsClientId=self._client
            )
        )
        if colour is not None and visual >= 0:
            self._api.changeVisualShape(body, -1, rgbaColor=[*colour, 1.0], physicsClientId=self._client)
        return body

    def _collision_shape(self, boxes: tuple[Box, ...]) -> int:
        if boxes not in self._collision_shapes:
            self._collision_shapes[boxes] = self._api.createCollisionShapeArray(
                shapeTypes=[self._api.GEOM_BOX] * len(boxes),
                halfExtents=[box.half for box in boxes],
                collisionFramePositions=[box.center for box in boxes],
                collisionFrameOrientations=[_quaternion(box.yaw) for box in boxes],
                physicsClientId=self._client,
            )
        return self._collision_shapes[boxes]

    def _visual_shape(self, boxes: tuple[Box, ...]) -> int:
        if boxes not in self._visual_shapes:
            self._visual_shapes[boxes] = self._api.createVisualShapeArray(
                shapeTypes=[self._api.GEOM_BOX] * len(boxes),
                halfExtents=[box.half for box in boxes],
                visualFramePositions=[box.center for box in boxes],
                visualFrameOrientations=[_quaternion(box.yaw) for box in boxes],
                physicsClientId=self._client,
            )
        return self._visual_shapes[boxes]


def _pybullet() -> Any:
    try:
        with _quiet_stderr():
            import pybullet
    except ImportError as error:
        raise MissingDependency(
            "the simulated world needs PyBullet, which is not installed: pip install 'pybullet>=3.2.5'"
        ) from error
    return pybullet


def _quaternion(yaw: float) -> tuple[float, float, float, float]:
    return 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)


def _chunks(boxes: tuple[Box, ...], size: int) -> list[tuple[Box, ...]]:
    return [boxes[start : start + size] for start in range(0, len(boxes), size)]


@contextmanager
def _quiet_stderr() -> Iterator[None]:
    """PyBullet says when it was built, below Python, when it is imported."""
    sys.stderr.flush()
    before = os.dup(2)
    try:
        with open(os.devnull, "w") as nowhere:
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        os.dup2(before, 2)
        os.close(before)
