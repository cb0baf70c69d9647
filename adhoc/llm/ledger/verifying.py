"""Checking a ledger line by line."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from adhoc.core.errors import LedgerError
from adhoc.llm.ledger.entry import Answer, Call, Header, Text
from adhoc.llm.ledger.key import text_hash
from adhoc.llm.ledger.reader import LedgerFile, Line, existing_files
from adhoc.llm.ledger.spending import Spending


@dataclass
class Verdict:
    """What was found in a ledger without faults."""

    files: int = 0
    spending: Spending = field(default_factory=Spending)
    repeated: int = 0
    """Answers to calls that had one before; a replay gives the first."""


def verify(path: str | Path) -> Verdict:
    """Check every line of a ledger: its checksum and fields, that every text has its hash, that every call's
    texts are there before it, that every answer has a call.

    Raises LedgerError for the first fault, naming file and line. An incomplete last line is no fault but a
    TornLedgerWarning.
    """
    verdict, answers = Verdict(), Counter[bytes]()
    for file in existing_files(path):
        verdict.files += 1
        _verify_file(file, verdict.spending, answers)
    verdict.repeated = sum(answers.values()) - len(answers)
    return verdict


def _verify_file(file: LedgerFile, spending: Spending, answers: Counter[bytes]) -> None:
    texts: set[str] = set()
    open_calls: Counter[str] = Counter()
    for line, entry in file.entries():
        spending.add(entry)
        if isinstance(entry, Text):
            _check_text(entry, line)
            texts.add(entry.sha256)
        elif isinstance(entry, Call):
            _check_call(entry, texts, line)
            open_calls[entry.key] += 1
        elif isinstance(entry, Header):
            raise LedgerError(
                f"{line.where}: a second header; files are put together by `adhoc ledger merge`"
            )
        elif not open_calls[entry.key]:
            raise LedgerError(f"{line.where}: key is {entry.key}; no call of this key is open here")
        else:
            open_calls[entry.key] -= 1
            answers.update([bytes.fromhex(entry.key)] if isinstance(entry, Answer) else [])


def _check_text(text: Text, line: Line) -> None:
    found = text_hash(text.content)
    if not text.redacted and found != text.sha256:
        raise LedgerError(f"{line.where}: sha256 is {text.sha256}; the hash of the content is {found}")


def _check_call(call: Call, texts: set[str], line: Line) -> None:
    needed = [digest for _, digest in call.messages] + ([] if call.schema is None else [call.schema])
    missing = next((digest for digest in needed if digest not in texts), None)
    if missing is not None:
        raise LedgerError(f"{line.where}: refers to the text {missing}, which is not in the file before it")
