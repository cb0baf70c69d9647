"""Whose episode a record is: teams and policies with their models, and what they are called."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache
from typing import NamedTuple, TypeVar

from adhoc.evaluation.records import Record

Named = TypeVar("Named")


class Team(NamedTuple):
    """A team with the model that it, or the task, asks: one block of a table."""

    name: str
    label: str
    model: str | None


class Contestant(NamedTuple):
    """A policy with its model, in a team: one row of a table."""

    team: Team
    policy: str
    label: str
    model: str | None


def contestant(record: Record) -> Contestant:
    """Whose row the episode belongs to."""
    return _contestant(
        record["team"],
        record["team_label"],
        record.get("team_model"),
        record["policy"],
        record["policy_label"],
        record["model"],
    )


@lru_cache(maxsize=4096)
def _contestant(
    team: str, team_label: str, team_model: str | None, policy: str, label: str, model: str | None
) -> Contestant:
    """There are few, and many records of each."""
    return Contestant(Team(team, team_label, team_model), policy, str(label), model)


def team_names(teams: Iterable[Team]) -> dict[Team, str]:
    """What each team is called: its label, with its name or model where the label is not enough."""
    return _distinct(
        dict.fromkeys(teams),
        lambda team: "",
        lambda team: team.label,
        [lambda team: team.model or team.name, lambda team: team.name],
    )


def labels(contestants: Iterable[Contestant]) -> dict[Contestant, str]:
    """What each row is called: the policy's label, with its model or name where one team has several."""
    return _distinct(
        dict.fromkeys(contestants),
        lambda row: row.team,
        lambda row: row.label,
        [lambda row: row.model or row.policy, lambda row: row.policy],
    )


def _distinct(
    named: Iterable[Named],
    group: Callable[[Named], object],
    label: Callable[[Named], str],
    additions: Sequence[Callable[[Named], str]],
) -> dict[Named, str]:
    """A name for each that no other of its group has: the label, and as many additions as are needed."""
    names = {it: label(it) for it in named}
    for addition in additions:
        used = Counter((group(it), name) for it, name in names.items())
        names = {
            it: f"{name} ({addition(it)})" if used[group(it), name] > 1 else name
            for it, name in names.items()
        }
    return names
