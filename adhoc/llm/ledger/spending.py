"""What the calls of a ledger used."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

from adhoc.llm.ledger.entry import Answer, Call, Entry, Failure
from adhoc.llm.ledger.reader import ledger_files


@dataclass
class Spending:
    """Calls that reached a model, and what they used. Money in US dollars."""

    calls: int = 0
    """All that were made: answered ones, and pending ones, whose tokens and cost nobody knows."""
    prompt_tokens: int = 0
    completion_tokens: int = 0
    cost_usd: float = 0.0
    refused: int = 0
    """Of the calls, those whose answer was of no use."""
    failed: int = 0
    """Calls that were not answered; they are none of `calls`."""
    pending: int = 0
    """Of the calls, those that were in flight when a process ended."""

    def add_call(self) -> None:
        """Count a call that is about to be made."""
        self.calls += 1
        self.pending += 1

    def add(self, entry: Entry) -> None:
        """Count the next entry of a file. A call is pending until an entry says how it ended."""
        if isinstance(entry, Call):
            self.add_call()
        elif isinstance(entry, Answer):
            self.pending -= 1
            self.refused += entry.outcome is not None
            self.prompt_tokens += entry.prompt_tokens
            self.completion_tokens += entry.completion_tokens
            self.cost_usd += entry.cost_usd
        elif isinstance(entry, Failure):
            self.pending -= 1
            self.calls -= 1
            self.failed += 1

    def merge(self, other: Spending) -> None:
        """Add another's counts to these."""
        for name, value in asdict(other).items():
            setattr(self, name, getattr(self, name) + value)


def spent(path: str | Path) -> Spending:
    """What the calls of a ledger, a folder or a file, used in all; nothing if it is not there yet.

    Raises LedgerError for a damaged, foreign or other version's ledger.
    """
    spending = Spending()
    for file in ledger_files(path):
        for line in file.lines():
            if line.kind == "call":
                spending.add_call()
            elif line.kind != "text":
                spending.add(line.entry())
    return spending
