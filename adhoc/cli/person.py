"""Runs in which a person plays a robot at the terminal: what such a run cannot do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from omegaconf import DictConfig, OmegaConf

from adhoc.cli.build import TARGET, is_component, locate
from adhoc.core.errors import ConfigurationError


def asks_person(config: DictConfig) -> bool:
    """Whether a robot of the run asks a person at the terminal.

    Raises ConfigurationError if it does, and the run has several processes, or is none: a dry run.
    """
    places = [
        place
        for group in ("policy", "team")
        for place in _places(OmegaConf.to_container(config[group], resolve=True), group)
    ]
    if not places:
        return False
    hint = f"play from a file with +{places[0]}.script=FILE"
    if config.workers > 1:
        raise ConfigurationError(
            f"workers={config.workers}: {places[0]} asks a person at the terminal, which only one "
            f"process can do: set workers=1, or {hint}"
        )
    if config.dry_run:
        raise ConfigurationError(f"dry_run=true: {places[0]} asks a person at the terminal: {hint}")
    return True


def _places(config: Any, place: str) -> Iterator[str]:
    """Where in the configuration a policy is that asks a person."""
    if not isinstance(config, Mapping):
        return
    if is_component(config) and config.get("script") is None and _is_human(config, place):
        yield place
    for name, value in config.items():
        yield from _places(value, f"{place}.{name}")


def _is_human(config: Mapping[str, Any], place: str) -> bool:
    path = str(config[TARGET])
    if path.startswith("adhoc.") and ".human." not in path:
        return False  # spares loading what has nothing to do with it
    from adhoc.agents.human.policy import HumanPolicy

    target = locate(config, place)
    return isinstance(target, type) and issubclass(target, HumanPolicy)
