"""What robots can see and reach in a house, and from where, without a simulator."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.checks.box_arrays import BoxArrays, FloatArray, box_arrays
from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.dataset.checks.sight_rays import LOOK_NUMBERS, horizontal_distances, search_views
from adhoc.houses.solids import Solid

HEIGHTS = (0.9, 1.6)
"""Camera heights in metres that stand for low and tall robots."""

_SAFETY = 1e-4
"""Metres that a seen point is nearer than the reach, since a sensor rounds its depth."""


class Look(NamedTuple):
    """How a robot sees a thing, in radians and metres: at this yaw and pitch it is in the picture."""

    yaw: float
    """Of the robot: a multiple of 90 degrees."""
    pitch: float
    """Of the camera, down being positive: a multiple of 30 degrees."""
    azimuth: float
    """Direction of the seen point on the floor plan."""
    elevation: float
    """Its angle above the horizon of the camera."""
    distance: float
    """Horizontal distance from the robot's axis to the seen point."""


class Sight:
    """Where a robot sees things that are in its reach.

    A thing is seen where a robot at a connected cell has a picture with a pixel that shows it, no further
    away than `reach`: rays are cast through the very pixels of `PyBulletWorld`'s camera of 128 x 128 pixels
    and 90 degrees, in its steps of yaw and tilt, so that what is seen here is seen there. The reverse may
    fail: large things are sampled at 12 x 12 pixels of a picture, and robots in the way are not known.

    Args:
        solids: everything in the house.
        cells: where robots can stand.
        heights: of cameras, in metres, for `is_seen`.
        reach: metres.
    """

    def __init__(
        self,
        solids: Sequence[Solid],
        cells: FreeCells,
        heights: Sequence[float] = HEIGHTS,
        reach: float = 1.5,
    ) -> None:
        self._heights = tuple(heights)
        self._reach = reach
        self._numbers = {solid.id: number for number, solid in enumerate(solids)}
        self._stand_in(cells)
        self._show(box_arrays(solid.boxes for solid in solids))

    def is_seen(self, solid_id: str) -> bool:
        """Whether a robot of one of the `heights` sees and reaches it. Raises KeyError for an unknown id."""
        number = self._numbers[solid_id]
        cells, eyes = self._eyes(number, self._heights)
        here = self._cells.room_at(*self._bounds[number, :, :2].mean(axis=0))
        beyond_walls = self._cells.room[cells[:, 0], cells[:, 1]] != here
        seen, _ = self._search(number, eyes[np.argsort(beyond_walls, kind="stable")], at_first=True)
        return bool(seen.any())

    def viewpoints(self, solid_id: str, height: float) -> list[tuple[int, int]]:
        """The cells from which a robot whose camera is at `height` metres sees and reaches it, nearest first.

        Raises KeyError for an unknown id.
        """
        cells, eyes = self._eyes(self._numbers[solid_id], (height,))
        seen, _ = self._search(self._numbers[solid_id], eyes, at_first=False)
        return [(int(i), int(j)) for i, j in cells[seen]]

    def look(self, solid_id: str, height: float, cell: tuple[int, int]) -> Look | None:
        """How a robot at the cell, its camera at `height` metres, sees and reaches it; None if it does not.

        Raises KeyError for an unknown id.
        """
        x, y = self._cells.point(*cell)
        seen, looks = self._search(self._numbers[solid_id], np.array([[x, y, height]]), at_first=True)
        return Look(*looks[0].tolist()) if seen[0] else None

    def aim(self, solid_id: str, height: float, cell: tuple[int, int]) -> tuple[float, float] | None:
        """Azimuth and elevation in radians of the point that `look` finds; None if it finds none."""
        look = self.look(solid_id, height, cell)
        return None if look is None else (look.azimuth, look.elevation)

    def with_moved(self, solid: Solid, cells: FreeCells | None = None) -> Sight:
        """The same house with one thing elsewhere; `cells`, if robots then fit elsewhere.

        Raises KeyError if the house has no solid of that id.
        """
        number = self._numbers[solid.id]
        stay = self._boxes.owners != number
        moved = box_arrays([solid.boxes])
        sight = Sight.__new__(Sight)
        sight._heights, sight._reach, sight._numbers = self._heights, self._reach, self._numbers
        sight._stand_in(self._cells if cells is None else cells)
        sight._show(
            BoxArrays(
                np.concatenate([self._boxes.centers[stay], moved.centers]),
                np.concatenate([self._boxes.halves[stay], moved.halves]),
                np.concatenate([self._boxes.headings[stay], moved.headings]),
                np.concatenate([self._boxes.owners[stay], moved.owners + number]),
            )
        )
        return sight

    def _stand_in(self, cells: FreeCells) -> None:
        self._cells = cells
        self._indices = np.argwhere(cells.connected)
        self._places = (self._indices + np.array(cells.origin)) * cells.grid_size

    def _show(self, boxes: BoxArrays) -> None:
        self._boxes = boxes
        self._table = np.concatenate([boxes.centers, boxes.halves, boxes.headings], axis=1)
        self._bounds = boxes.bounds(len(self._numbers))

    def _eyes(self, number: int, heights: Sequence[float]) -> tuple[NDArray[np.int64], FloatArray]:
        """The cells (E, 2) and camera positions (E, 3) from which it could be in reach, nearest first."""
        own = self._table[self._boxes.owners == number]
        distances = horizontal_distances(self._places, own, self._reach)
        around = np.flatnonzero(distances <= self._reach)
        around = around[np.argsort(distances[around], kind="stable")]
        chosen = np.repeat(around, len(heights))
        eyes = np.empty((len(chosen), 3))
        eyes[:, :2] = self._places[chosen]
        eyes.reshape(-1, len(heights), 3)[:, :, 2] = heights
        return self._indices[chosen], eyes

    def _search(self, number: int, eyes: FloatArray, at_first: bool) -> tuple[NDArray[np.bool_], FloatArray]:
        seen = np.zeros(len(eyes), np.bool_)
        looks = np.zeros((len(eyes), LOOK_NUMBERS))
        search_views(
            eyes,
            self._bounds[number],
            self._table,
            self._boxes.owners,
            number,
            self._reach - _SAFETY,
            at_first,
            seen,
            looks,
        )
        return seen, looks
