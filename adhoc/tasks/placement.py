"""Common sense from ProcTHOR's placement statistics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from adhoc.core.errors import AssetError
from adhoc.core.values import Place
from adhoc.houses import facts
from adhoc.tasks.common_sense import CommonSense


class PlacementCommonSense(CommonSense):
    """What people do with things, as ProcTHOR's annotators counted it.

    An object belongs where it was ever placed: its receptacle has held its category, and its category is
    placed in rooms of that type (`houses.facts.is_reasonable`). On the shipped and the real houses this
    calls no object misplaced.
    """

    def is_misplaced(self, category: str, receptacle: str, room_type: str) -> bool:
        """See `CommonSense`; `room_type` is one of `houses.facts.ROOM_TYPES` or `Corridor`.

        What the statistics do not know belongs nowhere, and holds nothing: teammates may tell of anything.
        """
        try:
            return not facts.is_reasonable(category, receptacle, room_type)
        except AssetError:
            return True

    def places_for(self, category: str) -> Sequence[Place]:
        """See `CommonSense`."""
        try:
            return facts.places_for(category)
        except AssetError:
            return ()


def placement_table() -> Mapping[str, Sequence[Place]]:
    """Where the objects of each category that can be picked up belong, likeliest first."""
    return {category: facts.places_for(category) for category in facts.pickupable_categories()}
