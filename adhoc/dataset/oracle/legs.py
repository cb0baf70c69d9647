"""The cost to go of a tour: from every stance, the fewest steps in which one robot does all that is left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.dataset.oracle.fields import FAR, stance_field
from adhoc.dataset.oracle.situation import Situation

Ints = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Leg:
    """One part of a tour: the way to an act, and the act."""

    object_id: str
    picks_up: bool
    value: Ints
    """(cells, 16) the cost of this leg and all later ones."""
    rest: Ints
    """(cells, 16) the cost of the act and all later legs; `FAR` where it cannot be done."""
    moves: Ints
    """(cells, 4) where moves lead during this leg."""
    looks_at: tuple[float, float] | None
    """Where the object lies that is picked up, in metres; None where it is put away."""


class Legs:
    """Makes and keeps the legs of tours in one situation."""

    def __init__(self, situation: Situation) -> None:
        self._situation = situation
        self._known: dict[tuple[float, frozenset[str], tuple[str, ...], bool], tuple[Leg, ...]] = {}
        self._version = situation.version

    def of(
        self, order: Sequence[str], height: float, holds: str | None, lying: frozenset[str]
    ) -> tuple[Leg, ...]:
        """The legs of a tour that brings objects home in that order; one that is held is the first.

        `lying` are the objects that are in the way for as long as this tour has not picked them up.
        """
        if self._situation.version != self._version:
            self._known.clear()
            self._version = self._situation.version
        return self._legs(tuple(order), height, lying & self._situation.lattice.obstacles, holds is None)

    def _legs(
        self, order: tuple[str, ...], height: float, lying: frozenset[str], picks_up: bool
    ) -> tuple[Leg, ...]:
        if not order:
            return ()
        key = (height, lying, order, picks_up)
        if key not in self._known:
            name = order[0]
            if picks_up:
                later = self._legs(order, height, lying - {name}, False)
                allowed = self._situation.picks(name, height)
            else:
                later = self._legs(order[1:], height, lying, True)
                allowed = self._situation.puts(name, height)
            after = later[0].value if later else np.zeros(allowed.shape, np.int32)
            rest = np.where(allowed & (after < FAR), after + 1, FAR).astype(np.int32)
            moves = self._situation.lattice.moves(lying)
            looks_at = self._situation.position(name) if picks_up else None
            leg = Leg(name, picks_up, stance_field(moves, rest), rest, moves, looks_at)
            self._known[key] = (leg, *later)
        return self._known[key]
