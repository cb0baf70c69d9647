"""From the configurations of a run to what it compares."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from typing import Any

from omegaconf import DictConfig, OmegaConf

from adhoc.cli.artifacts import artifacts_for
from adhoc.cli.contestants import Components
from adhoc.cli.model_chain import provider_model
from adhoc.cli.shards import folder_of
from adhoc.core.errors import AdhocError
from adhoc.evaluation.scenario import Scenario
from adhoc.experiments.comparison import Comparison, Comparisons, Entrant
from adhoc.llm.model import LanguageModel
from adhoc.worlds.world import World

OF_ENTRANTS = ("policy", "join_step")
"""What configurations of one comparison may differ in."""


RunOf = Callable[[int, Mapping[str, str]], str]
"""Gives the id of the run by the place of its configuration in the list, and by what its components say of
their data."""


def make_comparisons(
    configs: Sequence[Mapping[str, Any]], runs: Sequence[str], own_model: bool, model: LanguageModel
) -> Comparisons:
    """What a run compares around a model of another process, or one of its own, from plain values."""
    composed = [OmegaConf.create(dict(config)) for config in configs]
    provider = provider_of(composed[0]) if own_model else lambda: model
    return comparisons_of(composed, provider, lambda place, _: runs[place])


def provider_of(config: DictConfig) -> Callable[[], LanguageModel]:
    """Builds, when it is needed first, what answers the questions of all episodes of a run."""
    return cache(partial(provider_model, config, OmegaConf.to_container(config.llm, resolve=True)))


def comparisons_of(
    configs: Sequence[DictConfig], provider: Callable[[], LanguageModel], run_of: RunOf
) -> Comparisons:
    """What a run compares: one comparison for each team and its conditions, with the newcomers and joining
    steps that meet it. Comparisons of equal worlds share one.

    Args:
        configs: Composed; they agree in all that a run has once, such as the language model.
        provider: Gives what answers the questions of all episodes.
        run_of: Called once for each configuration when its components are built.
    """
    groups: dict[str, list[tuple[int, DictConfig]]] = {}
    for place, config in enumerate(configs):
        groups.setdefault(_text(config, OF_ENTRANTS), []).append((place, config))
    shared = _Shared()
    return Comparisons([partial(_comparison, group, provider, shared, run_of) for group in groups.values()])


class _Shared:
    """Worlds and scenarios that comparisons have in common, by their configuration."""

    def __init__(self) -> None:
        self._worlds: dict[str, World] = {}
        self._scenarios: dict[str, Sequence[Scenario]] = {}

    def components(self, config: DictConfig, provider: Callable[[], LanguageModel]) -> Components:
        key = _values(config, "world")
        made = Components(config, provider, self._worlds.get(key))
        self._worlds[key] = made.world
        return made

    def scenarios(self, config: DictConfig, components: Components) -> Sequence[Scenario]:
        key = _values(config, "world", "benchmark", "seed", "limit")
        if key not in self._scenarios:
            made = components.benchmark.scenarios(components.world, config.seed, config.limit)
            self._scenarios[key] = made
        return self._scenarios[key]


def _comparison(
    configs: Sequence[tuple[int, DictConfig]],
    provider: Callable[[], LanguageModel],
    shared: _Shared,
    run_of: RunOf,
) -> Comparison:
    first = configs[0][1]
    components = shared.components(first, provider)
    try:
        conditions = components.conditions
        scenarios = shared.scenarios(first, components)
        newcomers = [components.newcomer_of(config) for _, config in configs]
        runs = [
            run_of(place, components.fingerprints(newcomer))
            for (place, _), newcomer in zip(configs, newcomers)
        ]
    except AdhocError:
        components.world.close()
        raise
    entrants = [
        Entrant(newcomer, config.join_step, run)
        for (_, config), newcomer, run in zip(configs, newcomers, runs)
        if newcomer is not None
    ]
    artifacts = artifacts_for(folder_of(first), first.pictures, first.transcript)
    return Comparison(components.world, scenarios, conditions, tuple(entrants), tuple(artifacts), runs[0])


def _text(config: DictConfig, without: Sequence[str]) -> str:
    plain = OmegaConf.to_container(config, resolve=True)
    kept = {str(name): value for name, value in dict(plain).items() if name not in without}
    return json.dumps(kept, sort_keys=True, default=str)


def _values(config: DictConfig, *names: str) -> str:
    plain = OmegaConf.to_container(OmegaConf.create({name: config[name] for name in names}), resolve=True)
    return json.dumps(plain, sort_keys=True, default=str)
