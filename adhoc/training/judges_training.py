"""Training the misplaced-object detector and the reasonable-receptacle predictor from metadata."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.learned.common_sense import LearnedCommonSense
from adhoc.agents.learned.placement_networks import detector_network, predictor_network
from adhoc.dataset.making.parallel import Progress, in_processes
from adhoc.training.behaviour_cloning import fit_classifier
from adhoc.training.judges_report import detector_report, predictor_report
from adhoc.training.placement_samples import (
    HousePlacements,
    detector_examples,
    placements_in,
    predictor_examples,
)
from adhoc.training.training_houses import CHOOSE, FIT, VALIDATE, HouseDraw, house_draws, house_of
from adhoc.training.training_settings import TeamTrainingSettings

Weights = Mapping[str, NDArray[np.float32]]
Begin = Callable[[str], Progress]
"""Told what begins; gives what is told how far it is."""


def train_judges(
    settings: TeamTrainingSettings, workers: int, begin: Begin
) -> tuple[tuple[Weights, dict[str, Any]], tuple[Weights, dict[str, Any]]]:
    """Parameters and card of the detector, and those of the predictor."""
    quarter = max(1, settings.placement_houses // 4)
    counts = {FIT: settings.placement_houses, CHOOSE: quarter, VALIDATE: quarter}
    draws = [draw for split, count in counts.items() for draw in house_draws(split, count, settings.seed)]
    met = in_processes(
        placements_of,
        draws,
        workers,
        lambda it: it.rooms,
        lambda it: it.house_id,
        begin("houses to learn placement from"),
    )
    houses = {split: [house for draw, house in zip(draws, met) if draw.split == split] for split in counts}
    begin("fitting the misplaced-object detector")
    examples = detector_examples(houses[FIT])
    detector = fit_classifier(
        detector_network(), examples, detector_examples(houses[CHOOSE]), settings.detector_fit
    )
    begin("fitting the reasonable-receptacle predictor")
    predictor = fit_classifier(
        predictor_network(),
        predictor_examples(houses[FIT]),
        predictor_examples(houses[CHOOSE]),
        settings.predictor_fit,
    )
    judge = LearnedCommonSense(detector.parameters, predictor.parameters)
    data = {"houses": counts, "source": "placement constraints and what lies where in generated houses"}
    trained_on = _triples(houses[FIT])
    detector_card = {
        "data": {**data, "training_triples": len(examples)},
        "fit": detector.summary(),
        "validation": detector_report(judge, houses[VALIDATE], trained_on),
    }
    predictor_card = {
        "data": data,
        "fit": predictor.summary(),
        "validation": predictor_report(judge, houses[VALIDATE]),
    }
    return (detector.parameters, detector_card), (predictor.parameters, predictor_card)


def placements_of(draw: HouseDraw) -> HousePlacements:
    """What the house of a draw teaches."""
    return placements_in(house_of(draw))


def _triples(houses: Sequence[HousePlacements]) -> frozenset[tuple[str, str, str]]:
    return frozenset(triple for house in houses for triple in (*house.lying, *house.possible))
