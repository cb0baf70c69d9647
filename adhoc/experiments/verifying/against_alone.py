"""Whether what a record says of the team alone follows from that team's own record."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from adhoc.evaluation.metrics import efficiency
from adhoc.evaluation.recording import unpack_history
from adhoc.evaluation.records import Record
from adhoc.experiments.verifying.finding import Finding, NumberedRecord, Trouble, expected
from adhoc.reporting.pairing import PairKey, pair_key


def pairing_findings(records: Sequence[NumberedRecord]) -> Iterator[Finding]:
    """What does not follow, for every record of a newcomer and of a team alone."""
    alone: dict[PairKey, NumberedRecord] = {}
    for it in records:
        if it.record["join_step"] is not None:
            continue
        for field in ("reference_temporal_steps", "efficiency"):
            yield from map(it.finding, expected(field, it.record[field], None, "of the team alone it"))
        other = alone.setdefault(pair_key(it.record), it)
        if other is not it:
            yield it.finding(
                ("episode_id", f"the same team alone in the same scenario is in line {other.line}")
            )
    for it in records:
        if it.record["join_step"] is not None:
            partner = alone.get(pair_key(it.record))
            yield from map(it.finding, _missing() if partner is None else _against(it.record, partner))


def _missing() -> Iterator[Trouble]:
    yield (
        "reference_temporal_steps",
        "cannot be checked: there is no intact record of the same team alone in the same scenario",
    )


def _against(record: Record, partner: NumberedRecord) -> Iterator[Trouble]:
    alone, where = partner.record, f"of the team alone in line {partner.line}"
    reference = alone["temporal_steps"]
    yield from expected(
        "reference_temporal_steps", record["reference_temporal_steps"], reference, f"temporal_steps {where}"
    )
    term = efficiency(reference, record["temporal_steps"], record["success"])
    yield from expected("efficiency", record["efficiency"], term, f"with the temporal_steps {where} it")
    links = unpack_history(alone["history"] or "")
    shared = record["join_step"] if record["joined"] else record["steps"]
    if shared >= len(links):
        yield "join_step", f"the past to step {shared} is not that {where}, which ended at {len(links) - 1}"
    else:
        yield from expected(
            "history_hash", record["history_hash"], links[shared], f"link {shared} of history {where}"
        )
