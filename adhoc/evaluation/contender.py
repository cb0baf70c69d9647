"""Who takes part in a comparison, and under which conditions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from adhoc.agents.policy import Policy
from adhoc.evaluation.imperfections import PERFECT, Imperfections
from adhoc.evaluation.metrics import FailedShare
from adhoc.evaluation.predictions import WITHIN
from adhoc.evaluation.referee import PlacementReferee, RefereeMaker
from adhoc.llm.counting import CountingModel
from adhoc.tasks.task import Task

NO_AD_HOC = "none"
"""The policy name of the team alone."""
ALONE = "No ad hoc"
"""What the paper calls the team alone."""


@dataclass(frozen=True)
class Contender:
    """A team's policy or an ad hoc policy: how to make one for a robot, and what it is called.

    `settings` are JSON values; whatever changes behaviour belongs in there, since they decide whether an
    episode was run before. `model` is the language model that the policies use, None if they use none.
    """

    name: str
    label: str
    """As tables and pictures show it."""
    make: Callable[[int], Policy]
    """Makes a fresh policy for the robot in a seat: the teammates are numbered from 0 in the order of the
    scenario, the newcomer follows them. Robots of a mixed team get different ones."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    model: CountingModel | None = None

    @property
    def model_name(self) -> str | None:
        """The model that records and tables name."""
        return None if self.model is None else self.model.name


@dataclass(frozen=True)
class Conditions:
    """What all compared episodes have in common.

    Raises ConfigurationError if an imperfection comes after `max_steps`.
    """

    task: Task
    team: Contender
    max_steps: int = 500
    referee: RefereeMaker = PlacementReferee
    failed_share: FailedShare = FailedShare.FROM_JOINING
    """What a failure counts for the newcomer's action steps."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    """Of the task and the world, as JSON values."""
    model: CountingModel | None = None
    """The language model that the task asks by itself, None if it asks none."""
    imperfections: Imperfections = PERFECT
    """What is wrong with the team and the radio."""
    predicted_within: int = WITHIN
    """Steps in which a change must come that a robot predicted (see `evaluation.predictions`)."""

    def __post_init__(self) -> None:
        self.imperfections.check_steps(self.max_steps)

    @property
    def team_name(self) -> str:
        """The team's name, and what is wrong with it."""
        return self.named(self.team.name)

    @property
    def team_label(self) -> str:
        """Likewise, as tables and pictures show it."""
        return self.named(self.team.label)

    def named(self, text: str) -> str:
        """A name of the team, with what is wrong with it."""
        return f"{text} ({self.imperfections.summary})" if self.imperfections.settings else text
