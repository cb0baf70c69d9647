"""All checks of one run folder that need no episode to be run again."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from adhoc.core.errors import LedgerError, RecordError
from adhoc.evaluation.records import FILE_NAME, UNFINISHED_NAME, RecordFile
from adhoc.experiments.failures import FAILURES_NAME, Failure, FailureFile
from adhoc.experiments.provenance.session import LEDGER_NAME
from adhoc.experiments.verifying.against_alone import pairing_findings
from adhoc.experiments.verifying.derived import derived_troubles
from adhoc.experiments.verifying.finding import Finding, NumberedRecord
from adhoc.experiments.verifying.form import form_troubles
from adhoc.experiments.verifying.origin import MakePlan, origin_findings
from adhoc.experiments.verifying.settings import settings_findings
from adhoc.experiments.verifying.together import together_findings
from adhoc.llm.ledger.verifying import verify as verify_ledger


@dataclass(frozen=True)
class Verified:
    """What was found in a folder."""

    records: tuple[NumberedRecord, ...]
    """Those whose checksums and forms are right."""
    findings: tuple[Finding, ...]

    @property
    def faults(self) -> int:
        """Findings for which the folder fails."""
        return sum(finding.is_fault for finding in self.findings)


def verify_folder(folder: str | Path, make_plan: MakePlan) -> Verified:
    """Check a run folder: every checksum, that every derived number follows from the records, that settings
    and provenance are those of the records, that no planned episode is missing, and its ledger if it has one.

    Args:
        folder: The run folder.
        make_plan: Plans a run again from its configuration.

    Raises:
        RecordError: There are no records.
    """
    root = Path(folder)
    if not (root / FILE_NAME).is_file():
        raise RecordError(f"{root / FILE_NAME}: no episode records; is it the out=... of a run?")
    findings, records = [], []
    for line, scanned in RecordFile(root).scan():
        if isinstance(scanned, RecordError):
            findings.append(Finding(FILE_NAME, line, "", _without_place(scanned)))
            continue
        it = NumberedRecord(line, scanned)
        troubles = list(form_troubles(scanned))
        if not troubles:
            records.append(it)
            troubles = list(derived_troubles(scanned))
        findings += map(it.finding, troubles)
    if not records and not findings:
        raise RecordError(f"{root / FILE_NAME}: no episode records; is it the out=... of a run?")
    failures, told = _failures(root, {it.record["episode_id"] for it in records})
    findings += [
        *told,
        *pairing_findings(records),
        *together_findings(records),
        *settings_findings(root, records),
        *origin_findings(root, records, [it.episode_id for it in failures], make_plan),
        *_unfinished(root),
        *_ledger(root),
    ]
    return Verified(tuple(records), tuple(findings))


def _failures(folder: Path, recorded: set[str]) -> tuple[list[Failure], list[Finding]]:
    try:
        failures = [it for it in FailureFile(folder).failures if it.episode_id not in recorded]
    except RecordError as error:
        return [], [Finding(FAILURES_NAME, None, "", _without_place(error))]
    return failures, [
        Finding(FAILURES_NAME, line, "", f"episode {it.episode_id} failed: {it.error}: {it.message}")
        for line, it in enumerate(failures, start=1)
    ]


def _unfinished(folder: Path) -> Iterator[Finding]:
    for line, scanned in RecordFile(folder, UNFINISHED_NAME).scan():
        if isinstance(scanned, RecordError):
            yield Finding(UNFINISHED_NAME, line, "", _without_place(scanned))
        else:
            yield Finding(UNFINISHED_NAME, line, "", f"episode {scanned['episode_id']} was cut short", False)


def _ledger(folder: Path) -> Iterator[Finding]:
    path = folder / LEDGER_NAME
    if not path.exists():
        return
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            verify_ledger(path)
        except LedgerError as error:
            yield Finding(LEDGER_NAME, None, "", str(error).removeprefix(f"{path}").lstrip("/: "))
    for warning in caught:
        yield Finding(
            LEDGER_NAME, None, "", str(warning.message).removeprefix(f"{path}").lstrip("/: "), False
        )


def _without_place(error: RecordError) -> str:
    """The error's text after its file and line, which are told anyway."""
    return str(error).partition(": ")[2]
