"""The dialect that a policy speaks, and the formats that it understands, from its configuration."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from adhoc.agents.dialects.dialect import Adapter, Dialect
from adhoc.agents.dialects.known import DIALECTS, dialect_named
from adhoc.agents.dialects.speaking import Speaking
from adhoc.agents.dialects.structured import Structured
from adhoc.agents.policy import Policy
from adhoc.cli.build import build, is_component
from adhoc.core.errors import ConfigurationError

DIALECT = "dialect"
"""The key of a policy's configuration: a known dialect's name, or a component of your own."""
ADAPTERS = "adapters"
"""Likewise: a list of components, for formats that this robot understands besides the known ones."""
_DEFAULTS = (None, Structured.name)


def speaking(policy: Policy, config: Mapping[str, Any], place: str) -> Policy:
    """The policy, in the dialect that its configuration names; itself if that is the library's own format.

    `place` is where `config` is, for errors. Raises ConfigurationError for an unknown dialect, or what is no
    dialect or adapter.
    """
    adapters = _adapters(config.get(ADAPTERS) or (), f"{place}.{ADAPTERS}")
    given = config.get(DIALECT)
    if given in _DEFAULTS and not adapters:
        return policy
    return Speaking(policy, _dialect(given, f"{place}.{DIALECT}"), adapters)


def without_default_speech(config: Mapping[str, Any]) -> dict[str, Any]:
    """A configuration without these keys where they say nothing, so that its hash is as without them."""
    silent = {DIALECT: _DEFAULTS, ADAPTERS: (None, [])}
    return {name: value for name, value in config.items() if value not in silent.get(name, ())}


def _dialect(given: object, place: str) -> Dialect:
    if is_component(given):
        dialect: Dialect = build(_mapping(given), place, kind=Dialect)
        return dialect
    name = Structured.name if given is None else given
    if not isinstance(name, str) or name not in DIALECTS:
        raise ConfigurationError(
            f"{place}={given}: must be one of {', '.join(DIALECTS)}, or a component with a _target_"
        )
    return dialect_named(name)


def _adapters(given: object, place: str) -> list[Adapter]:
    if not isinstance(given, (list, tuple)) or not all(map(is_component, given)):
        raise ConfigurationError(f"{place}={given!r}: must be a list of components, each with a _target_")
    return [build(_mapping(it), f"{place}.{number}", kind=Adapter) for number, it in enumerate(given)]


def _mapping(given: object) -> Mapping[str, Any]:
    return given if isinstance(given, Mapping) else {}
