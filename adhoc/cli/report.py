"""`adhoc report DIR...`: the paper's tables and figures from records, and the paper's own numbers."""

from __future__ import annotations

import argparse
import gc
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from adhoc.cli.report_parts import Results, paper_document
from adhoc.cli.table_console import table_console
from adhoc.core.errors import ConfigurationError
from adhoc.reporting.comparisons import Scope
from adhoc.reporting.rendering.html import html_document
from adhoc.reporting.rendering.latex import check_label_prefix, latex_document
from adhoc.reporting.rendering.markdown import markdown_document
from adhoc.reporting.rendering.terminal import terminal_table
from adhoc.reporting.table import Document

EPILOG = """\
  adhoc report out/all
  adhoc report out/all --intervals --latex tables.tex --figures figures
  adhoc report out/all --paper --html report.html
  adhoc report --paper

docs/report.md explains every table and figure.
"""
FORMATS: dict[str, tuple[str, Callable[[Document], str]]] = {
    "markdown": ("Markdown", markdown_document),
    "latex": ("LaTeX (booktabs)", latex_document),
    "html": ("one HTML page", html_document),
}


def main(arguments: Sequence[str]) -> int:
    """Print the tables, and write the files that are asked for.

    Raises RecordError for records that cannot be read or do not belong together, ConfigurationError for
    options that do not fit.
    """
    options = _parse(arguments)
    try:
        _report(options)
    finally:
        gc.unfreeze()
    return 0


def _report(options: argparse.Namespace) -> None:
    if options.folders:
        results = Results(options)
        _print(results.document(for_file=False))
        document = results.document(for_file=True)
    else:
        document = paper_document()
        _print(document)
    writers = {name: write for name, (_, write) in FORMATS.items()}
    writers["latex"] = partial(latex_document, label_prefix=options.label_prefix)
    for name, write in writers.items():
        path: Path | None = getattr(options, name)
        if path is not None:
            path.write_text(write(document), encoding="utf-8")


def _print(document: Document) -> None:
    console = table_console()
    console.print(document.title, style="bold")
    console.print()
    for table in document.tables:
        console.print(terminal_table(table), crop=False)
        console.print()
    for warning in document.warnings:
        console.print(warning, style="yellow", markup=False, highlight=False)
    for note in document.notes:
        console.print(note, style="dim")


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="adhoc report",
        description="The paper's tables (%Suc, %PS, #TS, #AS, %SE) and figures from the records of runs.",
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folders", nargs="*", metavar="DIR", help="a run folder, the out=... of `adhoc run`")
    for name, (what, _) in FORMATS.items():
        parser.add_argument(f"--{name}", metavar="FILE", type=Path, help=f"write everything as {what}, too")
    parser.add_argument(
        "--label-prefix",
        metavar="NAME",
        default="",
        help="with --latex: the labels are tab:NAME-..., so that a paper can read in several reports",
    )
    parser.add_argument("--figures", metavar="DIR", type=Path, help="draw the figures there, as SVG and PNG")
    parser.add_argument(
        "--paper",
        action="store_true",
        help="the paper's own numbers below ours; without DIR the paper's alone, and what contradicts what",
    )
    parser.add_argument(
        "--intervals",
        action="store_true",
        help="an interval for each number, the order of policies by success, and who is told apart, too",
    )
    parser.add_argument(
        "--power", action="store_true", help="how many tasks it takes to tell policies apart, too"
    )
    parser.add_argument(
        "--difference",
        metavar="POINTS",
        type=float,
        help="with --power: to tell a difference of so many points of %%Suc, not the observed one",
    )
    parser.add_argument(
        "--family",
        choices=[scope.value for scope in Scope],
        default=Scope.TABLE.value,
        help="comparisons that are corrected for together: of one team at one joining step (default), or all",
    )
    for option, what in (("--team", "team"), ("--policy", "ad hoc robot")):
        parser.add_argument(
            option,
            action="append",
            metavar="NAME",
            help=f"only this {what}, by its name in the configuration or its label; may be repeated",
        )
    options = parser.parse_args(list(arguments))
    _check(options)
    return options


def _check(options: argparse.Namespace) -> None:
    """What can be known to fail before any record is read."""
    if options.difference is not None and not options.power:
        raise ConfigurationError(f"--difference {options.difference:g}: goes with --power")
    if options.label_prefix and options.latex is None:
        raise ConfigurationError(f"--label-prefix {options.label_prefix}: goes with --latex")
    check_label_prefix(options.label_prefix)
    if not options.folders and not options.paper:
        raise ConfigurationError("DIR: name a run folder, or ask for the paper's numbers with --paper")
    needs_records = ("figures", "intervals", "power", "team", "policy")
    for name in () if options.folders else needs_records:
        if getattr(options, name):
            raise ConfigurationError(f"--{name}: needs a run folder; the paper gives its averages alone")
    for name in FORMATS:
        path = getattr(options, name)
        if path is not None and not path.parent.is_dir():
            raise ConfigurationError(f"--{name} {path}: there is no such folder")
