"""From where things in the house are seen and reached, at one moment."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.checks.box_arrays import BoxArrays, box_arrays
from adhoc.dataset.oracle.gazes import gazes
from adhoc.dataset.oracle.knowledge import Rules
from adhoc.dataset.oracle.lattice import Lattice
from adhoc.dataset.oracle.reach import Walls, within_reach
from adhoc.dataset.oracle.stances import AIMS, pose_of
from adhoc.houses.solids import Solid
from adhoc.worlds.sensor.box_sensor import BoxSensor
from adhoc.worlds.sensor.box_table import BoxTable, Layer
from adhoc.worlds.sensor.visibility import survey

Mask = NDArray[np.bool_]

_FEW_CELLS = 8
"""An object that is seen from fewer cells than this is looked at from all cells around it: rays at a grid of
points may miss what little can be seen."""
_MOST_MISSES = 3
"""After so many stances that show nothing, all stances of a target are tried."""


class Views:
    """Stances from which solids are seen within reach, by rays, and checks of single ones by the sensor.

    Args:
        solids: everything that is not in a hand.
        small: the ids of what robots pick up; little of it may be seen.
        rooms: the room of each solid, as the lattice counts rooms.
        walls: of the house.
        lattice: the cells.
        rules: of the world.
    """

    def __init__(
        self,
        solids: Sequence[Solid],
        small: Collection[str],
        rooms: Mapping[str, int],
        walls: Walls,
        lattice: Lattice,
        rules: Rules,
    ) -> None:
        self._solids = {solid.id: solid for solid in solids}
        self._small = small
        self._rooms = rooms
        self._walls = walls
        self._lattice = lattice
        self._rules = rules
        self._numbers = {solid.id: number for number, solid in enumerate(solids)}
        self._boxes = box_arrays(solid.boxes for solid in solids)
        self._table = BoxTable()
        self._table.add([solid.boxes for solid in solids], Layer.STATIC)
        self._sensor = BoxSensor(self._table, rules.image_size, np.pi / 2, 0)
        self._gazes: dict[tuple[str, float], Mask] = {}
        self._reaches: dict[str, Mask] = {}
        self._misses: Counter[tuple[str, float]] = Counter()

    def of(self, target: str, height: float) -> Mask:
        """The stances (cells, 16) from which a camera at `height` metres sees the target within reach.

        Changed in place by `confirm`, and by the caller that knows better.
        """
        key = (target, height)
        if key not in self._gazes:
            self._gazes[key] = self._look_for(target, height)
        return self._gazes[key]

    def reached(self, target: str) -> Mask:
        """The cells (cells,) within reach of a solid: those of its own room, and others that no wall parts
        from it."""
        if target not in self._reaches:
            boxes, points = self._solids[target].boxes, self._lattice.points
            near = within_reach(boxes, points, self._rules.reach)
            beyond = np.flatnonzero(near & (self._lattice.room != self._rooms.get(target, -1)))
            near[beyond[self._walls.hide(boxes, points[beyond])]] = False
            self._reaches[target] = near
        return self._reaches[target]

    def without(self, *targets: str) -> BoxArrays:
        """The boxes of everything but some solids."""
        owners = [self._numbers[target] for target in targets if target in self._numbers]
        kept = ~np.isin(self._boxes.owners, owners)
        boxes = self._boxes
        return BoxArrays(boxes.centers[kept], boxes.halves[kept], boxes.headings[kept], boxes.owners[kept])

    def confirm(self, target: str, height: float, stance: int) -> bool:
        """Whether the picture really shows the target within reach, by the world's own sensor.

        If it does not, the stance is struck out; a target that was missed several times is looked at from
        all its stances.
        """
        if self._is_in_picture(target, height, stance):
            return True
        mask = self.of(target, height)
        mask[divmod(stance, AIMS)] = False
        self._misses[target, height] += 1
        if self._misses[target, height] == _MOST_MISSES:
            self._keep_what_shows(target, height, mask)
        return False

    def _look_for(self, target: str, height: float) -> Mask:
        boxes, points, reach = self._solids[target].boxes, self._lattice.points, self._rules.reach
        mask = np.zeros((len(self._lattice), AIMS), np.bool_)
        close = np.flatnonzero(within_reach(boxes, points, reach))
        if len(close):
            mask[close] = gazes(boxes, self.without(target), points[close], height, reach)
            if target in self._small and mask.any(axis=1).sum() < _FEW_CELLS:
                mask[self.reached(target)] = True
                self._keep_what_shows(target, height, mask)
        return mask

    def _keep_what_shows(self, target: str, height: float, mask: Mask) -> None:
        for stance in np.flatnonzero(mask).tolist():
            mask[divmod(stance, AIMS)] = self._is_in_picture(target, height, stance)

    def _is_in_picture(self, target: str, height: float, stance: int) -> bool:
        cell, aim = divmod(stance, AIMS)
        x, y = self._lattice.points[cell].tolist()
        frame = self._sensor.look(pose_of((x, y), aim), height, -1)
        _, nearest = survey(frame, self._table.instance_count)
        return bool(nearest[self._numbers[target]] <= self._rules.reach)
