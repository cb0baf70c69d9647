"""From the configuration of a run to the values and objects that `evaluation` works with."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import MissingMandatoryValue

from adhoc.agents.human.terminal import Terminal
from adhoc.agents.policy import Policy
from adhoc.cli.build import Offer, build, is_component
from adhoc.cli.contender_names import told_apart
from adhoc.cli.model_chain import OuterModel, hashed_settings, outer_model, provider_model
from adhoc.cli.seats import SEATS, at_seat, check_seats, numbered_seats
from adhoc.cli.speech import speaking, without_default_speech
from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.benchmark import Benchmark
from adhoc.evaluation.contender import NO_AD_HOC, Conditions, Contender
from adhoc.evaluation.imperfections import Imperfections
from adhoc.evaluation.metrics import FailedShare
from adhoc.llm.model import LanguageModel
from adhoc.llm.team_model import TeamModel
from adhoc.planning.interfaces import (
    Evaluator,
    Negotiator,
    Planner,
    Reflector,
    SubSkillPlanner,
    SubTaskGenerator,
)
from adhoc.tasks.task import Task
from adhoc.worlds.world import World

AGENT = "agent"
"""The key of a policy's configuration that describes the policy itself; its other components are stages."""
STAGES: Mapping[str, type] = {
    "generator": SubTaskGenerator,
    "evaluator": Evaluator,
    "reflector": Reflector,
    "planner": Planner,
    "negotiator": Negotiator,
    "sub_skill_planner": SubSkillPlanner,
}
"""What the stages of the paper must be; stages of other names may be anything."""
TEAM = "team"
FINGERPRINT = "fingerprint of "
"""Begins the names of settings that tell what a policy's data are."""
SESSIONS = "sessions"
"""The folder in the run folder for what people typed who played a robot."""


