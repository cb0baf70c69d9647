"""Whether misplaced objects can be seen and reached where they lie."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.dataset.checks.sight import Sight
from adhoc.houses.build import build_solids, object_solid
from adhoc.houses.house import FLOOR, House
from adhoc.houses.solids import Solid
from adhoc.worlds.world import ObjectTruth


class Findable:
    """Accepts an object where a robot can see and reach it, as `evaluation.misplacing.Accept`.

    Objects that were accepted before must stay in sight, and an object on the floor must not cut off any
    place that robots came to before.

    Args:
        house: The house before anything is misplaced in it.
    """

    def __init__(self, house: House) -> None:
        self._house = house
        self._state = _State.of(house)

    def __call__(self, truth: ObjectTruth) -> bool:
        """Whether the object can be found where it is now."""
        after = self._state.with_misplaced(_solid_at(self._house, truth), truth.receptacle == FLOOR)
        if after is None:
            return False
        self._state = after
        return True


@dataclass(frozen=True)
class _State:
    """A house with the objects that were accepted so far."""

    house: House
    solids: dict[str, Solid]
    cells: FreeCells
    sight: Sight
    accepted: tuple[str, ...] = ()

    @classmethod
    def of(cls, house: House) -> _State:
        solids = {solid.id: solid for solid in build_solids(house)}
        cells = FreeCells(house.rooms, list(solids.values()))
        return cls(house, solids, cells, Sight(list(solids.values()), cells))

    def with_misplaced(self, solid: Solid, on_floor: bool) -> _State | None:
        """With one more object at its new place; None if it, or another, could not be found."""
        solids, cells = {**self.solids, solid.id: solid}, self.cells
        if on_floor:
            cells = FreeCells(self.house.rooms, list(solids.values()))
            if np.any(self.cells.connected & cells.free & ~cells.connected):
                return None
        sight, accepted = self.sight.with_moved(solid, cells), (*self.accepted, solid.id)
        if not all(sight.is_seen(name) for name in accepted):
            return None
        return _State(self.house, solids, cells, sight, accepted)


def _solid_at(house: House, truth: ObjectTruth) -> Solid:
    """The object's boxes where it is now."""
    return object_solid(replace(house.object(truth.id), position=truth.position, yaw=truth.yaw))
