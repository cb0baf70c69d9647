"""Which records belong together: an episode with a newcomer, and that of the team alone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from adhoc.core.errors import RecordError
from adhoc.evaluation.records import Record
from adhoc.reporting.contestants import Contestant, contestant

PairKey = tuple[str, ...]


class Pair(NamedTuple):
    """An episode with a newcomer and the team alone in the same scenario under the same limits."""

    joined: Record
    alone: Record
    who: Contestant
    """Whose row it is in."""


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
