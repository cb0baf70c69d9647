"""Which records belong together: an episode with a newcomer, and that of the team alone."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple, TypeVar

from adhoc.core.errors import RecordError
from adhoc.evaluation.records import Record
from adhoc.evaluation.settings_files import Settings, differing

PairKey = tuple[str, ...]
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


class Pair(NamedTuple):
    """An episode with a newcomer and the team alone in the same scenario under the same limits."""

    joined: Record
    alone: Record
    who: Contestant
    """Whose row it is in."""


def team_of(record: Record) -> Team:
    """The team of an episode."""
    return contestant(record).team


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


def pair_key(record: Record) -> PairKey:
    """Equal for an episode and that of the team alone in the same scenario under the same limits."""
    scenario = (record["task_id"], record["scenario_hash"])
    return (record["team"], str(record.get("team_model")), *scenario, str(record["max_steps"]))


def alone_records(records: Iterable[Record]) -> dict[PairKey, Record]:
    """The episodes of teams alone. Raises RecordError for two of one team in one scenario."""
    found: dict[PairKey, Record] = {}
    for record in records:
        if record["join_step"] is None:
            other = found.setdefault(pair_key(record), record)
            if other is not record:
                raise RecordError(
                    f"{other['episode_id']!r} and {record['episode_id']!r} are one team alone in one "
                    "scenario; report the runs apart"
                )
    return found


def pairs(records: Iterable[Record], alone: Mapping[PairKey, Record]) -> list[Pair]:
    """All episodes with a newcomer whose team-alone episode is among `alone_records`, in their order.

    Raises RecordError for a newcomer that was measured against another episode of the team alone.
    """
    joined = ((record, alone.get(pair_key(record))) for record in records if record["join_step"] is not None)
    found = [
        Pair(record, reference, contestant(record)) for record, reference in joined if reference is not None
    ]
    for pair in found:
        reference = pair.joined.get("reference_temporal_steps")
        if reference is not None and reference != pair.alone["temporal_steps"]:
            raise RecordError(
                f"{pair.joined['episode_id']!r} was measured against a team alone of {reference} steps, and "
                f"{pair.alone['episode_id']!r} took {pair.alone['temporal_steps']}: they are of different "
                "runs; remove the one that is wrong, or report the runs apart"
            )
    return found


def check_settings(records: Iterable[Record], settings: Mapping[str, Settings] | None = None) -> None:
    """Raise RecordError if one row would be of episodes with different settings, or one team's rows of
    different settings of team, task, world or limits.

    Args:
        records: What is to be reported together.
        settings: What the `config_hash`es stand for, as far as it is known: it tells what differs.
    """
    known = settings or {}
    first: dict[tuple[Contestant, bool], Record] = {}
    for record in records:
        row = (contestant(record), record["join_step"] is None)
        other = first.setdefault(row, record)
        if other["config_hash"] != record["config_hash"]:
            raise RecordError(_told_apart(other, record, known))
    shared: dict[Team, tuple[Record, Settings]] = {}
    for (who, _), record in first.items():
        if record["config_hash"] not in known:
            continue
        mine = {name: value for name, value in known[record["config_hash"]].items() if name != "policy"}
        other, theirs = shared.setdefault(who.team, (record, mine))
        if theirs != mine:
            parts = {other["config_hash"]: theirs, record["config_hash"]: mine}
            raise RecordError(_told_apart(other, record, parts))


def _told_apart(one: Record, other: Record, settings: Mapping[str, Settings]) -> str:
    hashes = [record["config_hash"] for record in (one, other)]
    before, now = (settings.get(name) for name in hashes)
    told = "" if before is None or now is None else differing(before, now, "in the first", "in the other")
    return (
        f"{one['episode_id']!r} and {other['episode_id']!r} were run with different settings "
        f"({told or f'config_hash {hashes[0]} and {hashes[1]}'}); report the runs apart, or give one of "
        "them a name of its own"
    )


def team_names(records: Iterable[Record]) -> dict[Team, str]:
    """What each team is called: its label, with its name or model where the label is not enough."""
    return _distinct(
        dict.fromkeys(map(team_of, records)),
        lambda team: "",
        lambda team: team.label,
        [lambda team: team.model or team.name, lambda team: team.name],
    )


def labels(records: Iterable[Record]) -> dict[Contestant, str]:
    """What each row is called: the policy's label, with its model or name where one team has several."""
    return _distinct(
        dict.fromkeys(map(contestant, records)),
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
