"""Choosing the next piece or group of furniture for a room, after ProcTHOR's habits and numbers."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from adhoc.houses import facts
from adhoc.houses.facts_furniture import GroupFacts, furniture_groups, standing
from adhoc.houses.floor_plan import Rectangle
from adhoc.houses.generation.anchors import Anchor
from adhoc.houses.generation.furniture_groups import Arrangement, arrange, largest_size, single

GROUP_RATHER_THAN_PIECE = 0.6
RARE_SKIPPED = 0.8
"""Probability of leaving out what is rare (weight 1) in such rooms."""
ALLOW_PLANTS = 0.5
ALLOW_TELEVISIONS = 0.5
"""Probabilities that a room may have a plant on the floor, and a television without a sofa."""
PRIORITIES = {
    "Bedroom": ("Bed", "Dresser"),
    "LivingRoom": ("Television", "DiningTable", "Sofa"),
    "Kitchen": ("CounterTop", "Fridge"),
    "Bathroom": ("Toilet", "Sink"),
}
"""What a room gets first where it fits."""

LYING_BATS = 0.7
"""Share of baseball bats on the floor that lie."""

PLANT_GROUP, TELEVISION_GROUP = "floor-house-plant", "television"


class FurnitureChoice:
    """What a room of some type is still offered and still due.

    Args:
        room_type: of the room; nothing belongs in types that ProcTHOR does not have.
        generator: the random numbers.
    """

    def __init__(self, room_type: str, generator: Generator) -> None:
        self._room_type = room_type
        self._generator = generator
        left_out = set()
        if generator.random() >= ALLOW_PLANTS:
            left_out.add(PLANT_GROUP)
        if generator.random() >= ALLOW_TELEVISIONS:
            left_out.add(TELEVISION_GROUP)
        self._groups = [
            group
            for group in furniture_groups()
            if room_type in group.room_types and group.name not in left_out
        ]
        self._singles = list(_singles(room_type))
        self._due = list(PRIORITIES.get(room_type, ()))
        generator.shuffle(self._due)

    def draw(self, rectangle: Rectangle, anchor: Anchor) -> tuple[Arrangement, GroupFacts | None] | None:
        """Something that fits there, and its group if it is one; None if nothing was found."""
        groups = [
            group
            for group in self._groups
            if anchor.kind in group.anchors and anchor.admits(np.array([largest_size(group)]), rectangle)[0]
        ]
        fitting = _fitting(self._singles, rectangle, anchor)
        for category in self._due:
            having = [group for group in groups if category in group.categories]
            found = self._draw_due(category, having, fitting)
            if found is not None:
                return found
        if groups and self._generator.random() <= GROUP_RATHER_THAN_PIECE:
            arrangement = self._arranged(groups)
            if arrangement is not None:
                return arrangement
        if self._generator.random() <= RARE_SKIPPED:
            fitting = {
                name: assets
                for name, assets in fitting.items()
                if facts.room_weight(name, self._room_type) != 1
            }
        if not fitting:
            return None
        names = sorted(fitting)
        return self._picked(fitting[names[int(self._generator.integers(len(names)))]])

    def forget(self, categories: Iterable[str], group: GroupFacts | None) -> None:
        """What the room now has is no longer due, and no longer offered where one is enough."""
        got = set(categories)
        self._due = [category for category in self._due if category not in got]
        if group is not None and not group.duplicates:
            self._groups = [other for other in self._groups if other.name != group.name]
        full = {category for category in got if not standing(category).multiple}
        self._groups = [other for other in self._groups if not other.categories & full]
        self._singles = [category for category in self._singles if category not in full]

    def _draw_due(
        self, category: str, having: Sequence[GroupFacts], fitting: dict[str, list[str]]
    ) -> tuple[Arrangement, GroupFacts | None] | None:
        stands_alone = facts.room_weight(category, self._room_type) > 0
        if having and (not stands_alone or self._generator.random() <= GROUP_RATHER_THAN_PIECE):
            arrangement = self._arranged(having)
            if arrangement is not None:
                return arrangement
        return self._picked(fitting[category]) if category in fitting else None

    def _arranged(self, groups: Sequence[GroupFacts]) -> tuple[Arrangement, GroupFacts] | None:
        group = groups[int(self._generator.integers(len(groups)))]
        arrangement = arrange(group, self._generator)
        return None if arrangement is None else (arrangement, group)

    def _picked(self, assets: Sequence[str]) -> tuple[Arrangement, None]:
        name = assets[int(self._generator.integers(len(assets)))]
        lying = facts.asset(name).category == "BaseballBat" and self._generator.random() < LYING_BATS
        return single(name, lying), None


@cache
def _singles(room_type: str) -> tuple[str, ...]:
    """The categories that stand on the floor of such rooms by themselves."""
    return tuple(
        category
        for category in facts.categories()
        if standing(category).on_floor and facts.room_weight(category, room_type) > 0
    )


@cache
def _sizes(category: str) -> tuple[tuple[str, ...], NDArray[np.float64]]:
    assets = facts.assets_of(category)
    return assets, np.array([facts.asset(name).size[:2] for name in assets])


def _fitting(categories: Sequence[str], rectangle: Rectangle, anchor: Anchor) -> dict[str, list[str]]:
    """The assets that fit there, of every category that has any."""
    fitting = {}
    for category in categories:
        if anchor.kind in standing(category).anchors:
            assets, sizes = _sizes(category)
            fits = anchor.admits(sizes, rectangle)
            if fits.any():
                fitting[category] = [name for name, fit in zip(assets, fits.tolist()) if fit]
    return fitting
