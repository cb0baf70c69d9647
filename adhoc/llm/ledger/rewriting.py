"""Making one new ledger file from others, which stay as they are."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import BinaryIO

from adhoc.core.errors import LedgerError
from adhoc.llm.ledger.entry import Answer, Call, Entry, Failure, Header
from adhoc.llm.ledger.line import encoded
from adhoc.llm.ledger.reader import SUFFIX, LedgerFile, existing_files

Change = Callable[[Entry, str], Entry]
"""What becomes of an entry; the text says where it is, for errors."""


@dataclass
class Rewritten:
    """How many entries were read, and how many of them were left out because they were there already."""

    entries: int = 0
    repeated: int = 0


def merge(out: str | Path, paths: Sequence[str | Path]) -> Rewritten:
    """Put ledgers of one model together in one file. What several of them hold alike is written once; all
    else is kept, also second answers to one call. See `rewrite` for errors."""
    return rewrite(out, paths, lambda entry, _: entry)


def rewrite(out: str | Path, paths: Sequence[str | Path], change: Change) -> Rewritten:
    """Write all entries of some ledgers into a new file, each as `change` makes it.

    Raises:
        LedgerError: an input is damaged, their models or settings differ, or `out` exists already or does
            not end with `.jsonl`; then there is no new file. Or whatever `change` raises.
    """
    target = Path(out)
    if target.suffix != SUFFIX:
        raise LedgerError(f"{target}: the name of a ledger file ends with {SUFFIX}")
    files = sorted(
        (file for path in paths for file in existing_files(path)), key=lambda file: file.header.time
    )
    header = _common_header(files)
    rewritten = Rewritten()
    with _new_file(target) as output:
        output.write(encoded(change(header, f"{files[-1].path}, line 1")))
        for line in _new_lines(files, change, rewritten):
            output.write(line)
    return rewritten


def _new_lines(files: Sequence[LedgerFile], change: Change, rewritten: Rewritten) -> Iterator[bytes]:
    written: set[bytes] = set()
    open_calls = Counter[str]()
    for file in files:
        repeated_calls = Counter[str]()
        for line, entry in file.entries():
            changed = change(entry, line.where)
            data = encoded(changed)
            digest = sha256(data).digest()[:16]
            rewritten.entries += 1
            if digest in written or _ends_repeated(changed, open_calls, repeated_calls):
                rewritten.repeated += 1
                repeated_calls.update([changed.key] if isinstance(changed, Call) else [])
            else:
                written.add(digest)
                open_calls.update([changed.key] if isinstance(changed, Call) else [])
                yield data


def _ends_repeated(entry: Entry, open_calls: Counter[str], repeated_calls: Counter[str]) -> bool:
    """Whether this is another form of an ending that was written, of a call that was: redacted, for example.
    An ending that only this file knows closes the call that is open."""
    if not isinstance(entry, (Answer, Failure)):
        return False
    if open_calls[entry.key]:
        open_calls[entry.key] -= 1
        return False
    return repeated_calls[entry.key] > 0


def _common_header(files: Sequence[LedgerFile]) -> Header:
    first, last = files[0], files[-1]
    for file in files:
        for name in ("model", "settings"):
            here, there = getattr(file.header, name), getattr(first.header, name)
            if here != there:
                raise LedgerError(
                    f"{file.path}, line 1: {name} is {here!r}, but {there!r} in {first.path}: only calls of "
                    "one model with the same settings go into one file"
                )
    return replace(last.header, time=first.header.time)


@contextmanager
def _new_file(target: Path) -> Iterator[BinaryIO]:
    """A file that is there whole at the end, or not at all."""
    part = target.with_name(f"{target.name}.{os.getpid()}.part")
    _check_new(target)
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        with open(part, "xb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        _check_new(target)
        part.rename(target)
    finally:
        part.unlink(missing_ok=True)


def _check_new(target: Path) -> None:
    if target.exists():
        raise LedgerError(f"{target}: exists already; nothing is overwritten")
