"""Facts of objects: sizes and masses of assets, and where objects of each type belong.

The tables in `facts_data` are derived from ProcTHOR's databases by `scripts/make_facts.py` (see NOTICE).
They are the library's ground truth of 'reasonable' places (paper: 'according to common sense'): an object
is misplaced where `is_reasonable` says no.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from types import MappingProxyType
from typing import Any

from adhoc.core.errors import AssetError
from adhoc.core.values import Place, Point
from adhoc.houses.house import FLOOR

ROOM_TYPES = ("Kitchen", "LivingRoom", "Bedroom", "Bathroom")
"""The room types of ProcTHOR, to which the placement facts refer."""

CORRIDOR = "Corridor"
"""A room type of our own (the paper's physical set-up has a corridor): nothing belongs there."""

FLOOR_PROBABILITY = 0.5
"""Rank of the floor in `places_for`, for the few types that may lie there. The statistics count no floors;
in real houses those types lie on the floor about as often as on anything else."""


@dataclass(frozen=True)
class AssetFacts:
    """One asset: `size` is the full extents (x, y, z) of its unturned bounding box in metres, z up;
    `mass` is in kilograms and meaningful for what can be picked up."""

    asset: str
    category: str
    size: Point
    pickupable: bool
    mass: float


@dataclass(frozen=True)
class CategoryFacts:
    """One object type: whether a robot can carry it, whether robots can put things on or into it (a
    receptacle of the statistics that cannot itself be carried), and its usual mass in kilograms."""

    category: str
    pickupable: bool
    is_receptacle: bool
    mass: float


def asset(asset_id: str) -> AssetFacts:
    """The facts of an asset, e.g. `Fridge_5`. Raises AssetError if it is unknown."""
    try:
        return _assets()[asset_id]
    except KeyError:
        raise AssetError(f"unknown asset {asset_id!r}: it is not in the fact tables") from None


def category_facts(category: str) -> CategoryFacts:
    """The facts of an object type, e.g. `Fridge`. Raises AssetError if it is unknown."""
    entry = _category(category)
    is_receptacle = category in fact_table("receptacles") and not entry["pickupable"]
    return CategoryFacts(category, entry["pickupable"], is_receptacle, float(entry["mass"]))


@cache
def categories() -> tuple[str, ...]:
    """All object types, sorted."""
    return tuple(fact_table("categories"))


@cache
def pickupable_categories() -> tuple[str, ...]:
    """The 62 object types that a robot can pick up, sorted."""
    return tuple(name for name in categories() if _category(name)["pickupable"])


@cache
def receptacle_categories() -> tuple[str, ...]:
    """The object types on or in which the statistics have things, sorted; a few, such as bowls, can be
    carried themselves."""
    return tuple(sorted(fact_table("receptacles")))


def assets_of(category: str) -> tuple[str, ...]:
    """The ids of all assets of an object type, sorted. Raises AssetError if the type is unknown."""
    _category(category)
    return tuple(fact_table("assets")[category])


def wall_hole(asset_id: str) -> tuple[float, float]:
    """Width and height, in metres, of the hole that a door or window asset needs in a wall.

    Raises AssetError if the asset is no door or window.
    """
    try:
        width, height = fact_table("wall_holes")[asset_id]
    except KeyError:
        raise AssetError(f"unknown door or window asset {asset_id!r}: it is not in the fact tables") from None
    return width, height


def room_weight(category: str, room_type: str) -> int:
    """How usual the object type is in that room type: 0 (never) to 3 (ProcTHOR's placement annotations).

    0 for every type in a `Corridor`. Raises AssetError for an unknown object type or room type.
    """
    weights = _category(category)["rooms"]
    if room_type == CORRIDOR:
        return 0
    if room_type not in weights:
        known = ", ".join((*ROOM_TYPES, CORRIDOR))
        raise AssetError(f"unknown room type {room_type!r}: it should be one of {known}")
    return int(weights[room_type])


def receptacle_probability(receptacle: str, category: str) -> float:
    """Probability in [0, 1] that a receptacle of that type holds an object of that type.

    0 where the statistics do not know the pair. Raises AssetError for an unknown type.
    """
    _category(category)
    _category(receptacle)
    return float(fact_table("receptacles").get(receptacle, {}).get(category, 0.0))


@cache
def is_reasonable(category: str, receptacle: str, room_type: str) -> bool:
    """Whether objects of `category` belong on or in `receptacle` (or `Floor`) in a room of that type.

    The rule, which finds none of the 7788 objects of 501 real ProcTHOR houses misplaced: the receptacle
    statistics know the pair (for the floor: the annotations allow the type on the floor), and the type
    occurs in rooms of that type. Raises AssetError for an unknown type.
    """
    in_room = room_weight(category, room_type) > 0
    if receptacle == FLOOR:
        return bool(_category(category)["on_floor"]) and in_room
    return receptacle_probability(receptacle, category) > 0 and in_room


@cache
def places_for(category: str) -> tuple[Place, ...]:
    """Every place where a robot could reasonably put objects of `category`, likeliest first.

    Ranked by probability times room weight; places whose receptacle is not usual in that room type (a bed
    in a kitchen) come last. Receptacles that can be carried themselves (a plate, a box) are left out: a
    robot cannot put things there. Empty for the few types that have no reasonable place. Raises AssetError
    if the type is unknown.
    """
    receptacles = [name for name in receptacle_categories() if category_facts(name).is_receptacle]
    places = [
        Place(receptacle, room_type)
        for receptacle in (*receptacles, FLOOR)
        for room_type in ROOM_TYPES
        if is_reasonable(category, receptacle, room_type)
    ]
    return tuple(sorted(places, key=lambda place: _unlikelihood(category, place)))


def _unlikelihood(category: str, place: Place) -> tuple[bool, float, str, str]:
    if place.receptacle == FLOOR:
        unusual, probability = False, FLOOR_PROBABILITY
    else:
        unusual = room_weight(place.receptacle, place.room_type) == 0
        probability = receptacle_probability(place.receptacle, category)
    score = probability * room_weight(category, place.room_type)
    return unusual, -score, place.receptacle, place.room_type


def _category(category: str) -> Mapping[str, Any]:
    try:
        entry: Mapping[str, Any] = fact_table("categories")[category]
    except KeyError:
        raise AssetError(f"unknown object type {category!r}: it is not in the fact tables") from None
    return entry


@cache
def fact_table(name: str) -> Mapping[str, Any]:
    """One table of `facts_data`, by file name without extension."""
    text = (files("adhoc.houses") / "facts_data" / f"{name}.json").read_text(encoding="utf-8")
    return MappingProxyType(json.loads(text))


@cache
def _assets() -> Mapping[str, AssetFacts]:
    facts = {}
    for category, rows in fact_table("assets").items():
        entry = _category(category)
        for asset_id, (x, y, z, *own_mass) in rows.items():
            mass = float(own_mass[0] if own_mass else entry["mass"])
            facts[asset_id] = AssetFacts(asset_id, category, (x, y, z), entry["pickupable"], mass)
    return facts
