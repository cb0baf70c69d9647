"""Frames and angles.

The world frame is right-handed with z up, in metres. Yaw 0 faces +x and grows counter-clockwise;
pitch grows downward, so pitch pi/6 looks at the floor ahead. Camera frames follow the computer-vision
habit: x right, y down, z forward; depth is measured along z.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Camera, Pose

FloatArray = NDArray[np.float64]


def wrap_angle(angle: float) -> float:
    """The same angle in (-pi, pi]."""
    wrapped = math.fmod(angle + math.pi, 2 * math.pi)
    if wrapped <= 0:
        wrapped += 2 * math.pi
    return wrapped - math.pi


def planar_distance(first: Pose | tuple[float, ...], second: Pose | tuple[float, ...]) -> float:
    """Distance in the floor plane, of poses or of (x, y, ...) points, in metres."""
    ax, ay = (first.x, first.y) if isinstance(first, Pose) else first[:2]
    bx, by = (second.x, second.y) if isinstance(second, Pose) else second[:2]
    return math.hypot(ax - bx, ay - by)


def intrinsics(width: int, height: int, field_of_view: float) -> FloatArray:
    """The (3, 3) pinhole matrix of a `width` x `height` picture; `field_of_view` is vertical, in radians.

    The principal point (width / 2, height / 2 - 1) is where PyBullet's TinyRenderer samples.
    """
    focal = height / 2 / math.tan(field_of_view / 2)
    return np.array([[focal, 0.0, width / 2], [0.0, focal, height / 2 - 1], [0.0, 0.0, 1.0]])


def world_from_camera(pose: Pose, camera_height: float) -> FloatArray:
    """The (4, 4) transform from camera to world coordinates of a robot's camera at `pose`."""
    cos_yaw, sin_yaw = math.cos(pose.yaw), math.sin(pose.yaw)
    cos_pitch, sin_pitch = math.cos(pose.pitch), math.sin(pose.pitch)
    forward = (cos_yaw * cos_pitch, sin_yaw * cos_pitch, -sin_pitch)
    right = (sin_yaw, -cos_yaw, 0.0)
    down = (-cos_yaw * sin_pitch, -sin_yaw * sin_pitch, -cos_pitch)
    transform = np.eye(4)
    transform[:3, 0] = right
    transform[:3, 1] = down
    transform[:3, 2] = forward
    transform[:3, 3] = (pose.x, pose.y, camera_height)
    return transform


def camera_at(pose: Pose, camera_height: float, matrix: FloatArray) -> Camera:
    """The camera of a robot that stands at `pose` and carries it at `camera_height` metres."""
    return Camera(matrix, world_from_camera(pose, camera_height))
