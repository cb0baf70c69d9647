"""What robots can see and reach in a house, and from where, without a simulator."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from adhoc.dataset.checks.box_arrays import BoxArrays, FloatArray, box_arrays
from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.dataset.checks.sight_rays import horizontal_distances, is_in_a_picture
from adhoc.houses.solids import Solid

HEIGHTS = (0.9, 1.6)
"""Camera heights in metres that stand for low and tall robots."""

_SAFETY = 1e-4
"""Metres that a seen point is nearer than the reach, since a sensor rounds its depth."""


class Sight:
    """Where a robot sees things that are in its reach.

    A thing is seen where a robot at a connected cell has a picture with a pixel that shows it, no further
    away than `reach`: rays are cast through the very pixels of `PyBulletWorld`'s camera of 128 x 128 pixels
    and 90 degrees, in its steps of yaw and tilt, so that what is seen here is seen there. The reverse may
    fail: large things are sampled at 12 x 12 pixels of a picture, and robots in the way are not known.

    Args:
        solids: everything in the house.
        cells: where robots can stand.
        heights: of cameras, in metres.
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
        return bool(
            is_in_a_picture(
                self._eyes(number),
                self._bounds[number],
                self._table,
                self._boxes.owners,
                number,
                self._reach - _SAFETY,
            )
        )

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
        self._places = (np.argwhere(cells.connected) + np.array(cells.origin)) * cells.grid_size
        self._rooms = cells.room[cells.connected]

    def _show(self, boxes: BoxArrays) -> None:
        self._boxes = boxes
        self._table = np.concatenate([boxes.centers, boxes.halves, boxes.headings], axis=1)
        self._bounds = boxes.bounds(len(self._numbers))

    def _eyes(self, number: int) -> FloatArray:
        """The camera positions (E, 3) from which it could be in reach: in its room first, then nearest."""
        own = self._table[self._boxes.owners == number]
        distances = horizontal_distances(self._places, own, self._reach)
        around = np.flatnonzero(distances <= self._reach)
        here = self._cells.room_at(*self._bounds[number, :, :2].mean(axis=0))
        beyond_walls = self._rooms[around] != here
        around = around[np.lexsort((distances[around], beyond_walls))]
        eyes = np.empty((len(around), len(self._heights), 3))
        eyes[:, :, :2] = self._places[around, None]
        eyes[:, :, 2] = self._heights
        return eyes.reshape(-1, 3)
