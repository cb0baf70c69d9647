"""How right detector and predictor are about houses that they have not seen."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from typing import Any

from adhoc.houses.facts import is_reasonable, places_for
from adhoc.tasks.common_sense import CommonSense, Triple
from adhoc.training.placement_samples import HousePlacements, is_known


def detector_report(
    judge: CommonSense, houses: Sequence[HousePlacements], trained_on: Collection[Triple]
) -> dict[str, Any]:
    """Accuracies of the misplaced-object detector over everything that lies, or could lie, in the houses.

    `accuracy` is the mean of the shares that are judged rightly of what is in place and of what is not, each
    counted as often as it is met: there are far more wrong places than right ones. `unseen` is the same for
    triples of object, receptacle and room type that are not among those it was trained on.
    """
    met: Counter[Triple] = Counter()
    for house in houses:
        met.update(house.lying)
        met.update(house.possible)
    known = {triple: count for triple, count in met.items() if is_known(triple)}
    return {
        **_shares(judge, known),
        "unseen": _shares(judge, {it: count for it, count in known.items() if it not in trained_on}),
    }


def predictor_report(judge: CommonSense, houses: Sequence[HousePlacements]) -> dict[str, Any]:
    """Accuracies of the reasonable-receptacle predictor over the objects in the houses.

    `top_1_is_reasonable` is the share of objects whose likeliest predicted place is a reasonable one, among
    those that belong anywhere. `precision` and `recall` compare all predicted places with all that are
    reasonable.
    """
    met: Counter[str] = Counter()
    for house in houses:
        for (category, _, _), count in house.lying.items():
            met[category] += count
    belonging = {category: count for category, count in met.items() if places_for(category)}
    right = found = predicted = wanted = 0
    for category, count in belonging.items():
        places, truth = judge.places_for(category), set(places_for(category))
        right += count * (len(places) > 0 and places[0] in truth)
        found += count * len(truth & set(places))
        predicted += count * len(places)
        wanted += count * len(truth)
    return {
        "objects": sum(belonging.values()),
        "object_types": len(belonging),
        "top_1_is_reasonable": _share(right, sum(belonging.values())),
        "precision": _share(found, predicted),
        "recall": _share(found, wanted),
    }


def _shares(judge: CommonSense, met: dict[Triple, int]) -> dict[str, Any]:
    right, total = Counter[bool](), Counter[bool]()
    for triple, count in met.items():
        misplaced = not is_reasonable(*triple)
        total[misplaced] += count
        right[misplaced] += count * (judge.is_misplaced(*triple) == misplaced)
    shares = {
        name: _share(right[key], total[key]) for name, key in (("in_place", False), ("misplaced", True))
    }
    known = [share for share in shares.values() if share is not None]
    return {
        "triples": len(met),
        "examples": sum(total.values()),
        **shares,
        "accuracy": sum(known) / len(known) if known else None,
    }


def _share(part: int, whole: int) -> float | None:
    return part / whole if whole else None
