"""Hydra's and OmegaConf's errors as one line that says what would be right."""

from __future__ import annotations

import re
from dataclasses import fields

from omegaconf import DictConfig
from omegaconf.errors import ConfigAttributeError, ConfigKeyError

from adhoc.cli.build import TARGET
from adhoc.cli.schema import RunConfig

_OPTIONS = re.compile(
    r"Available options in '(?P<group>[^']+)':\s*(?P<options>.*?)(?:\nConfig search path|\Z)", re.DOTALL
)
_UNKNOWN_OPTION = re.compile(r"Could not find '(?P<choice>[^']+)'")
_ALREADY_THERE = re.compile(r"An item is already at '(?P<key>[^']+)'")


def one_line(error: Exception) -> str:
    """The error's text without line breaks and traces, with the valid values where there is a list."""
    text = _whole_text(error)
    options, unknown = _OPTIONS.search(text), _UNKNOWN_OPTION.search(text)
    if options and unknown:
        group = options["group"]
        known = ", ".join(options["options"].split())
        return f"{group}={unknown['choice'].removeprefix(f'{group}/')}: no such choice; there are: {known}"
    there = _ALREADY_THERE.search(text)
    if there:
        return f"+{there['key']}=...: is set already; leave out the '+'"
    parent = _parent_of_unknown_key(error)
    if parent is not None:
        return _unknown_key(parent, text)
    return "; ".join(line.strip() for line in text.splitlines() if _is_told(line))


def _parent_of_unknown_key(error: BaseException | None) -> DictConfig | None:
    """The place at which a key was given that is not there."""
    while error is not None:
        parent = getattr(error, "parent_node", None)
        if isinstance(error, (ConfigAttributeError, ConfigKeyError)) and isinstance(parent, DictConfig):
            return parent
        error = error.__cause__
    return None


def _unknown_key(parent: DictConfig, text: str) -> str:
    first = text.splitlines()[0].strip().removesuffix(".")
    place = parent._get_full_key(None)
    if not place:
        known = ", ".join(field.name for field in fields(RunConfig))
        return f"{first}: there is no such key (keys of a run: {known})"
    known = ", ".join(str(key) for key in parent)
    more = f"; +{place}.KEY=VALUE sets any other parameter of {parent[TARGET]}" if TARGET in parent else ""
    return f"{first}: there is no such key (keys of {place}: {known}{more})"


def _whole_text(error: BaseException) -> str:
    cause = error.__cause__
    own = str(error)
    return own if cause is None or str(cause) in own else f"{own}\n{_whole_text(cause)}"


def _is_told(line: str) -> bool:
    """Whether a line says something to a person: object types and reference paths do not."""
    return bool(line.strip()) and not line.strip().startswith(
        ("object_type=", "full_key:", "reference_type=")
    )
