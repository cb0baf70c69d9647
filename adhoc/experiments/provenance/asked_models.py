"""Which language models answered, by what name their provider calls them, and when."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from adhoc.llm.ledger.entry import Answer
from adhoc.llm.ledger.reader import ledger_files


def asked_models(ledger: str | Path, since: str = "") -> dict[str, dict[str, Any]]:
    """The models that a ledger's calls were put to, by the names under which they were asked.

    Args:
        ledger: A folder or file; nothing was asked if it is not there.
        since: A time; only files that were begun then or later are read. A run begins files of its own.

    Returns:
        For each model the number of `answers`, `reported` (how many came under which name: a provider may
        answer for `gpt-4` with a dated model), and the times of the `first` and the `last`. JSON values.

    Raises:
        LedgerError: The ledger is damaged.
    """
    found: dict[str, Asked] = {}
    for file in ledger_files(ledger):
        if file.header.time >= since:
            facts = file.path.stat()
            asked = _asked_in(str(file.path), facts.st_size, facts.st_mtime_ns)
            before = found.get(file.header.model)
            found[file.header.model] = asked if before is None else before.and_then(asked)
    return {name: asdict(asked) for name, asked in sorted(found.items()) if asked.answers}


@dataclass(frozen=True)
class Asked:
    """What one model answered."""

    answers: int = 0
    reported: Mapping[str, int] = field(default_factory=dict)
    first: str | None = None
    last: str | None = None

    def and_then(self, other: Asked) -> Asked:
        """Both together."""
        times = [time for time in (self.first, other.first, self.last, other.last) if time is not None]
        reported = {
            name: self.reported.get(name, 0) + other.reported.get(name, 0)
            for name in [*self.reported, *(name for name in other.reported if name not in self.reported)]
        }
        return Asked(
            self.answers + other.answers, reported, min(times, default=None), max(times, default=None)
        )


@lru_cache(maxsize=1024)
def _asked_in(path: str, size: int, modified: int) -> Asked:
    """What one file tells. Several runs that end together read it once, unless it has changed."""
    (file,) = ledger_files(path)
    answers, reported, times = 0, Counter[str](), []
    for line in file.lines():
        entry = line.entry() if line.kind == "answer" else None
        if isinstance(entry, Answer):
            answers += 1
            reported.update([entry.model] if entry.model else [])
            times.append(entry.time)
    return Asked(answers, dict(reported), min(times, default=None), max(times, default=None))
