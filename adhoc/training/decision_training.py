"""Training the sub-skill decision module by behaviour cloning (paper, 'Learning-based Policy')."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.learned.decision import KINDS, DecisionNetwork
from adhoc.agents.learned.features import FEATURE_SIZE
from adhoc.agents.learned.policy import LearnedPolicy
from adhoc.agents.learned.shipped import common_sense_in
from adhoc.core.streams import stream
from adhoc.evaluation.scenario import Scenario
from adhoc.training.behaviour_cloning import accuracies, fit_classifier, predict
from adhoc.training.demonstrations import Cast, Demonstrations, DemonstrationSettings, demonstrate
from adhoc.training.expert import Demonstrator, Expert
from adhoc.training.judges_training import Begin
from adhoc.training.training_houses import CHOOSE, FIT, VALIDATE, house_draws
from adhoc.training.training_settings import TeamTrainingSettings
from adhoc.worlds.world import World

DEMONSTRATIONS = "demonstrations"
"""The folder, in that of the checkpoints, that keeps what was demonstrated."""


def train_decision(
    settings: TeamTrainingSettings, folder: Path, workers: int, begin: Begin
) -> tuple[Mapping[str, NDArray[np.float32]], dict[str, Any]]:
    """Parameters and card of the decision module; detector and predictor must be in `folder` already."""
    houses = settings.demonstration_houses
    counts = {FIT: houses, CHOOSE: max(1, houses // 10), VALIDATE: max(1, houses // 5)}
    shown = {
        split: _demonstrations(settings, folder, split, count, workers, begin)
        for split, count in counts.items()
    }
    begin("fitting the sub-skill decision module")
    network = DecisionNetwork()
    fit = fit_classifier(network, shown[FIT].examples, shown[CHOOSE].examples, settings.decision_fit)
    predicted = predict(network, fit.parameters, shown[VALIDATE].inputs).argmax(axis=1)
    card = {
        "data": {
            "houses": counts,
            "episodes": {split: it.episodes for split, it in shown.items()},
            "successful_demonstrations": {split: it.successes for split, it in shown.items()},
            "decisions": {split: len(it.labels) for split, it in shown.items()},
            "decisions_by_class": {split: _by_class(it) for split, it in shown.items()},
            "stray": settings.stray,
            "source": "an expert that knows the task's metadata, in tasks in generated houses",
        },
        "fit": fit.summary(),
        "validation": accuracies(predicted, shown[VALIDATE].labels, [kind.value for kind in KINDS]),
    }
    return fit.parameters, card


def expert_team(folder: str, stray: float, world: World, scenario: Scenario) -> Cast:
    """A learned team whose every decision is the expert's, see `expert.Demonstrator`."""
    expert = Expert(world, scenario)
    recorders = [
        Demonstrator(expert, stray, stream(scenario.seed, "stray", member.name)) for member in scenario.team
    ]
    judge = common_sense_in(folder)
    return Cast([LearnedPolicy(recorder.decide, judge) for recorder in recorders], recorders)


def _demonstrations(
    settings: TeamTrainingSettings, folder: Path, split: str, count: int, workers: int, begin: Begin
) -> Demonstrations:
    return demonstrate(
        house_draws(split, count, settings.seed),
        DemonstrationSettings(
            f"expert-{settings.stray:g}",
            partial(expert_team, str(folder), settings.stray),
            FEATURE_SIZE,
            settings.scenarios,
        ),
        folder / DEMONSTRATIONS,
        workers,
        begin(f"demonstrations ({split})"),
    )


def _by_class(shown: Demonstrations) -> dict[str, int]:
    return {kind.value: int((shown.labels == number).sum()) for number, kind in enumerate(KINDS)}
