"""The fast sensor: ray-casting with a cache of the static layer."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from adhoc.core.geometry import camera_at, intrinsics
from adhoc.core.values import Camera, Pose
from adhoc.worlds.sensor.box_table import BoxTable, Layer
from adhoc.worlds.sensor.frame_cache import FrameCache
from adhoc.worlds.sensor.occlusion import may_show
from adhoc.worlds.sensor.ray_casting import cast_boxes
from adhoc.worlds.sensor.sensor import Frame, Sensor
from adhoc.worlds.sensor.visibility import visible_instances


class BoxSensor(Sensor):
    """Casts rays at the boxes of a table.

    The static layer is drawn once per exact pose and camera height and then kept (see `FrameCache`); the
    moved layer is drawn over it with a depth test. The picture is bit-identical to drawing everything anew.
    When an object leaves the static layer, only the stored frames that show it are dropped.

    Args:
        table: the boxes of the scene; changed by its owner while the sensor is in use.
        image_size: width and height in pixels.
        field_of_view: radians, horizontal and vertical.
        cache_bytes: memory for stored frames; 0 draws every frame anew.
    """

    def __init__(self, table: BoxTable, image_size: int, field_of_view: float, cache_bytes: int) -> None:
        self._table = table
        self._shape = (image_size, image_size)
        self._intrinsics = intrinsics(image_size, image_size, field_of_view)
        self.cache = FrameCache(cache_bytes)

    def look(self, pose: Pose, camera_height: float, own_instance: int) -> Frame:
        key = (pose.x, pose.y, pose.yaw, pose.pitch, camera_height)
        static = self.cache.get(key)
        if static is None:
            static = self._static_frame(camera_at(pose, camera_height, self._intrinsics))
            self.cache.put(key, static)
        if not self._may_show(Layer.MOVED, own_instance, static):
            return static
        depth, instances = static.depth.copy(), static.instances.copy()
        if not self._cast(Layer.MOVED, own_instance, static.camera, depth, instances):
            return static
        return self._frame(depth, instances, static.camera)

    def forget(self, instance: int) -> None:
        self.cache.drop_showing(instance)

    def _static_frame(self, camera: Camera) -> Frame:
        depth = np.full(self._shape, math.inf, np.float32)
        instances = np.full(self._shape, -1, np.int32)
        self._cast(Layer.STATIC, -1, camera, depth, instances)
        return self._frame(depth, instances, camera)

    def _may_show(self, layers: int, own_instance: int, frame: Frame) -> bool:
        table = self._table
        shows: bool = may_show(
            table.centers,
            table.halves,
            table.instances,
            table.layers,
            int(layers),
            own_instance,
            frame.camera.intrinsics,
            frame.camera.world_from_camera,
            frame.depth,
        )
        return shows

    def _cast(
        self,
        layers: int,
        own_instance: int,
        camera: Camera,
        depth: NDArray[np.float32],
        instances: NDArray[np.int32],
    ) -> int:
        table = self._table
        written: int = cast_boxes(
            table.centers,
            table.halves,
            table.headings,
            table.instances,
            table.layers,
            int(layers),
            own_instance,
            camera.intrinsics,
            camera.world_from_camera,
            depth,
            instances,
        )
        return written

    def _frame(self, depth: NDArray[np.float32], instances: NDArray[np.int32], camera: Camera) -> Frame:
        depth.flags.writeable = False
        instances.flags.writeable = False
        return Frame(depth, instances, visible_instances(instances, self._table.instance_count), camera)
