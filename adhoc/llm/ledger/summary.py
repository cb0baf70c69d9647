"""What a ledger holds, by stage and model, and one call of it in full."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from adhoc.core.errors import LedgerError
from adhoc.llm.ledger.entry import Answer, Call, Failure, Text
from adhoc.llm.ledger.reader import LedgerFile, existing_files
from adhoc.llm.ledger.spending import Spending

Asked = tuple[str, str]
"""Stage and model."""


@dataclass(frozen=True)
class Exchange:
    """A call and how it ended; None if it is pending."""

    call: Call
    ending: Answer | Failure | None
    file: Path

    @property
    def fate(self) -> str:
        """In one or two words."""
        if self.ending is None:
            return "pending"
        if isinstance(self.ending, Failure):
            return self.ending.error
        return "answered" if self.ending.outcome is None else self.ending.outcome


@dataclass
class Summary:
    """The calls of a ledger, or those of one stage or one episode."""

    groups: dict[Asked, Spending] = field(default_factory=dict)
    """What was used, by stage and model."""
    pending: list[Exchange] = field(default_factory=list)

    @property
    def total(self) -> Spending:
        """What was used in all."""
        total = Spending()
        for spending in self.groups.values():
            total.merge(spending)
        return total

    def add(self, exchange: Exchange) -> None:
        """Count one call."""
        spending = self.groups.setdefault((exchange.call.stage, exchange.call.model), Spending())
        spending.add(exchange.call)
        if exchange.ending is None:
            self.pending.append(exchange)
        else:
            spending.add(exchange.ending)


def exchanges(path: str | Path, stage: str | None = None, episode: str | None = None) -> Iterator[Exchange]:
    """The calls of a ledger, or of one stage or episode; of each file in the order of their ends, the pending
    ones last. Raises LedgerError if there is no ledger, or it is damaged."""
    for file in existing_files(path):
        for exchange in _exchanges_of(file):
            if stage in (None, exchange.call.stage) and episode in (None, exchange.call.episode):
                yield exchange


def find_call(path: str | Path, key: str) -> Exchange:
    """The call whose key begins so; of several attempts at it the one that was answered, else the last.

    Raises LedgerError if there is none, or if several calls' keys begin so.
    """
    found = [it for it in exchanges(path) if key and it.call.key.startswith(key)]
    keys = sorted({exchange.call.key for exchange in found})
    if not keys:
        raise LedgerError(f"{path}: holds no call with a key that begins with {key!r}")
    if len(keys) > 1:
        some = ", ".join(keys[:3])
        raise LedgerError(f"{path}: {len(keys)} calls have keys that begin with {key!r}: {some}, ...")
    return next((it for it in found if isinstance(it.ending, Answer)), found[-1])


def texts_of_file(path: Path) -> Mapping[str, Text]:
    """The texts that the calls of one file refer to, by hash."""
    (file,) = existing_files(path)
    return {entry.sha256: entry for _, entry in file.entries() if isinstance(entry, Text)}


def _exchanges_of(file: LedgerFile) -> Iterator[Exchange]:
    open_calls: defaultdict[str, list[Call]] = defaultdict(list)
    for line in file.lines():
        entry = None if line.kind == "text" else line.entry()
        if isinstance(entry, Call):
            open_calls[entry.key].append(entry)
        elif isinstance(entry, (Answer, Failure)):
            if entry.key not in open_calls:
                raise LedgerError(f"{line.where}: key is {entry.key}; no call of this key is open here")
            yield Exchange(open_calls[entry.key].pop(), entry, file.path)
            if not open_calls[entry.key]:
                del open_calls[entry.key]
    for calls in open_calls.values():
        for call in calls:
            yield Exchange(call, None, file.path)
