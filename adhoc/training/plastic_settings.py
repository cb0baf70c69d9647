"""What a training of PLASTIC is made of."""

from __future__ import annotations

from dataclasses import dataclass

from adhoc.core.errors import ConfigurationError
from adhoc.training.behaviour_cloning import FitSettings


@dataclass(frozen=True)
class PlasticTrainingSettings:
    """Sizes and seeds; equal settings give equal checkpoints on one machine.

    Raises ConfigurationError where a number is out of its range.
    """

    seed: int = 0
    houses: int = 60
    """In which the expert demonstrates beside each type. A sixth as many choose the epoch, a third as many
    are held out: for the accuracies, and to try how beliefs find the true type."""
    scenarios: int = 1
    """Episodes in each house beside each type."""
    max_steps: int = 500
    stray: float = 0.1
    """How often a demonstration does something else than the expert (see `expert.Demonstrator`)."""
    join_steps: tuple[int, ...] = (0, 50)
    """One of them is drawn for each episode."""
    behaviour_epochs: int = 40
    decision_epochs: int = 40
    balance: float = 0.25
    """Of the classes of decisions, see `FitSettings.balance`."""
    eta: float = 0.5
    """By which the beliefs are tried, see `plastic.beliefs.Beliefs`."""
    team_checkpoints: str | None = None
    """The folder of the learned team's checkpoints; the shipped one if None."""

    def __post_init__(self) -> None:
        for name in ("houses", "scenarios", "max_steps", "behaviour_epochs", "decision_epochs"):
            if getattr(self, name) < 1:
                raise ConfigurationError(f"{name}={getattr(self, name)}: must be at least 1")
        if not 0.0 <= self.stray < 1.0:
            raise ConfigurationError(f"stray={self.stray}: must be at least 0 and below 1")
        if not self.join_steps or not all(0 <= step < self.max_steps for step in self.join_steps):
            raise ConfigurationError(f"join_steps={self.join_steps}: must be steps below {self.max_steps}")

    @property
    def behaviour_fit(self) -> FitSettings:
        return FitSettings(self.seed, self.behaviour_epochs, batch=64, weight_decay=1e-2)

    @property
    def decision_fit(self) -> FitSettings:
        return FitSettings(self.seed, self.decision_epochs, batch=128, balance=self.balance)
