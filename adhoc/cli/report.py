"""`adhoc report DIR...`: the paper's tables and figures from records, and the paper's own numbers."""

from __future__ import annotations

import argparse
import gc
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from adhoc.cli.report_options import command_for, parse
from adhoc.cli.report_parts import Reported, paper_document
from adhoc.cli.table_console import table_console
from adhoc.core.whole_file import write_whole
from adhoc.evaluation.records import writing
from adhoc.reporting.rendering.html import html_document
from adhoc.reporting.rendering.latex import latex_document
from adhoc.reporting.rendering.markdown import markdown_document
from adhoc.reporting.rendering.terminal import terminal_table
from adhoc.reporting.table import Document


def main(arguments: Sequence[str]) -> int:
    """Print the tables, and write the files that are asked for.

    Raises RecordError for records that cannot be read or do not belong together, ConfigurationError for
    options that do not fit.
    """
    options = parse(arguments)
    try:
        _report(options)
    finally:
        gc.unfreeze()
    return 0


def _report(options: argparse.Namespace) -> None:
    """The files first: whoever reads the terminal may leave before its end."""
    if options.folders:
        reported = Reported(options)
        _write(reported.document(for_file=True), options)
        _print(reported.document(for_file=False))
    else:
        _write(paper_document(), options)
        _print(paper_document())


def _write(document: Document, options: argparse.Namespace) -> None:
    writers: Mapping[str, Callable[[Document], str]] = {
        "markdown": markdown_document,
        "latex": lambda it: latex_document(it, options.label_prefix),
        "html": html_document,
    }
    for name, write in writers.items():
        path: Path | None = getattr(options, name)
        if path is not None:
            made = document.made_by(command_for(options, name, path), path.parent)
            with writing(path):
                write_whole(path, write(made).encode())


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
