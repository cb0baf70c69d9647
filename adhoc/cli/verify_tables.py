"""Whether the tables in a run folder follow from its records: written again, and compared."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import redirect_stdout
from functools import cache, partial
from io import StringIO
from itertools import zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory

from adhoc.core.errors import AdhocError
from adhoc.experiments.verifying.finding import Finding

NAMES = ("table", "tables", "report")
"""Files of these names are taken for what `adhoc report` wrote."""
FORMATS = {".md": "--markdown", ".tex": "--latex", ".html": "--html"}
"""The options that write them, by their endings."""
OPTIONS: Sequence[Sequence[str]] = (
    (),
    ("--intervals",),
    ("--paper",),
    ("--intervals", "--paper"),
    ("--intervals", "--power"),
    ("--intervals", "--paper", "--power"),
)
"""With which they may have been written, the likeliest first."""
SHOWN = 100

Report = Callable[[Sequence[str]], int]


def table_findings(folder: Path, report: Report) -> Iterator[Finding]:
    """The tables of a folder that do not follow from its records, which have no faults.

    `report` is the command `adhoc report`. It is asked for each with one set of options after the other; one
    that it writes with none of them is told with the first line in which it differs from the nearest.
    """
    write = cache(partial(_written, folder, report))
    for path in (folder / f"{name}{ending}" for name in NAMES for ending in FORMATS):
        if path.is_file():
            yield from _check(path, write)


def _check(path: Path, write: Callable[[Sequence[str], str], Sequence[str]]) -> Iterator[Finding]:
    found = path.read_text(encoding="utf-8", errors="replace").splitlines()
    nearest: Sequence[str] = ()
    for options in OPTIONS:
        try:
            written = write(options, path.suffix)
        except AdhocError as error:
            yield Finding(path.name, None, "", f"cannot be written again: {error}")
            return
        if written == found:
            return
        nearest = max(nearest, written, key=partial(_common, found))
    yield _difference(path.name, found, nearest)


def _written(folder: Path, report: Report, options: Sequence[str], ending: str) -> Sequence[str]:
    with TemporaryDirectory(prefix="adhoc-verify-") as place, redirect_stdout(StringIO()):
        path = Path(place) / f"table{ending}"
        report([str(folder), *options, FORMATS[ending], str(path)])
        return path.read_text(encoding="utf-8").splitlines()


def _common(found: Sequence[str], written: Sequence[str]) -> int:
    """How many lines are the same before the first that is not."""
    pairs = enumerate(zip_longest(found, written))
    return next((number for number, (one, other) in pairs if one != other), len(found))


def _difference(name: str, found: Sequence[str], written: Sequence[str]) -> Finding:
    line = _common(found, written)
    here, wanted = (lines[line] if line < len(lines) else "(nothing)" for lines in (found, written))
    parting = next((at for at, (one, other) in enumerate(zip(here, wanted)) if one != other), 0)
    part = slice(max(0, parting - SHOWN // 2), parting + SHOWN // 2)
    text = f"is {here[part]!r}; from the records of this folder it is {wanted[part]!r}"
    return Finding(name, line + 1, "", text)
