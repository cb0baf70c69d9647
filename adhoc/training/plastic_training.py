"""Training PLASTIC from nothing: beside each type of team, models of behaviour and a policy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adhoc import __version__
from adhoc.agents.learned.checkpoint import SUFFIX, save_checkpoint
from adhoc.agents.learned.decision import KINDS
from adhoc.agents.learned.layers import Network
from adhoc.agents.plastic.deeds import Heard, Seen
from adhoc.agents.plastic.models import DECISION, HEARD, KIND, NETWORKS, SEEN, whole_of
from adhoc.training.behaviour_cloning import Examples, FitSettings, accuracies, fit_classifier, predict
from adhoc.training.demonstrations import Demonstrations
from adhoc.training.judges_training import Begin
from adhoc.training.plastic_card import write_plastic_card
from adhoc.training.plastic_demonstrations import demonstrate_beside, examples_of
from adhoc.training.plastic_settings import PlasticTrainingSettings
from adhoc.training.plastic_teams import TeamType, team_types
from adhoc.training.plastic_trials import TrialSettings, report_of, try_beliefs
from adhoc.training.training_houses import CHOOSE, FIT, VALIDATE, house_draws

DEMONSTRATIONS = "demonstrations"
"""The folder, in that of the checkpoints, that keeps what was demonstrated."""
_CLASSES: Mapping[str, Sequence[str]] = {
    HEARD: [deed.name.lower() for deed in Heard],
    SEEN: [deed.name.lower() for deed in Seen],
    DECISION: [kind.value for kind in KINDS],
}


def train_plastic(
    settings: PlasticTrainingSettings,
    folder: Path,
    workers: int,
    begin: Begin,
    types: Mapping[str, TeamType] | None = None,
) -> dict[str, Any]:
    """Write a checkpoint for each type of team and their model card to `folder`; returns the report of the
    trials (see `plastic_trials.report_of`). The types are the pre-defined ones if None.

    What was demonstrated is kept in the folder house by house, so that the same training goes on where it
    was interrupted. The number of workers changes nothing but the time.

    Raises:
        CheckpointError: Demonstrations in the folder, or the learned team's checkpoints, cannot be read.
        MissingDependency: torch or safetensors is not installed.
    """
    types = team_types(team_checkpoints=settings.team_checkpoints) if types is None else types
    folder.mkdir(parents=True, exist_ok=True)
    cards = {}
    for name, team in types.items():
        shown = _demonstrations(name, team, settings, folder, workers, begin)
        begin(f"fitting the models of {name}")
        parameters, cards[name] = _fit_type(name, shown, settings)
        save_checkpoint(folder / f"{name}{SUFFIX}", KIND, parameters, cards[name])
    held_out = house_draws(VALIDATE, _houses(settings)[VALIDATE], settings.seed)
    trial = TrialSettings(str(folder), settings.team_checkpoints, settings.eta, settings.max_steps)
    trials = try_beliefs(types, held_out, trial, workers, begin("trying the beliefs beside every type"))
    report = report_of(trials, types)
    write_plastic_card(folder, cards, report)
    return report


def _houses(settings: PlasticTrainingSettings) -> dict[str, int]:
    return {
        FIT: settings.houses,
        CHOOSE: max(1, settings.houses // 6),
        VALIDATE: max(1, settings.houses // 3),
    }


def _demonstrations(
    name: str, team: TeamType, settings: PlasticTrainingSettings, folder: Path, workers: int, begin: Begin
) -> dict[str, Demonstrations]:
    return {
        split: demonstrate_beside(
            name,
            team,
            split,
            houses,
            settings,
            folder / DEMONSTRATIONS,
            workers,
            begin(f"beside {name} ({split})"),
        )
        for split, houses in _houses(settings).items()
    }


def _fit_type(
    name: str, shown: Mapping[str, Demonstrations], settings: PlasticTrainingSettings
) -> tuple[dict[str, NDArray[np.float32]], dict[str, Any]]:
    """The tensors of a type's checkpoint, and its card."""
    parts, fits = {}, {}
    for part, network in NETWORKS.items():
        examples = {split: examples_of(it, part) for split, it in shown.items()}
        how = settings.decision_fit if part == DECISION else settings.behaviour_fit
        parts[part], fits[part] = _fit_part(network, examples, how, _CLASSES[part])
    card = {
        "module": KIND,
        "type": name,
        "library_version": __version__,
        "seed": settings.seed,
        "training": asdict(settings),
        "data": {
            "houses": _houses(settings),
            "episodes": {split: it.episodes for split, it in shown.items()},
            "successful": {split: it.successes for split, it in shown.items()},
            "source": "a team of the type with an expert newcomer that knows the task's metadata, in "
            "tasks in generated houses",
        },
        "parts": fits,
    }
    return whole_of(parts), card


def _fit_part(
    network: Network, examples: Mapping[str, Examples], how: FitSettings, classes: Sequence[str]
) -> tuple[Mapping[str, NDArray[np.float32]], dict[str, Any]]:
    """The parameters of one part, and what the card says of it.

    Where there is nothing to learn from, say because no teammate was ever seen, all classes stay equally
    probable.
    """
    card: dict[str, Any] = {"examples": {split: len(it) for split, it in examples.items()}}
    if not all(len(examples[split]) for split in (FIT, CHOOSE)):
        nothing = {name: np.zeros(shape, np.float32) for name, shape in network.shapes.items()}
        return nothing, {**card, "fit": None, "validation": None}
    fit = fit_classifier(network, examples[FIT], examples[CHOOSE], how)
    held_out = examples[VALIDATE]
    predicted = predict(network, fit.parameters, held_out.inputs).argmax(axis=1)
    validation = accuracies(predicted, held_out.labels, classes)
    return fit.parameters, {**card, "fit": fit.summary(), "validation": validation}
