"""Whether the tables in a run folder follow from its records: written again, and compared."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import redirect_stdout
from html import unescape
from io import StringIO
from itertools import zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory

from adhoc.cli.report_options import asked_again, told
from adhoc.core.errors import AdhocError, ConfigurationError
from adhoc.experiments.verifying.finding import Finding

NAMES = ("table", "tables", "report")
"""Files of these names are taken for what `adhoc report` wrote."""
FORMATS = {".md": "--markdown", ".tex": "--latex", ".html": "--html"}
"""The options that write them, by their endings."""
COMMAND = re.compile(
    r'^(?:<!-- |% |<meta name="generator" content=")(adhoc report [^\n]*?)(?: -->|">)?$', re.M
)
"""The line in which a file says what writes it again."""
UNCOMPARED = re.compile(rf"{COMMAND.pattern}|<svg .*?</svg>", re.M | re.S)
"""The name of the folder may have changed, and how a curve is drawn depends on the machine."""
SHOWN = 100

Report = Callable[[Sequence[str]], int]


def table_findings(folder: Path, report: Report) -> Iterator[Finding]:
    """The tables of a folder that do not follow from its records, which have no faults.

    `report` is the command `adhoc report`. It is asked for each with the options that the file names; one
    that it writes otherwise is told with the first line in which they differ.
    """
    for path in (folder / f"{name}{ending}" for name in NAMES for ending in FORMATS):
        if path.is_file():
            found = path.read_text(encoding="utf-8", errors="replace")
            try:
                written = _written(folder, path.suffix, found, report)
            except AdhocError as error:
                yield Finding(path.name, None, "", f"cannot be written again: {error}")
                continue
            here, wanted = (UNCOMPARED.sub("", text).splitlines() for text in (found, written))
            if here != wanted:
                yield _difference(path.name, here, wanted)


def _written(folder: Path, ending: str, found: str, report: Report) -> str:
    """The file again. Raises AdhocError if it cannot be made from this folder alone."""
    line = COMMAND.search(found)
    if line is None:
        raise ConfigurationError("it does not say by which `adhoc report ...` it was made")
    options = asked_again(line[1] if ending == ".tex" else unescape(line[1]))
    if len(options.folders) != 1:
        raise ConfigurationError(f"it was made from {len(options.folders)} folders, not from this one alone")
    figures = options.figures
    if figures is not None and (figures.is_absolute() or ".." in figures.parts):
        raise ConfigurationError(f"its figures are in {figures}, not in the folder")
    if ending != ".tex":
        options.label_prefix = ""
    with TemporaryDirectory(prefix="adhoc-verify-") as name, redirect_stdout(StringIO()):
        place = Path(name)
        drawn = [] if figures is None else ["--figures", str(place / figures)]
        path = place / f"table{ending}"
        report([str(folder), *told(options), *drawn, FORMATS[ending], str(path)])
        return path.read_text(encoding="utf-8")


def _difference(name: str, found: Sequence[str], written: Sequence[str]) -> Finding:
    pairs = enumerate(zip_longest(found, written))
    line = next(number for number, (one, other) in pairs if one != other)
    here, wanted = (lines[line] if line < len(lines) else "(nothing)" for lines in (found, written))
    parting = next((at for at, (one, other) in enumerate(zip(here, wanted)) if one != other), 0)
    part = slice(max(0, parting - SHOWN // 2), parting + SHOWN // 2)
    text = f"is {here[part]!r}; from the records of this folder it is {wanted[part]!r}"
    return Finding(name, line + 1, "", text)
