"""How episodes are told apart in a run folder."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from adhoc.evaluation.contender import NO_AD_HOC, Conditions, Contender
from adhoc.evaluation.predictions import WITHIN
from adhoc.evaluation.scenario import Scenario


@dataclass(frozen=True)
class EpisodeKind:
    """All that decides an episode but its scenario: `newcomer` None is the team alone, whatever the joining
    step."""

    conditions: Conditions
    newcomer: Contender | None = None
    join_step: int | None = None
    run: str = ""
    """The id of the run that its episodes are made by, for their records; it decides nothing."""

    def id_in(self, scenario_id: str) -> str:
        """The id of the episode in the scenario of that id: unique in a run folder, fit for a file name."""
        team = _with_model(self.conditions.team)
        parts = [scenario_id, self.conditions.named(team)]
        parts += ["alone"] if self.newcomer is None else [_with_model(self.newcomer), f"t{self.join_step}"]
        return "--".join(_file_name(part) for part in parts)

    @cached_property
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

    @cached_property
    def config_hash(self) -> str:
        """A hash of `settings`."""
        return settings_hash(self.settings)

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


@dataclass(frozen=True)
class EpisodeKey:
    """Which episode: one of a kind, in a scenario."""

    scenario: Scenario
    kind: EpisodeKind

    @property
    def id(self) -> str:
        """See `EpisodeKind.id_in`."""
        return self.kind.id_in(self.scenario.id)

    @property
    def scenario_id(self) -> str:
        """The id of the scenario."""
        return self.scenario.id

    @property
    def scenario_hash(self) -> str:
        """A hash of what the scenario is."""
        return self.scenario.content_hash()


def settings_hash(settings: Mapping[str, Any]) -> str:
    """The `config_hash` of an episode's settings."""
    text = json.dumps(settings, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _with_model(contender: Contender) -> str:
    """The name, with that of the model where there is one (but for remarks in brackets)."""
    model = contender.model_name
    return contender.name if model is None else f"{contender.name}-{re.sub(r' *[(].*?[)]', '', model)}"


def _file_name(text: str) -> str:
    return re.sub(r"[^A-Za-z0-9._]+", "-", text).strip("-")
