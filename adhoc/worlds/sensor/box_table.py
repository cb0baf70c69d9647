"""The boxes of a scene as arrays, the form in which the ray-caster reads them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from adhoc.houses.solids import Box


class Layer(IntEnum):
    """Which pass of the sensor draws a box. The values are bits, so that passes can be combined."""

    HIDDEN = 0
    """Drawn by no pass: an object in a robot's hand."""
    STATIC = 1
    """Has not moved since the scene was loaded; pictures of this layer can be cached."""
    MOVED = 2
    """Robots, and objects that have moved at least once."""


class BoxTable:
    """Every box of a scene, one row a box; the rows of one instance lie next to each other.

    Attributes:
        centers: (N, 3) float64, metres.
        halves: (N, 3) float64, half extents in metres.
        headings: (N, 2) float64, cosine and sine of the yaw.
        instances: (N,) int32, the instance that the box belongs to.
        layers: (N,) uint8, see `Layer`.
    """

    def __init__(self) -> None:
        self.centers: NDArray[np.float64] = np.zeros((0, 3))
        self.halves: NDArray[np.float64] = np.zeros((0, 3))
        self.headings: NDArray[np.float64] = np.zeros((0, 2))
        self.instances: NDArray[np.int32] = np.zeros(0, np.int32)
        self.layers: NDArray[np.uint8] = np.zeros(0, np.uint8)
        self._rows: list[slice] = []

    @property
    def instance_count(self) -> int:
        """Number of instances; they are numbered from 0 in the order of adding."""
        return len(self._rows)

    def add(self, instances: Sequence[Sequence[Box]], layer: Layer) -> None:
        """Append instances, each given by its boxes; they get the next numbers in order."""
        if not instances:
            return
        first_row, first_instance = len(self.instances), len(self._rows)
        numbers = [first_instance + offset for offset, boxes in enumerate(instances) for _ in boxes]
        for boxes in instances:
            self._rows.append(slice(first_row, first_row + len(boxes)))
            first_row += len(boxes)
        flat = [box for boxes in instances for box in boxes]
        self.centers = np.concatenate([self.centers, _rows([box.center for box in flat], 3)])
        self.halves = np.concatenate([self.halves, _rows([box.half for box in flat], 3)])
        self.headings = np.concatenate([self.headings, _rows([_heading(box) for box in flat], 2)])
        self.instances = np.concatenate([self.instances, np.array(numbers, np.int32)])
        self.layers = np.concatenate([self.layers, np.full(len(flat), layer, np.uint8)])

    def place(self, instance: int, boxes: Sequence[Box], layer: Layer) -> None:
        """Overwrite an instance's boxes, as many as it was added with, and its layer."""
        rows = self._rows[instance]
        for row, box in zip(range(rows.start, rows.stop), boxes, strict=True):
            self.centers[row] = box.center
            self.headings[row] = _heading(box)
            self.halves[row] = box.half
        self.layers[rows] = layer

    def set_layer(self, instance: int, layer: Layer) -> None:
        """Move an instance to another layer, without moving it in space."""
        self.layers[self._rows[instance]] = layer

    def layer(self, instance: int) -> Layer:
        """The layer of an instance (`HIDDEN` if it has no boxes)."""
        rows = self._rows[instance]
        return Layer(int(self.layers[rows.start])) if rows.stop > rows.start else Layer.HIDDEN


def _rows(values: Sequence[Sequence[float]], width: int) -> NDArray[np.float64]:
    return np.array(values, np.float64).reshape(-1, width)


def _heading(box: Box) -> tuple[float, float]:
    return math.cos(box.yaw), math.sin(box.yaw)
