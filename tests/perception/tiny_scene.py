"""A few upright boxes and a numpy ray caster: observations whose content is known by hand."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from adhoc.core.geometry import camera_at, intrinsics
from adhoc.core.values import ActionResult, Label, Observation, Pose

SIZE = 128


@dataclass
class TinyScene:
    """`floors`: room id -> (x0, y0, x1, y1); `boxes`: id -> (category, x0, y0, z0, x1, y1, z1)."""

    floors: dict[str, tuple[float, float, float, float]]
    boxes: dict[str, tuple[str, float, float, float, float, float, float]] = field(default_factory=dict)
    unlabelled: set[str] = field(default_factory=set)

    def look(
        self,
        pose: Pose,
        step: int = 0,
        held: str | None = None,
        height: float = 1.6,
        last_result: ActionResult | None = None,
        size: int = SIZE,
        steps_left: int = 500,
    ) -> Observation:
        matrix = intrinsics(size, size, math.pi / 2)
        camera = camera_at(pose, height, matrix)
        depth = np.full((size, size), np.inf)
        instances = np.full((size, size), -1, np.int32)
        rows, columns = np.mgrid[:size, :size]
        focal, u0, v0 = matrix[0, 0], matrix[0, 2], matrix[1, 2]
        rays = np.stack([(columns - u0) / focal, (rows - v0) / focal, np.ones((size, size))], -1)
        rays = rays @ camera.world_from_camera[:3, :3].T
        eye = camera.world_from_camera[:3, 3]
        things = [
            (name, "Floor", (x0, y0, -0.1, x1, y1, 0.0)) for name, (x0, y0, x1, y1) in self.floors.items()
        ]
        things += [(name, box[0], box[1:]) for name, box in self.boxes.items() if name != held]
        labels = {}
        for key, (name, category, box) in enumerate(things):
            entered = _enter(eye, rays, np.array(box[:3]), np.array(box[3:]))
            nearer = entered < depth
            depth[nearer] = entered[nearer]
            instances[nearer] = key
            labels[key] = Label(name, category)
        seen = set(np.unique(instances).tolist())
        labels = {
            key: label for key, label in labels.items() if key in seen and label.id not in self.unlabelled
        }
        return Observation(
            step, depth.astype(np.float32), instances, labels, camera, pose, held, steps_left, last_result
        )


def walled_room(room: str, x0: float, y0: float, x1: float, y1: float) -> TinyScene:
    """A room with four walls of 2.5 m."""
    thick = 0.1
    return TinyScene(
        {room: (x0, y0, x1, y1)},
        {
            "wall-s": ("Wall", x0 - thick, y0 - thick, 0.0, x1 + thick, y0, 2.5),
            "wall-n": ("Wall", x0 - thick, y1, 0.0, x1 + thick, y1 + thick, 2.5),
            "wall-w": ("Wall", x0 - thick, y0, 0.0, x0, y1, 2.5),
            "wall-e": ("Wall", x1, y0, 0.0, x1 + thick, y1, 2.5),
        },
    )


def _enter(eye: np.ndarray, rays: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Depth at which each ray enters a box, inf where it misses it or starts inside."""
    safe = np.where(np.abs(rays) < 1e-9, 1e-9, rays)
    first, second = (low - eye) / safe, (high - eye) / safe
    entry = np.minimum(first, second).max(-1)
    leave = np.maximum(first, second).min(-1)
    return np.where((entry < leave) & (entry > 0.01), entry, np.inf)
