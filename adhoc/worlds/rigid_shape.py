"""A rigid arrangement of boxes that can be put anywhere: what stays the same when a thing moves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from adhoc.core.values import Point
from adhoc.houses.solids import Box, Surface


@dataclass(frozen=True)
class Placement:
    """Where a thing is: the centre of its bounding box in metres, and its yaw in radians."""

    center: Point
    yaw: float


@dataclass(frozen=True)
class RigidShape:
    """Boxes and surfaces in the frame of their common bounding box."""

    boxes: tuple[Box, ...]
    surfaces: tuple[Surface, ...]
    half: Point
    """Half extents of the bounding box."""

    def boxes_at(self, placement: Placement) -> tuple[Box, ...]:
        """The boxes in the world frame, for a thing at `placement`."""
        return tuple(
            Box(_outward(placement, box.center), box.half, box.yaw + placement.yaw) for box in self.boxes
        )

    def surfaces_at(self, placement: Placement) -> tuple[Surface, ...]:
        """The surfaces in the world frame, for a thing at `placement`."""
        return tuple(
            Surface(
                _outward(placement, surface.center),
                surface.half,
                surface.yaw + placement.yaw,
                surface.clearance,
            )
            for surface in self.surfaces
        )


def rigid_shape(boxes: Sequence[Box], surfaces: Sequence[Surface] = ()) -> tuple[RigidShape, Placement]:
    """The shape of boxes given in the world frame, and where it is. The first box sets the yaw."""
    yaw = boxes[0].yaw
    corners = np.array([corner for box in boxes for corner in _corners(box, yaw)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    middle = Placement((0.0, 0.0, 0.0), yaw)
    placement = Placement(_outward(middle, tuple((low + high) / 2)), yaw)
    shape = RigidShape(
        tuple(Box(_inward(placement, box.center), box.half, box.yaw - yaw) for box in boxes),
        tuple(
            Surface(_inward(placement, surface.center), surface.half, surface.yaw - yaw, surface.clearance)
            for surface in surfaces
        ),
        tuple(float(extent) for extent in (high - low) / 2),  # type: ignore[arg-type]
    )
    return shape, placement


def _corners(box: Box, yaw: float) -> list[Point]:
    """The corners of a box, in axes turned by `yaw` about the world's origin."""
    frame = Placement((0.0, 0.0, 0.0), yaw)
    own = Placement(box.center, box.yaw)
    hx, hy, hz = box.half
    signs = [(sx, sy, sz) for sx in (-1, 1) for sy in (-1, 1) for sz in (-1, 1)]
    return [_inward(frame, _outward(own, (sx * hx, sy * hy, sz * hz))) for sx, sy, sz in signs]


def _outward(placement: Placement, local: Sequence[float]) -> Point:
    cosine, sine = math.cos(placement.yaw), math.sin(placement.yaw)
    x, y, z = placement.center
    return (
        float(x + cosine * local[0] - sine * local[1]),
        float(y + sine * local[0] + cosine * local[1]),
        float(z + local[2]),
    )


def _inward(placement: Placement, point: Sequence[float]) -> Point:
    cosine, sine = math.cos(placement.yaw), math.sin(placement.yaw)
    dx, dy, dz = (point[axis] - placement.center[axis] for axis in range(3))
    return float(cosine * dx + sine * dy), float(cosine * dy - sine * dx), float(dz)
