"""The boxes of solids as arrays, for the compiled kernels of the dataset's checks."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.houses.solids import Box

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BoxArrays:
    """N upright boxes: `centers` (N, 3) and `halves` (N, 3) in metres, `headings` (N, 2) cosine and sine of
    their yaws, and `owners` (N,), the number of the solid that each belongs to."""

    centers: FloatArray
    halves: FloatArray
    headings: FloatArray
    owners: NDArray[np.int64]

    def reaches(self) -> FloatArray:
        """Half extents (N, 2) of the boxes' axis-aligned outlines on the floor plan, in metres."""
        turned = np.abs(self.headings)
        across = self.halves[:, :1] * turned + self.halves[:, 1:2] * turned[:, ::-1]
        return np.ascontiguousarray(across)

    def bounds(self, count: int) -> FloatArray:
        """Lowest and highest corner (count, 2, 3) of the boxes of each of `count` solids, in metres."""
        reaches = np.column_stack([self.reaches(), self.halves[:, 2]])
        bounds = np.empty((count, 2, 3))
        bounds[:, 0], bounds[:, 1] = math.inf, -math.inf
        np.minimum.at(bounds[:, 0], self.owners, self.centers - reaches)
        np.maximum.at(bounds[:, 1], self.owners, self.centers + reaches)
        return bounds


def box_arrays(boxes_of: Iterable[Iterable[Box]]) -> BoxArrays:
    """The boxes of several solids, numbered in order."""
    rows = [
        (*box.center, *box.half, *_heading(box.yaw), owner)
        for owner, boxes in enumerate(boxes_of)
        for box in boxes
    ]
    table = np.array(rows, np.float64).reshape(-1, 9)
    return BoxArrays(
        np.ascontiguousarray(table[:, :3]),
        np.ascontiguousarray(table[:, 3:6]),
        np.ascontiguousarray(table[:, 6:8]),
        table[:, 8].astype(np.int64),
    )


def _heading(yaw: float) -> tuple[float, float]:
    """Cosine and sine, exact for quarter turns."""
    quarters = yaw / (math.pi / 2)
    if abs(quarters - round(quarters)) < 1e-9:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[round(quarters) % 4]
    return math.cos(yaw), math.sin(yaw)
