"""Which type a room is of, judged by what is in it (paper, section Visual Semantic Perception)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import cache

from adhoc.core.errors import AssetError
from adhoc.houses.facts import ROOM_TYPES, room_weight
from adhoc.perception.object_table import facts_of

SMOOTHING = 0.3
"""Added to the weights 0..3 of a category, so that no single object can exclude a type of room."""


def infer_room_type(categories: Iterable[str], item_evidence: float) -> Mapping[str, float]:
    """Probability of each room type, given the distinct categories detected in a room.

    Naive Bayes with a uniform prior: each category counts once, with the likelihoods that the placement
    annotations suggest (weight 0 'never' to 3, smoothed); portable things count with the exponent
    `item_evidence`, since they may be misplaced. The paper does not say how it infers the type. Uniform when
    nothing tells.
    """
    scores = dict.fromkeys(ROOM_TYPES, 0.0)
    for category in sorted(set(categories)):
        exponent = item_evidence if facts_of(category).pickupable else 1.0
        for room_type, likelihood in _log_likelihoods(category).items():
            scores[room_type] += exponent * likelihood
    highest = max(scores.values())
    weights = {room_type: math.exp(score - highest) for room_type, score in scores.items()}
    total = sum(weights.values())
    return {room_type: weight / total for room_type, weight in weights.items()}


@cache
def _log_likelihoods(category: str) -> Mapping[str, float]:
    try:
        weights = {room_type: room_weight(category, room_type) + SMOOTHING for room_type in ROOM_TYPES}
    except AssetError:
        return dict.fromkeys(ROOM_TYPES, 0.0)
    total = sum(weights.values())
    return {room_type: math.log(weight / total) for room_type, weight in weights.items()}
