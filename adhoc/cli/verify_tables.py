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
from adhoc.core.counting import counted
from adhoc.core.errors import AdhocError, ConfigurationError
from adhoc.experiments.verifying.finding import Finding

NAMES = ("table", "tables", "report")
"""Files of these names are taken for what `adhoc report` wrote."""
FORMATS = {".md": "--markdown", ".tex": "--latex", ".html": "--html"}
"""The options that write them, by their endings."""
COMMAND = re.compile(r'^(?:<!-- |% |<meta name="generator" content=")(adhoc report .*?)(?: -->|">)?$', re.M)
"""The line in which a file says what writes it again."""
FIGURE, END = '<figure role="img"', "</figure>"
"""Between them a page holds a picture. How that is drawn depends on the machine."""
LONGEST_NAME = 200
"""Bytes."""
SHOWN = 100

Report = Callable[[Sequence[str]], int]


def table_findings(folder: Path, report: Report) -> Iterator[Finding]:
    """The tables of a folder that do not follow from its records, which have no faults.

    `report` is the command `adhoc report`. It is asked for each with the options that the file names, and
    must write the very same file; if it does not, the first line is told in which they differ. Pictures in a
    page that are drawn otherwise are no fault, but told.
    """
    for path in (folder / f"{name}{ending}" for name in NAMES for ending in FORMATS):
        if path.is_file():
            found = path.read_text(encoding="utf-8", errors="replace")
            try:
                written = _written(folder, path.suffix, found, report)
            except (AdhocError, OSError, ValueError) as error:
                yield Finding(path.name, None, "", f"cannot be written again: {error}")
                continue
            yield from _compared(path.name, found, written)


def _written(folder: Path, ending: str, found: str, report: Report) -> str:
    """The file again. Raises AdhocError if it cannot be made from this folder alone."""
    line = COMMAND.search(found)
    if line is None:
        raise ConfigurationError("it does not say by which `adhoc report ...` it was made")
    options = asked_again(line[1] if ending == ".tex" else unescape(line[1]))
    if len(options.folders) != 1:
        raise ConfigurationError(f"it was made from {len(options.folders)} folders, not from this one alone")
    (name,), figures = options.folders, options.figures
    for part in (name, *(() if figures is None else figures.parts)):
        if not _is_plain(part):
            raise ConfigurationError(f"{part[:LONGEST_NAME]!r} names nothing in or like this folder")
    with TemporaryDirectory(prefix="adhoc-verify-") as place, redirect_stdout(StringIO()):
        # The file tells the name that the folder had, and where its pictures are, seen from there.
        within = Path(place) / "of"
        within.mkdir()
        (within / name).symlink_to(folder.resolve(), target_is_directory=True)
        drawn = [] if figures is None else ["--figures", str(Path(place) / "to" / figures)]
        path = Path(place) / "to" / f"adhoc-verify{ending}"
        path.parent.mkdir()
        report([str(within / name), *told(options), *drawn, FORMATS[ending], str(path)])
        return path.read_text(encoding="utf-8")


def _is_plain(name: str) -> bool:
    """Whether it names something in a folder, and nowhere else."""
    fits = 0 < len(name.encode(errors="replace")) <= LONGEST_NAME and "\0" not in name
    return fits and Path(name).name == name and name not in (".", "..")


def _compared(name: str, found: str, written: str) -> Iterator[Finding]:
    here, wanted = _parts(found), _parts(written)
    if here[::2] != wanted[::2]:
        yield _difference(name, *("".join(parts[::2]).split("\n") for parts in (here, wanted)))
        return
    differing = sum(one != other for one, other in zip(here[1::2], wanted[1::2]))
    if differing:
        text = f"{counted(differing, 'picture')} drawn otherwise than on this machine, and not checked"
        yield Finding(name, None, "", text, is_fault=False)


def _parts(text: str) -> list[str]:
    """What stands around figures and in them, in turns; a figure that does not end is none."""
    parts, at = [], 0
    while (start := text.find(FIGURE, at)) >= 0 and (end := text.find(END, start)) >= 0:
        parts += [text[at:start], text[start:end]]
        at = end
    return [*parts, text[at:]]


def _difference(name: str, found: Sequence[str], written: Sequence[str]) -> Finding:
    pairs = enumerate(zip_longest(found, written))
    line = next(number for number, (one, other) in pairs if one != other)
    here, wanted = (lines[line] if line < len(lines) else "(nothing)" for lines in (found, written))
    parting = next((at for at, (one, other) in enumerate(zip(here, wanted)) if one != other), 0)
    part = slice(max(0, parting - SHOWN // 2), parting + SHOWN // 2)
    text = f"is {here[part]!r}; from the records of this folder it is {wanted[part]!r}"
    return Finding(name, line + 1, "", text)
