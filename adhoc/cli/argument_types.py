"""Checking plain settings against the annotations of a constructor, before it meets them."""

from __future__ import annotations

import types
from collections.abc import Callable, Mapping
from typing import Any, Union, get_args, get_origin, get_type_hints

from adhoc.core.errors import ConfigurationError

PLAIN = (bool, int, float, str, type(None))
"""The types that are checked; a parameter that may be anything else is left to its constructor."""


def check_types(target: Callable[..., Any], settings: Mapping[str, object], where: str) -> None:
    """Raise ConfigurationError if a setting is of another type than its parameter is annotated with.

    A whole number is a float, too; a truth value is no number.
    """
    hints = _hints(target)
    for name, value in settings.items():
        wanted = _members(hints.get(name, Any))
        if all(kind in PLAIN for kind in wanted) and not any(_fits(value, kind) for kind in wanted):
            names = " or ".join("null" if kind is type(None) else kind.__name__ for kind in wanted)
            raise ConfigurationError(f"{where}.{name}={value!r}: must be {names}")


def _hints(target: Callable[..., Any]) -> Mapping[str, Any]:
    """The annotations; none if they name what is only imported for type checkers."""
    if isinstance(target, type):
        target = next(vars(base)["__init__"] for base in target.__mro__ if "__init__" in vars(base))
    try:
        return get_type_hints(target)
    except (NameError, TypeError):
        return {}


def _members(hint: Any) -> tuple[Any, ...]:
    return get_args(hint) if get_origin(hint) in (Union, types.UnionType) else (hint,)


def _fits(value: object, kind: type) -> bool:
    if isinstance(value, bool):
        return kind is bool
    return isinstance(value, (int, float) if kind is float else kind)
