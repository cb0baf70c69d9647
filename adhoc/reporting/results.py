"""Records that are reported together: whose they are and what pairs they form, found out once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from adhoc.core.errors import RecordError
from adhoc.evaluation.records import Record
from adhoc.evaluation.settings_files import Settings, differing
from adhoc.reporting.contestants import Contestant, Team, contestant, labels, team_names
from adhoc.reporting.pairing import Pair, PairKey, alone_records, pairs

Group = tuple[Contestant, int | None]
"""A contestant and the step at which it joins; None for the team alone."""


@dataclass(frozen=True)
class Results:
    """What all tables and figures are made from."""

    records: Sequence[Record]
    groups: Mapping[Group, Sequence[Record]]
    """The records of each, in their order."""
    alone: Mapping[PairKey, Record]
    """The episodes of the teams alone."""
    pairs: Sequence[Pair]
    """Every episode with a newcomer whose team-alone episode is there."""
    teams: Mapping[Team, str]
    """What each team is called."""
    rows: Mapping[Contestant, str]
    """What each row is called."""

    @classmethod
    def of(cls, records: Sequence[Record], settings: Mapping[str, Settings] | None = None) -> Results:
        """Of records of one or more runs.

        Args:
            records: What is to be reported together.
            settings: What the `config_hash`es stand for, as far as it is known: it tells what differs.

        Raises:
            RecordError: The records do not belong together: one row would be of episodes with different
                settings, one team's rows of different settings of team, task, world or limits, or a
                newcomer's episode was measured against another one of the team alone.
        """
        groups: dict[Group, list[Record]] = {}
        for record in records:
            groups.setdefault((contestant(record), record["join_step"]), []).append(record)
        _check_settings(groups, settings or {})
        alone = alone_records(records)
        contestants = [who for who, _ in groups]
        return cls(
            records,
            groups,
            alone,
            pairs(records, alone),
            team_names(who.team for who in contestants),
            labels(contestants),
        )

    @property
    def models(self) -> tuple[str, ...]:
        """Names of the language models of the newcomers, or of the teams alone."""
        return tuple(sorted({who.model for who, _ in self.groups if who.model is not None}))


def _check_settings(groups: Mapping[Group, Sequence[Record]], known: Mapping[str, Settings]) -> None:
    first: dict[tuple[Contestant, bool], Record] = {}
    for (who, step), records in groups.items():
        usual = first.setdefault((who, step is None), records[0])
        for record in records:
            if usual["config_hash"] != record["config_hash"]:
                raise RecordError(_told_apart(usual, record, known))
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
