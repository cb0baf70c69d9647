"""What a training of the learned team is made of."""

from __future__ import annotations

from dataclasses import dataclass

from adhoc.core.errors import ConfigurationError
from adhoc.training.behaviour_cloning import FitSettings


@dataclass(frozen=True)
class TeamTrainingSettings:
    """Sizes and seeds; equal settings give equal checkpoints on one machine.

    Raises ConfigurationError where a number is below 1.
    """

    seed: int = 0
    placement_houses: int = 400
    """From whose metadata detector and predictor learn. A quarter as many choose the epoch, and as many again
    are for the accuracies."""
    demonstration_houses: int = 72
    """In which the expert demonstrates. A tenth as many choose the epoch, a fifth as many are held out for
    the accuracies."""
    scenarios: int = 2
    """Episodes in each of them."""
    stray: float = 0.1
    """How often a demonstration does something else than the expert (see `expert.Demonstrator`)."""
    detector_epochs: int = 200
    predictor_epochs: int = 400
    decision_epochs: int = 60
    balance: float = 0.25
    """Of the decision module's classes, see `FitSettings.balance`: most decisions are to explore."""

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if isinstance(value, int) and name != "seed" and value < 1:
                raise ConfigurationError(f"{name}={value}: must be at least 1")
        if not 0.0 <= self.stray < 1.0:
            raise ConfigurationError(f"stray={self.stray}: must be at least 0 and below 1")

    @property
    def detector_fit(self) -> FitSettings:
        return FitSettings(self.seed, self.detector_epochs, batch=64)

    @property
    def predictor_fit(self) -> FitSettings:
        return FitSettings(self.seed, self.predictor_epochs, batch=16)

    @property
    def decision_fit(self) -> FitSettings:
        return FitSettings(self.seed, self.decision_epochs, batch=256, balance=self.balance)