class Components:
    """Everything that one run is made of, built from its configuration.

    The language model is built once, and only if a policy asks for it. Raises ConfigurationError, or
    whatever the components raise.

    Args:
        config: The composed configuration.
        provider: What answers the questions of all episodes, or builds that, if it is not to be built here
            (see `cli.model_chain.provider_model`): a worker's way to the one that its parent owns.
        world: The world of all episodes, if it is shared with others.
    """

    def __init__(
        self,
        config: DictConfig,
        provider: LanguageModel | Callable[[], LanguageModel] | None = None,
        world: World | None = None,
    ) -> None:
        self._config, self._given_provider, self._given_world = config, provider, world
        self._asked_for_model = self._task_asked_for_model = False
        self._fingerprints: dict[str, str] = {}

    @cached_property
    def world(self) -> World:
        """The world of all episodes."""
        world: World = self._given_world or self._component("world", World)
        return world

    @cached_property
    def benchmark(self) -> Benchmark:
        """Where the scenarios come from."""
        benchmark: Benchmark = self._component("benchmark", Benchmark)
        return benchmark

    @cached_property
    def conditions(self) -> Conditions:
        """Task, team and limits."""
        task, model = self._task, None
        settings = {"task": self._plain("task"), "world": self._plain("world")}
        if self._task_asked_for_model:
            settings["task"].update(hashed_settings(self._config, self._plain("llm")))
            model = self._model.counting
        if task.common_sense is not None and task.common_sense.fingerprint:
            settings["task"][f"{FINGERPRINT}task"] = task.common_sense.fingerprint
        imperfections: Imperfections = self._component("imperfections", Imperfections)
        most = self._largest_team if imperfections.settings else None
        if most is not None:
            imperfections.check_seats(most)
        return Conditions(
            task,
            self._contender(TEAM, self._plain(TEAM)),
            self._config.max_steps,
            failed_share=self._failed_share,
            settings=settings,
            model=model,
            imperfections=imperfections,
            predicted_within=self._config.predicted_within,
        )

    @cached_property
    def newcomer(self) -> Contender | None:
        """The ad hoc robot; None for `policy=none`."""
        return self.newcomer_of(self._config)

    def newcomer_of(self, config: DictConfig) -> Contender | None:
        """The ad hoc robot of a configuration that differs from this one in policy and joining step alone."""
        plain = _plain(config, "policy")
        return None if plain.get("name") == NO_AD_HOC else self._contender("policy", plain)

    def fingerprints(self, newcomer: Contender | None) -> dict[str, str]:
        """What the benchmark, the team and a newcomer say of their data, such as trained weights."""
        contenders = [self.conditions.team, *([] if newcomer is None else [newcomer])]
        settings = [self.conditions.settings["task"], *(one.settings for one in contenders)]
        told = [(name, value) for one in settings for name, value in one.items()]
        known = {name: str(value) for name, value in told if name.startswith(FINGERPRINT)}
        return {"benchmark": self._benchmark_fingerprint, **known}

    @cached_property
    def _benchmark_fingerprint(self) -> str:
        return self.benchmark.fingerprint

    def _contender(self, group: str, plain: Mapping[str, Any]) -> Contender:
        config = numbered_seats(plain, group)
        _check_fields(config, ("name", "label", AGENT), group)
        most = self._largest_team if config.get(SEATS) else None
        if most is not None:
            check_seats(config, group, most)
        self._asked_for_model, self._fingerprints = False, {}
        self._make_policy(group, group, config)
        for seat in config.get(SEATS, ()):
            self._make_policy(group, *at_seat(config, group, int(seat)))
        settings, model = {**without_default_speech(config), **self._fingerprints}, None
        if self._asked_for_model:
            settings = {**settings, **hashed_settings(self._config, self._plain("llm"))}
            model = self._model.counting

        def make(seat: int = 0) -> Policy:
            return self._make_policy(group, *at_seat(config, group, seat))

        name, label = (told_apart(config, group, field) for field in ("name", "label"))
        return Contender(name, label, make, settings, model)

    @property
    def _largest_team(self) -> int | None:
        return self.benchmark.largest_team(self._config.limit)

    def _make_policy(self, group: str, place: str, config: Mapping[str, Any]) -> Policy:
        """A fresh policy with fresh stages; they share the model alone. `place` is where `config` is."""
        _check_fields(config, (AGENT,), place)
        offers: dict[str, Offer] = {
            "model": lambda: self._offer_model(group),
            "exchanges": lambda: self._model.transcriber.take,
            "legal": lambda: self._task.legal,
            "legal_skill": lambda: self._task.legal_skill,
            "sessions": lambda: Path(str(self._config.out)) / SESSIONS,
            "configured_at": lambda: f"{place}.{AGENT}",
            "terminal": lambda: self._terminal,
        }
        for name, stage in config.items():
            if name != AGENT and is_component(stage):
                offers[name] = _stage_offer(stage, f"{place}.{name}", offers, STAGES.get(name))
        policy: Policy = build(config[AGENT], f"{place}.{AGENT}", offers, Policy)
        if policy.fingerprint:
            self._fingerprints[f"{FINGERPRINT}{place}"] = policy.fingerprint
        return speaking(policy, config, place)

    @cached_property
    def _terminal(self) -> Terminal:
        return Terminal(must_begin=True)

    @property
    def _failed_share(self) -> FailedShare:
        try:
            return FailedShare(self._config.failed_share)
        except ValueError as error:
            known = ", ".join(share.value for share in FailedShare)
            raise ConfigurationError(
                f"failed_share={self._config.failed_share}: must be one of {known}"
            ) from error

    @cached_property
    def _task(self) -> Task:
        task: Task = self._component("task", Task, {"model": self._offer_model_to_task})
        return task

    @cached_property
    def provider(self) -> LanguageModel:
        """What answers the questions of all episodes."""
        given = self._given_provider
        if isinstance(given, LanguageModel):
            return given
        return provider_model(self._config, self._plain("llm")) if given is None else given()

    def _offer_model_to_task(self) -> LanguageModel:
        self._task_asked_for_model = True
        return self._model.model

    def _offer_model(self, group: str) -> LanguageModel:
        self._asked_for_model = True
        model = self._model.model
        return TeamModel(model) if group == TEAM else model

    @cached_property
    def _model(self) -> OuterModel:
        return outer_model(self._config, self._plain("llm"), self.provider)

    def _component(self, group: str, kind: type, offers: Mapping[str, Offer] | None = None) -> Any:
        config = self._plain(group)
        settings = {name: value for name, value in config.items() if name != "name"}
        return build(settings, group, offers, kind)

    def _plain(self, group: str) -> dict[str, Any]:
        return _plain(self._config, group)


def _plain(config: DictConfig, group: str) -> dict[str, Any]:
    """One group as plain values."""
    try:
        plain = OmegaConf.to_container(config[group], resolve=True, throw_on_missing=True)
    except MissingMandatoryValue as error:
        raise ConfigurationError(f"{error.full_key}=...: must be given") from error
    if not isinstance(plain, dict):
        raise ConfigurationError(f"{group}={plain!r}: is no configuration group")
    return {str(name): value for name, value in plain.items()}


def _check_fields(config: Mapping[str, Any], needed: Sequence[str], place: str) -> None:
    for field in needed:
        if field not in config:
            raise ConfigurationError(f"{place}: field {field!r} is missing in the configuration file")


def _stage_offer(
    stage: Mapping[str, Any], where: str, offers: Mapping[str, Offer], kind: type | None
) -> Offer:
    return lambda: build(stage, where, offers, kind)
