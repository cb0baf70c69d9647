"""`adhoc report DIR...`: the paper's table from records."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from adhoc.evaluation.report import make_report, read_folders, to_markdown, to_table

PLAIN_WIDTH = 110
"""Characters of a line where there is no terminal to ask."""


def main(arguments: Sequence[str]) -> int:
    """Print the table, and write it as Markdown if asked. Raises RecordError for unreadable folders."""
    parser = argparse.ArgumentParser(
        prog="adhoc report",
        description="The paper's table (%%Suc, %%PS, #TS, #AS, %%SE) from the records of one or more runs.",
    )
    parser.add_argument("folders", nargs="+", metavar="DIR", help="a run folder, the out=... of `adhoc run`")
    parser.add_argument("--markdown", metavar="FILE", type=Path, help="write the table as Markdown, too")
    options = parser.parse_args(list(arguments))
    report = make_report(read_folders(options.folders))
    console = Console()
    if not console.is_terminal:
        console.width = PLAIN_WIDTH
    for block in report.blocks:
        console.print(to_table(report, block))
    for warning in report.warnings:
        console.print(warning, style="yellow", markup=False, highlight=False)
    for note in report.notes:
        console.print(note, style="dim")
    if options.markdown is not None:
        options.markdown.write_text(to_markdown(report), encoding="utf-8")
    return 0
