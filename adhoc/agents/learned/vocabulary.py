"""The words that the networks know: types of objects, of receptacles and of rooms, as rows of numbers."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Place
from adhoc.houses.facts import (
    ROOM_TYPES,
    category_facts,
    pickupable_categories,
    receptacle_categories,
)
from adhoc.houses.house import FLOOR


@cache
def objects() -> tuple[str, ...]:
    """The types of objects that a robot can pick up."""
    return pickupable_categories()


@cache
def holders() -> tuple[str, ...]:
    """What objects lie in or on: all receptacles, those too that can be carried, and the floor."""
    return (*receptacle_categories(), FLOOR)


@cache
def candidate_places() -> tuple[Place, ...]:
    """The candidate list of the receptacle predictor: where a robot could put things at all."""
    receptacles = [name for name in receptacle_categories() if category_facts(name).is_receptacle]
    return tuple(Place(name, room_type) for name in (*receptacles, FLOOR) for room_type in ROOM_TYPES)


def object_size() -> int:
    """Numbers in `object_row`."""
    return len(objects())


def situated_size() -> int:
    """Numbers in `situated_row`."""
    return len(objects()) + len(holders()) + len(ROOM_TYPES)


def object_row(category: str) -> NDArray[np.float32]:
    """(`object_size`,): 1 at the type. Raises KeyError for a type that is not in `objects`."""
    row = np.zeros(object_size(), np.float32)
    row[_positions(objects())[category]] = 1.0
    return row


def situated_row(category: str, holder: str, room_type: str) -> NDArray[np.float32]:
    """(`situated_size`,): 1 at each of the three types. Raises KeyError for one that is unknown."""
    row = np.zeros(situated_size(), np.float32)
    row[_positions(objects())[category]] = 1.0
    row[len(objects()) + _positions(holders())[holder]] = 1.0
    row[len(objects()) + len(holders()) + _positions(ROOM_TYPES)[room_type]] = 1.0
    return row


@cache
def _positions(names: tuple[str, ...]) -> dict[str, int]:
    return {name: position for position, name in enumerate(names)}
