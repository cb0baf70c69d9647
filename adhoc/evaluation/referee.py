"""Ground truth: which misplaced objects are back in a reasonable place. No policy ever meets the referee."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

from adhoc.evaluation.scenario import Scenario
from adhoc.houses.facts import is_reasonable
from adhoc.worlds.world import ObjectTruth, World

PlaceRule = Callable[[ObjectTruth, str], bool]
"""Whether an object is in a right place, given the type of the room it is in."""


def in_reasonable_place(truth: ObjectTruth, room_type: str) -> bool:
    """The rule of tidying up: the object lies in or on a receptacle where such objects belong."""
    if truth.receptacle_category is None:
        return False
    return is_reasonable(truth.category, truth.receptacle_category, room_type)


class Referee(ABC):
    """Says which of the objects that an episode is about are dealt with; a task may bring its own."""

    @property
    @abstractmethod
    def watched(self) -> tuple[str, ...]:
        """The ids of the objects that the episode is about, at least one."""

    @abstractmethod
    def replaced(self) -> tuple[str, ...]:
        """The ids of those that are dealt with now; the episode succeeds when all are."""


RefereeMaker = Callable[[World, Scenario], Referee]
"""Makes the referee of one episode, e.g. a class of that constructor."""


class PlacementReferee(Referee):
    """Watches the misplaced objects of one scenario in the world that it runs in.

    An object that a robot holds, or that lies in no room, is never in place. `rule` says what a right
    place is.
    """

    def __init__(self, world: World, scenario: Scenario, rule: PlaceRule = in_reasonable_place) -> None:
        self._world = world
        self._watched = tuple(displacement.object_id for displacement in scenario.misplaced)
        self._room_types = {room.id: room.room_type for room in scenario.house.rooms}
        self._rule = rule

    @property
    def watched(self) -> tuple[str, ...]:
        """The ids of the misplaced objects."""
        return self._watched

    def replaced(self) -> tuple[str, ...]:
        """The ids of the misplaced objects that are in a right place now."""
        truth = self._world.truth()
        return tuple(object_id for object_id in self._watched if self._is_placed(truth[object_id]))

    def _is_placed(self, truth: ObjectTruth) -> bool:
        if truth.holder is not None or truth.room not in self._room_types:
            return False
        return self._rule(truth, self._room_types[truth.room])
