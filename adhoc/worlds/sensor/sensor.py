"""The contract of a sensor: what a camera in the scene sees."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Camera, Pose


@dataclass(frozen=True, eq=False)
class Frame:
    """One picture. The arrays are read-only: frames of the same place may share them.

    depth (H, W) float32, metres along the optical axis, inf where nothing is hit;
    instances (H, W) int32, -1 where nothing is hit.
    """

    depth: NDArray[np.float32]
    instances: NDArray[np.int32]
    visible: frozenset[int]
    """The instances with at least one pixel."""
    camera: Camera


class Sensor(ABC):
    """Takes pictures of one scene."""

    @abstractmethod
    def look(self, pose: Pose, camera_height: float, own_instance: int) -> Frame:
        """What a robot sees at `pose` with its camera `camera_height` metres above the floor.

        `own_instance`, the robot's own body, is not in the picture; -1 if there is none.
        """

    @abstractmethod
    def forget(self, instance: int) -> None:
        """Drop whatever was stored of an instance: it is about to move, for the first time or again."""
