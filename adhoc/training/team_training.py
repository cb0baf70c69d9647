"""Training the learned team from nothing: two judges of places, demonstrations, the decision module."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adhoc import __version__
from adhoc.agents.learned.checkpoint import load_checkpoint, save_checkpoint
from adhoc.agents.learned.decision import DecisionModule
from adhoc.agents.learned.placement_networks import DETECTOR_KIND, PREDICTOR_KIND
from adhoc.agents.learned.shipped import DECISION_FILE, DETECTOR_FILE, PREDICTOR_FILE
from adhoc.training.decision_training import train_decision
from adhoc.training.judges_training import Begin, train_judges
from adhoc.training.model_card import write_model_card
from adhoc.training.training_settings import TeamTrainingSettings


def train_team(
    settings: TeamTrainingSettings, folder: Path, workers: int, begin: Begin
) -> Mapping[str, Mapping[str, Any]]:
    """Write the three checkpoints and their model card to `folder`; returns the cards by file name.

    Demonstrations are kept in the folder house by house, so that the same training goes on where it was
    interrupted. The number of workers changes nothing but the time.

    Raises:
        CheckpointError: Demonstrations in the folder cannot be read.
        MissingDependency: torch or safetensors is not installed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    detector, predictor = train_judges(settings, workers, begin)
    cards = {
        DETECTOR_FILE: _save(folder / DETECTOR_FILE, DETECTOR_KIND, *detector, settings),
        PREDICTOR_FILE: _save(folder / PREDICTOR_FILE, PREDICTOR_KIND, *predictor, settings),
    }
    decision = train_decision(settings, folder, workers, begin)
    cards[DECISION_FILE] = _save(folder / DECISION_FILE, DecisionModule.KIND, *decision, settings)
    write_model_card(folder, cards)
    return cards


def _save(
    path: Path,
    kind: str,
    parameters: Mapping[str, NDArray[np.float32]],
    card: Mapping[str, Any],
    settings: TeamTrainingSettings,
) -> Mapping[str, Any]:
    """Write a checkpoint; its card as readers of the file see it."""
    whole = {
        "module": kind,
        "library_version": __version__,
        "seed": settings.seed,
        "parameters": sum(value.size for value in parameters.values()),
        "training": asdict(settings),
        **card,
    }
    save_checkpoint(path, kind, parameters, whole)
    return load_checkpoint(path, kind, {name: value.shape for name, value in parameters.items()}).card
