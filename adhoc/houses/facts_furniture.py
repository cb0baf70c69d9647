"""Facts of furniture: where in a room things stand, and the groups that furniture forms.

The tables are derived from ProcTHOR's placement annotations and asset groups by `scripts/make_facts.py`
(see NOTICE).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

from adhoc.core.errors import AssetError
from adhoc.houses.facts import assets_of, fact_table

CORNER, EDGE, MIDDLE = "corner", "edge", "middle"
"""The three places of a room where furniture stands."""


@dataclass(frozen=True)
class Standing:
    """How objects of a category are put up."""

    on_floor: bool
    """Whether they stand on the floor."""
    anchors: frozenset[str]
    """Where in a room they stand by themselves."""
    multiple: bool
    """Whether a room may hold several."""
    fixed: bool
    """Whether nobody ever moves them, like a faucet or a bed."""


@dataclass(frozen=True)
class Member:
    """One member of a group, in the frame of the first: x to the right, y to the front, metres.

    Its middle is its parent's, plus `side` times the parent's half extents, plus `offset`, plus `align` times
    its own half extents. `turn` is counter-clockwise in degrees and varies by up to `sway` either way.
    """

    name: str
    """Members of one name are of one asset."""
    assets: tuple[str, ...]
    parent: int | None
    """Its position in the group; None for the first member."""
    above: bool
    """Whether it stands on its parent, else beside it on the floor."""
    side: tuple[int, int]
    offset: tuple[float, float]
    align: tuple[int, int]
    turn: int
    sway: int


@dataclass(frozen=True)
class GroupFacts:
    """A group of furniture: the rooms that it is usual in, where it stands, and its members in order."""

    name: str
    room_types: frozenset[str]
    anchors: frozenset[str]
    duplicates: bool
    """Whether a room may hold several of it."""
    members: tuple[Member, ...]
    categories: frozenset[str]


@cache
def standing(category: str) -> Standing:
    """How objects of a category are put up. Raises AssetError if the category is unknown."""
    try:
        entry = fact_table("furniture")[category]
    except KeyError:
        raise AssetError(f"unknown object type {category!r}: it is not in the fact tables") from None
    on_floor = bool(fact_table("categories")[category]["on_floor"])
    return Standing(on_floor, frozenset(entry["anchors"]), entry["multiple"], entry["fixed"])


@cache
def furniture_groups() -> tuple[GroupFacts, ...]:
    """All groups, sorted by name."""
    return tuple(
        GroupFacts(
            name,
            frozenset(room for room, weight in entry["rooms"].items() if weight > 0),
            frozenset(entry["anchors"]),
            entry["duplicates"],
            tuple(_member(member) for member in entry["members"]),
            frozenset(category for member in entry["members"] for category in member["assets"]),
        )
        for name, entry in fact_table("furniture_groups").items()
    )


def _member(entry: dict[str, Any]) -> Member:
    choices: dict[str, list[str] | None] = entry["assets"]
    return Member(
        name=entry["name"],
        assets=tuple(asset for category, ids in choices.items() for asset in ids or assets_of(category)),
        parent=entry["parent"],
        above=entry["above"],
        side=tuple(entry.get("side", (0, 0))),
        offset=tuple(entry.get("offset", (0.0, 0.0))),
        align=tuple(entry.get("align", (0, 0))),
        turn=entry["turn"],
        sway=entry["sway"],
    )
