"""What a policy is called whose seats or dialect are others than its configuration file has."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from omegaconf import OmegaConf

from adhoc.agents.dialects.structured import Structured
from adhoc.cli.build import TARGET, is_component
from adhoc.cli.seats import SEATS
from adhoc.cli.speech import DIALECT
from adhoc.core.resources import data_dir
from adhoc.evaluation.imperfections import shortened

GROUPS = ("team", "policy")
"""Where a seat may have been taken from."""


def told_apart(config: Mapping[str, Any], group: str, field: str) -> str:
    """The name of a configured policy, and in brackets what was changed of the library's choice of that name.

    Seats and dialect are told, as in `heuristic (seat 1 nearest_first, dialect silent)`; a long list of them
    is told by a hash. A policy whose `name` is none of the library's has the seats and the dialect of its own
    file, and is called what it says.

    Args:
        config: As `seats.numbered_seats` returns it, with `name` and `label`.
        group: The group of the choice: `team` or `policy`.
        field: Which of the two to tell: `name` or `label`.
    """
    text = str(config[field])
    shipped = _shipped(group, config["name"])
    if shipped is None:
        return text
    remarks = [*_seats(config, shipped, field)]
    if _dialect(config) != _dialect(shipped):
        remarks.append(f"dialect {_dialect(config)}")
    return f"{text} ({shortened(', '.join(remarks), 'changed')})" if remarks else text


def _seats(config: Mapping[str, Any], shipped: Mapping[str, Any], field: str) -> Iterator[str]:
    """What the seats are that are of another kind than the file's."""
    usual = {str(seat): it for seat, it in (shipped.get(SEATS) or {}).items()}
    for seat, seated in sorted(config.get(SEATS, {}).items(), key=lambda item: int(item[0])):
        before = usual.get(seat)
        if before is None or (_kind(before), _dialect(before)) != (_kind(seated), _dialect(seated)):
            yield f"seat {seat} {_seated(seated, field)}"


def _seated(config: Mapping[str, Any], field: str) -> str:
    """A seat's policy: its own name, else that of its class; and its dialect, if that is not its own."""
    name = config.get("name")
    text = str(config.get(field) or name or _kind(config).rpartition(".")[2])
    files = (_shipped(group, name) for group in GROUPS)
    usual = next((_dialect(shipped) for shipped in files if shipped is not None), Structured.name)
    return text if _dialect(config) == usual else f"{text} in {_dialect(config)}"


def _kind(config: Mapping[str, Any]) -> str:
    agent = config.get("agent")
    return str(agent.get(TARGET)) if isinstance(agent, Mapping) else str(agent)


def _dialect(config: Mapping[str, Any]) -> str:
    given = config.get(DIALECT)
    if isinstance(given, Mapping) and is_component(given):
        return str(given[TARGET]).rpartition(".")[2]
    return Structured.name if given is None else str(given)


@cache
def _shipped(group: str, name: object) -> Mapping[str, Any] | None:
    """The library's choice of that name as its file has it; None if there is none."""
    path = data_dir("configs") / group / f"{name}.yaml"
    if not str(name).isidentifier() or not path.is_file():
        return None
    config = OmegaConf.to_container(OmegaConf.load(path))
    return {str(key): value for key, value in config.items()} if isinstance(config, dict) else None
