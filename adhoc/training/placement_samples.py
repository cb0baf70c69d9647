"""Examples for detector and predictor: the metadata of what lies where in training houses.

Ground truth are the object placement constraints (`houses.facts.is_reasonable`), as in the paper.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from adhoc.agents.learned import vocabulary
from adhoc.core.values import Place
from adhoc.houses.facts import CORRIDOR, is_reasonable
from adhoc.houses.house import FLOOR, House, HouseObject
from adhoc.tasks.common_sense import Triple
from adhoc.training.behaviour_cloning import Examples


@dataclass(frozen=True)
class HousePlacements:
    """What one house teaches; plain, so that another process can have counted it."""

    lying: Counter[Triple]
    """Where its things lie."""
    possible: Counter[Triple]
    """Where they could come to lie when misplaced: every receptacle of the house, and every floor."""


def placements_in(house: House) -> HousePlacements:
    """Count what lies, and could lie, where; rooms of no ProcTHOR type are left out."""
    room_types = {room.id: room.room_type for room in house.rooms if room.room_type != CORRIDOR}
    by_id = {thing.id: thing for thing in house.objects}
    spots = [
        Place(thing.category, room_types[thing.room])
        for thing in house.objects
        if thing.is_receptacle and not thing.pickupable and thing.room in room_types
    ]
    spots += [Place(FLOOR, kind) for kind in room_types.values()]
    lying: Counter[Triple] = Counter()
    possible: Counter[Triple] = Counter()
    for thing in house.objects:
        if thing.pickupable and thing.room in room_types:
            lying[(thing.category, _holder(thing, by_id), room_types[thing.room])] += 1
            possible.update((thing.category, spot.receptacle, spot.room_type) for spot in spots)
    return HousePlacements(lying, possible)


def detector_examples(houses: Iterable[HousePlacements]) -> Examples:
    """One example a triple, weighted by how often it was met; things that lie in their place, and misplaced
    ones, count for half each, so that neither answer is right by default."""
    counts = _counted(houses)
    triples = sorted(triple for triple in counts if is_known(triple))
    inputs = np.array([vocabulary.situated_row(*triple) for triple in triples], np.float32)
    labels = np.array([[not is_reasonable(*triple)] for triple in triples], np.float32)
    weights = np.sqrt(np.array([counts[triple] for triple in triples], np.float32))
    for label in (0.0, 1.0):
        of_label = labels[:, 0] == label
        weights[of_label] /= max(float(weights[of_label].sum()), 1e-9) / max(1, len(triples))
    return Examples(inputs, labels, weights)


def predictor_examples(houses: Iterable[HousePlacements]) -> Examples:
    """One example an object type that was met: for every candidate place whether it is reasonable, by the
    placement constraints; weighted by how often the type was met."""
    met: Counter[str] = Counter()
    for house in houses:
        for (category, _, _), count in house.lying.items():
            met[category] += count
    categories = sorted(category for category in met if category in vocabulary.objects())
    inputs = np.array([vocabulary.object_row(category) for category in categories], np.float32)
    labels = np.array([_targets(category) for category in categories], np.float32)
    return Examples(inputs, labels, np.sqrt(np.array([met[it] for it in categories], np.float32)))


def is_known(triple: Triple) -> bool:
    """Whether the networks have words for it."""
    return triple[0] in vocabulary.objects() and triple[1] in vocabulary.holders()


def _targets(category: str) -> Sequence[bool]:
    return [
        is_reasonable(category, place.receptacle, place.room_type) for place in vocabulary.candidate_places()
    ]


def _counted(houses: Iterable[HousePlacements]) -> Counter[Triple]:
    counts: Counter[Triple] = Counter()
    for house in houses:
        counts.update(house.lying)
        counts.update(house.possible)
    return counts


def _holder(thing: HouseObject, by_id: dict[str, HouseObject]) -> str:
    return FLOOR if thing.parent in (None, FLOOR) else by_id[thing.parent].category
