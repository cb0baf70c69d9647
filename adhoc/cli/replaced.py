"""Putting another class in a component's place on the command line: `policy.agent._target_=my.Policy`."""

from __future__ import annotations

import inspect
from collections.abc import Sequence

from omegaconf import DictConfig, OmegaConf, open_dict

from adhoc.cli.build import TARGET, locate, parameters_of
from adhoc.core.errors import ConfigurationError

KEPT = (TARGET, "name", "price")


def drop_foreign_settings(config: DictConfig, overrides: Sequence[str]) -> None:
    """Take out of `config` the settings that a component's file has for the class that was replaced.

    What was given in `overrides` stays, and so does what the new class has a parameter for.

    Args:
        config: The composed configuration; it is changed.
        overrides: As on the command line, e.g. `["world._target_=my_world.World"]`.
    """
    given = {override.partition("=")[0].lstrip("+") for override in overrides}
    for key in given:
        place = key.removesuffix(f".{TARGET}")
        component = OmegaConf.select(config, place) if place != key else None
        if isinstance(component, DictConfig):
            _drop(component, place, given)


def _drop(component: DictConfig, place: str, given: set[str]) -> None:
    try:
        known = parameters_of(locate({TARGET: component[TARGET]}, place), place)
    except ConfigurationError:
        return  # `build` says it, if the component is used at all
    if any(parameter.kind is inspect.Parameter.VAR_KEYWORD for parameter in known.values()):
        return
    for name in list(component):
        path = f"{place}.{name}"
        is_given = any(key == path or key.startswith(f"{path}.") for key in given)
        if name not in KEPT and name not in known and not is_given:
            with open_dict(component):
                del component[name]
