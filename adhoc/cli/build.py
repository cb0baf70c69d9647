"""Building components from configuration: `_target_` names a class, the rest are its arguments.

Hydra's own `instantiate` turns dataclasses into configuration objects on the way and would build one model
for each stage that refers to it. Here everything is plain values, and what a class needs beyond its
own settings it gets by the name of its parameter.
"""

from __future__ import annotations

import inspect
import traceback
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

from adhoc.cli.argument_types import check_types
from adhoc.core.errors import ConfigurationError

TARGET = "_target_"

Offer = Callable[[], object]
"""Makes, or returns, what a parameter of that name is given; called only if a class asks for it."""


def build(
    config: Mapping[str, Any],
    where: str,
    offers: Mapping[str, Offer] | None = None,
    kind: type | None = None,
) -> Any:
    """The object that `config` describes.

    Nested mappings with a `_target_` are built first. A parameter that `config` does not set and that has
    the name of an offer gets what was offered.

    Args:
        config: Plain values and one `_target_`, the dotted name of a class or function.
        where: Place of `config` in the configuration, for error texts, e.g. `policy.generator`.
        offers: By parameter name.
        kind: What the object must be an instance of; anything if None.

    Raises:
        ConfigurationError: The target is missing or cannot be imported, an argument does not fit, the
            constructor raised a TypeError or ValueError (its cause), or the object is no `kind`.
    """
    offers = offers or {}
    target = locate(config, where)
    settings = {
        name: _value(value, f"{where}.{name}", offers) for name, value in config.items() if name != TARGET
    }
    arguments = dict(settings)
    parameters = parameters_of(target, where)
    for name, offer in offers.items():
        if name in parameters and name not in arguments:
            arguments[name] = offer()
    _check_arguments(target, arguments, where)
    check_types(target, settings, where)
    built = _call(target, arguments, settings, where)
    if kind is not None and not isinstance(built, kind):
        raise ConfigurationError(f"{where}: {type(built).__name__} is no {kind.__name__}")
    return built


def is_component(config: object) -> bool:
    """Whether a configuration value describes an object to be built."""
    return isinstance(config, Mapping) and TARGET in config


def locate(config: object, where: str) -> Callable[..., Any]:
    """The class or function that `config` names. Raises ConfigurationError if there is none."""
    if not isinstance(config, Mapping):
        raise ConfigurationError(f"{where}={config!r}: is no component; it needs a {TARGET}")
    path = config.get(TARGET)
    parts = path.split(".") if isinstance(path, str) else []
    if len(parts) < 2 or not all(part.isidentifier() for part in parts):
        raise ConfigurationError(
            f"{where}.{TARGET}={path!r}: must be the dotted name of a class, e.g. package.module.Class"
        )
    try:
        target = getattr(import_module(".".join(parts[:-1])), parts[-1])
    except (ImportError, AttributeError) as error:
        raise ConfigurationError(f"{where}.{TARGET}={path}: cannot be imported ({error})") from error
    if not callable(target):
        raise ConfigurationError(f"{where}.{TARGET}={path}: is no class or function")
    return target  # type: ignore[no-any-return]


def parameters_of(target: Callable[..., Any], where: str) -> Mapping[str, inspect.Parameter]:
    """The parameters by name. Raises ConfigurationError for built-in classes that do not tell them."""
    try:
        return inspect.signature(target).parameters
    except ValueError as error:
        raise ConfigurationError(
            f"{where}.{TARGET}={_path(target)}: cannot be configured: its parameters are unknown"
        ) from error


def _value(value: object, where: str, offers: Mapping[str, Offer]) -> object:
    return build(value, where, offers) if isinstance(value, Mapping) and TARGET in value else value


def _check_arguments(target: Callable[..., Any], arguments: Mapping[str, object], where: str) -> None:
    signature = inspect.signature(target)
    try:
        signature.bind(**arguments)
    except TypeError as error:
        known = ", ".join(signature.parameters) or "none"
        raise ConfigurationError(f"{where}: {_path(target)} {error}; its parameters are: {known}") from error


def _call(
    target: Callable[..., Any], arguments: Mapping[str, object], settings: Mapping[str, object], where: str
) -> object:
    try:
        return target(**arguments)
    except (TypeError, ValueError) as error:
        given = ", ".join(f"{where}.{name}={value!r}" for name, value in settings.items()) or where
        place = traceback.extract_tb(error.__traceback__)[-1]
        raise ConfigurationError(
            f"{given}: {_path(target)} cannot be made of this: {type(error).__name__}: {error} "
            f"({place.filename}, line {place.lineno})"
        ) from error


def _path(target: Callable[..., Any]) -> str:
    return f"{target.__module__}.{getattr(target, '__qualname__', target)}"
