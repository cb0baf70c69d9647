"""Who takes part in a comparison, and how their episodes are told apart in a run folder."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from adhoc.agents.policy import Policy
from adhoc.evaluation.imperfections import PERFECT, Imperfections
from adhoc.evaluation.metrics import FailedShare
from adhoc.evaluation.predictions import WITHIN
from adhoc.evaluation.referee import PlacementReferee, RefereeMaker
from adhoc.evaluation.scenario import Scenario
from adhoc.llm.counting import CountingModel
from adhoc.tasks.task import Task

NO_AD_HOC = "none"
"""The policy name of the team alone."""


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
        return _with_faults(self.team.name, self.imperfections)

    @property
    def team_label(self) -> str:
        """Likewise, as tables and pictures show it."""
        return _with_faults(self.team.label, self.imperfections)


@dataclass(frozen=True)
class EpisodeKey:
    """Which episode: `newcomer` None is the team alone, whatever the joining step."""

    scenario: Scenario
    conditions: Conditions
    newcomer: Contender | None = None
    join_step: int | None = None

    @property
    def id(self) -> str:
        """Unique in a run folder, fit for a file name."""
        team = _with_model(self.conditions.team)
        parts = [self.scenario.id, _with_faults(team, self.conditions.imperfections)]
        parts += ["alone"] if self.newcomer is None else [_with_model(self.newcomer), f"t{self.join_step}"]
        return "--".join(_file_name(part) for part in parts)

    @property
    def settings(self) -> Mapping[str, Any]:
        """Everything but the scenario and the joining step that decides what is recorded."""
        shared: dict[str, Any] = {
            "max_steps": self.conditions.max_steps,
            "failed_share": self.conditions.failed_share.value,
            "team": self.conditions.team.settings,
            **self.conditions.settings,
        }
        if self.conditions.imperfections.settings:
            shared["imperfections"] = self.conditions.imperfections.settings
        if self.conditions.predicted_within != WITHIN:
            shared["predicted_within"] = self.conditions.predicted_within
        return shared if self.newcomer is None else {**shared, "policy": self.newcomer.settings}

    @property
    def config_hash(self) -> str:
        """A hash of `settings`."""
        text = json.dumps(self.settings, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    @property
    def scenario_id(self) -> str:
        """The id of the scenario."""
        return self.scenario.id

    @property
    def scenario_hash(self) -> str:
        """A hash of what the scenario is."""
        return self.scenario.content_hash()

    @property
    def policy(self) -> str:
        """The name of the ad hoc policy, `none` for the team alone."""
        return NO_AD_HOC if self.newcomer is None else self.newcomer.name

    @property
    def model(self) -> str | None:
        """The newcomer's model, else the team's, else the one that the task asks."""
        models = (
            None if self.newcomer is None else self.newcomer.model,
            self.conditions.team.model,
            self.conditions.model,
        )
        return next((model.name for model in models if model is not None), None)

    @property
    def team_model(self) -> str | None:
        """The model that the team, or the task, asks, whoever the newcomer is."""
        models = (self.conditions.team.model, self.conditions.model)
        return next((model.name for model in models if model is not None), None)

    @property
    def group(self) -> tuple[str, str, str | None]:
        """Episodes that only differ in scenario and joining step: they must share a `config_hash`."""
        return (self.conditions.team_name, self.policy, self.model)


def _with_model(contender: Contender) -> str:
    """The name, with that of the model where there is one (but for remarks in brackets)."""
    model = contender.model_name
    return contender.name if model is None else f"{contender.name}-{re.sub(r' *[(].*?[)]', '', model)}"


def _with_faults(text: str, imperfections: Imperfections) -> str:
    return f"{text} ({imperfections.summary})" if imperfections.settings else text


def _file_name(text: str) -> str:
    return re.sub(r"[^A-Za-z0-9._]+", "-", text).strip("-")
