"""The house at one moment of a run: what is left to carry, and from where it can be taken and put."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.oracle.drops import Drops
from adhoc.dataset.oracle.fields import FAR, cell_field
from adhoc.dataset.oracle.knowledge import NOTHING_REFUSED, HouseKnowledge, Refusals, Rules
from adhoc.dataset.oracle.lattice import Lattice
from adhoc.dataset.oracle.stances import AIMS
from adhoc.dataset.oracle.vacancy import has_room
from adhoc.dataset.oracle.views import Mask, Views
from adhoc.houses.facts import is_reasonable
from adhoc.houses.house import FLOOR
from adhoc.houses.solids import Solid, SolidKind
from adhoc.worlds.world import ObjectTruth

_NEAR_DROP = 1.0
"""Metres around a place where dropping would do harm in which other places are tested too."""


class Situation:
    """The house at one moment: what is left to carry, from where it is seen, and where it may be put.

    Args:
        house: the house.
        truth: where every object is.
        tracked: the misplaced objects that are still to be carried, in order.
        rules: of the world.
        refusals: what is not to be tried.
        stuck: points where robots stand that will never move again.
        stands: points where all robots stand.
    """

    def __init__(
        self,
        house: HouseKnowledge,
        truth: Mapping[str, ObjectTruth],
        tracked: Sequence[str],
        rules: Rules,
        refusals: Refusals = NOTHING_REFUSED,
        stuck: Sequence[tuple[float, float]] = (),
        stands: Sequence[tuple[float, float]] = (),
    ) -> None:
        self.house = house
        self.rules = rules
        self.objects = tuple(tracked)
        self.lying = tuple(name for name in tracked if truth[name].holder is None)
        self._refusals = refusals
        self._truth = truth
        solids = self._present(truth)
        loose = {solid.id: solid for solid in solids if solid.id in self.lying}
        fixed = [solid for solid in solids if solid.id not in loose]
        self.lattice = Lattice(house.rooms, fixed, loose, stands)
        self._close(stuck)
        self._floors = [solid.id for solid in solids if solid.kind is SolidKind.FLOOR]
        rooms = house.room_of | {name: house.room_index(truth[name].room) for name in self.lying}
        self._views = Views(solids, self.lying, rooms, house.walls, self.lattice, rules)
        self._gazes: dict[tuple[str, float], Mask] = {}
        self._puts: dict[tuple[str, float], Mask] = {}
        self._targets: dict[tuple[str, float], tuple[str, ...]] = {}
        self._drop_masks: dict[str, Mask] = {}
        self._drop_places: dict[str, Drops] = {}
        self._ranked: dict[str, list[Solid]] = {}
        self.version = 0
        """Counts the stances that turned out to be wrong."""

    def position(self, object_id: str) -> tuple[float, float]:
        """Where the object lies, or the robot that holds it stands, on the floor plan."""
        x, y, _ = self._truth[object_id].position
        return x, y

    def picks(self, object_id: str, height: float) -> Mask:
        """The stances (cells, 16) from which a robot can pick the object up where it lies."""
        return self._seen(object_id, height)

    def puts(self, object_id: str, height: float) -> Mask:
        """The stances (cells, 16) from which a robot that holds the object can put it into a right place."""
        key = (object_id, height)
        if key not in self._puts:
            mask = self._drops(object_id)
            for target in self.targets(object_id, height):
                mask = mask | self._seen(target, height)
            self._puts[key] = mask
        return self._puts[key]

    def target_at(self, object_id: str, height: float, stance: int) -> str:
        """The receptacle, or `Floor`, for which a stance of `puts` is good."""
        cell, aim = divmod(stance, AIMS)
        for target in self.targets(object_id, height):
            if self._seen(target, height)[cell, aim]:
                return target
        return FLOOR

    def targets(self, object_id: str, height: float) -> tuple[str, ...]:
        """The receptacles for the object, nearest first: those with room that can be seen from somewhere."""
        key = (object_id, height)
        if key not in self._targets:
            chosen: list[str] = []
            for solid in self._ranked_receptacles(object_id):
                if len(chosen) == self.rules.receptacles:
                    break
                if self._has_room(object_id, solid) and self._seen(solid.id, height).any():
                    chosen.append(solid.id)
            self._targets[key] = tuple(chosen)
        return self._targets[key]

    def near(self, object_id: str) -> Mask:
        """The cells (cells,) within reach of the object, whether it is seen from there or not; cells that a
        wall parts from it are left out."""
        return self._views.reached(object_id)

    def near_places(self, object_id: str) -> Mask:
        """The cells (cells,) within reach of any right place for the object, seen or not, full or not."""
        mask = self._right_rooms(object_id)
        for solid in self.house.receptacles_for(self._category(object_id)):
            mask |= self._views.reached(solid.id)
        return mask

    def is_seen(self, target: str, height: float, stance: int) -> bool:
        """Whether the picture really shows the target within reach, by the world's own sensor; if not, the
        stance is not offered again."""
        if self._views.confirm(target, height, stance):
            return True
        self._forget_puts()
        return False

    def is_droppable(self, object_id: str, stance: int) -> bool:
        """Whether an object that is dropped from there lies in nobody's way for ever.

        If it does, that stance, and others near it that are no better, are not offered again.
        """
        drops = self._drops_of(object_id)
        if drops.are_harmless(stance):
            return True
        mask = self._drops(object_id)
        points = self.lattice.points
        close = np.hypot(*(points - points[stance // AIMS]).T) <= _NEAR_DROP
        for other in np.flatnonzero(mask & close[:, None]).tolist():
            mask[divmod(other, AIMS)] = drops.are_harmless(other)
        self._forget_puts()
        return False

    def _forget_puts(self) -> None:
        self._puts.clear()
        self.version += 1

    def _drops_of(self, object_id: str) -> Drops:
        if object_id not in self._drop_places:
            boxes = self._views.without(object_id, *self._floors)
            half = self.house.shape(object_id)[0].half
            self._drop_places[object_id] = Drops(self.lattice, self.house.rooms, boxes, half)
        return self._drop_places[object_id]

    def _seen(self, target: str, height: float) -> Mask:
        key = (target, height)
        if key not in self._gazes:
            self._gazes[key] = self._without_refused(self._views.of(target, height), target, height)
        return self._gazes[key]

    def _present(self, truth: Mapping[str, ObjectTruth]) -> list[Solid]:
        """All solids where they are now, without those in hands."""
        present = []
        for solid in self.house.solids:
            where = truth.get(solid.id)
            if where is None:
                present.append(solid)
            elif where.holder is None:
                at_home = self.house.shape(solid.id)[1].center == where.position
                present.append(solid if at_home else self.house.moved(solid, where))
        return present

    def _drops(self, object_id: str) -> Mask:
        """The stances from which the object may be dropped: those in rooms on whose floor it belongs."""
        if object_id not in self._drop_masks:
            mask = np.repeat(self._right_rooms(object_id)[:, None], AIMS, axis=1)
            self._drop_masks[object_id] = self._without_refused(mask, FLOOR, None)
        return self._drop_masks[object_id]

    def _right_rooms(self, object_id: str) -> Mask:
        """The cells (cells,) in rooms on whose floor the object belongs."""
        category = self._category(object_id)
        right = np.array([is_reasonable(category, FLOOR, kind) for kind in self.house.room_types])
        return np.asarray(right[self.lattice.room])

    def _without_refused(self, mask: Mask, target: str, height: float | None) -> Mask:
        for name, tall, x, y, aim in self._refusals.stances:
            cell = self.lattice.cell_at(x, y)
            if name == target and height in (tall, None) and cell is not None:
                mask[cell, aim] = False
        return mask

    def _close(self, stuck: Sequence[tuple[float, float]]) -> None:
        """Nobody enters where a robot stands for ever, nor tries a move again that was refused."""
        lattice = self.lattice
        stands = [cell for x, y in stuck if (cell := lattice.cell_at(x, y)) is not None]
        steps = [
            (cell, move) for x, y, move in self._refusals.steps if (cell := lattice.cell_at(x, y)) is not None
        ]
        lattice.close((cell for stand in stands for cell in lattice.near[stand] if cell >= 0), steps)

    def _ranked_receptacles(self, object_id: str) -> list[Solid]:
        """All receptacles where the object belongs, by the way from it or from the robot that holds it."""
        if object_id not in self._ranked:
            found = self.house.receptacles_for(self._category(object_id))
            starts = np.where(self._beside(object_id), 0, FAR).astype(np.int32)
            away, _ = cell_field(self.lattice.moves(()), starts, np.zeros(len(starts), np.int32))
            lengths = [self._way(solid.id, away) for solid in found]
            self._ranked[object_id] = [found[index] for index in np.argsort(lengths, kind="stable")]
        return self._ranked[object_id]

    def _beside(self, object_id: str) -> Mask:
        if object_id in self.lying:
            return self.near(object_id)
        beside: Mask = np.hypot(*(self.lattice.points - self.position(object_id)).T) < 1e-3
        return beside

    def _way(self, solid_id: str, away: NDArray[np.int32]) -> int:
        close = self._views.reached(solid_id)
        return int(away[close].min()) if close.any() else FAR

    def _has_room(self, object_id: str, receptacle: Solid) -> bool:
        if (object_id, receptacle.id) in self._refusals.receptacles:
            return False
        others = self._views.without(object_id)
        return has_room(self.house.shape(object_id)[0].half, receptacle.surfaces, others)

    def _category(self, object_id: str) -> str:
        return self.house.things[object_id].category
