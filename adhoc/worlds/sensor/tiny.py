"""The reference sensor: PyBullet's TinyRenderer, which also takes colour pictures."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from adhoc.core.geometry import camera_at, intrinsics
from adhoc.core.values import Camera, Pose
from adhoc.worlds.bullet import Bullet
from adhoc.worlds.sensor.sensor import Frame, Sensor
from adhoc.worlds.sensor.visibility import visible_instances

NEAR = 0.05
FAR = 100.0
"""Clip planes in metres: as close to each other as houses allow, for the sake of depth resolution."""


class TinySensor(Sensor):
    """Draws the bodies of a PyBullet client.

    Args:
        bullet: the client with the scene's bodies, each with a visual shape.
        instance_of_body: (highest body number + 1,) the instance of each body; asked at every look, since
            bodies come and go.
        bodies_of: the bodies of an instance.
        image_size: width and height in pixels.
        field_of_view: radians, horizontal and vertical.
    """

    def __init__(
        self,
        bullet: Bullet,
        instance_of_body: Callable[[], NDArray[np.int32]],
        bodies_of: Callable[[int], Sequence[int]],
        image_size: int,
        field_of_view: float,
    ) -> None:
        self._bullet = bullet
        self._instance_of_body = instance_of_body
        self._bodies_of = bodies_of
        self._size = image_size
        self._intrinsics = intrinsics(image_size, image_size, field_of_view)
        self._projection = bullet.projection(field_of_view, NEAR, FAR)

    def look(self, pose: Pose, camera_height: float, own_instance: int) -> Frame:
        camera = camera_at(pose, camera_height, self._intrinsics)
        _, buffer, bodies = self._picture(camera, own_instance)
        instance_of_body = self._instance_of_body()
        instances = np.where(bodies >= 0, instance_of_body[bodies], -1).astype(np.int32)
        along_axis = FAR * NEAR / (FAR - (FAR - NEAR) * buffer.astype(np.float64))
        depth = np.where(instances >= 0, along_axis, math.inf).astype(np.float32)
        depth.flags.writeable = False
        instances.flags.writeable = False
        visible = visible_instances(instances, int(instance_of_body.max(initial=-1)) + 1)
        return Frame(depth, instances, visible, camera)

    def forget(self, instance: int) -> None:
        pass

    def photograph(self, pose: Pose, camera_height: float, own_instance: int) -> NDArray[np.uint8]:
        """The colour picture (H, W, 3) of what `look` returns at the same pose."""
        colours, _, _ = self._picture(camera_at(pose, camera_height, self._intrinsics), own_instance)
        return np.ascontiguousarray(colours[:, :, :3])

    def _picture(
        self, camera: Camera, own_instance: int
    ) -> tuple[NDArray[np.uint8], NDArray[np.float32], NDArray[np.int64]]:
        own_bodies = self._bodies_of(own_instance) if own_instance >= 0 else ()
        with self._bullet.set_aside(own_bodies):
            return self._bullet.picture(camera.world_from_camera, self._projection, self._size)
