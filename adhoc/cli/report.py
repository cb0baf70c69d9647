"""`adhoc report DIR...`: the paper's table from records."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from adhoc.cli.table_console import table_console
from adhoc.evaluation.common_sense import agreement_markdown, agreement_table
from adhoc.evaluation.cost_table import cost_markdown, cost_table
from adhoc.evaluation.report import make_report, read_folders, to_markdown, to_table


def main(arguments: Sequence[str]) -> int:
    """Print the table, and write it as Markdown if asked. Raises RecordError for unreadable folders."""
    parser = argparse.ArgumentParser(
        prog="adhoc report",
        description="The paper's table (%%Suc, %%PS, #TS, #AS, %%SE) from the records of one or more runs.",
    )
    parser.add_argument("folders", nargs="+", metavar="DIR", help="a run folder, the out=... of `adhoc run`")
    parser.add_argument("--markdown", metavar="FILE", type=Path, help="write the table as Markdown, too")
    options = parser.parse_args(list(arguments))
    records = read_folders(options.folders)
    report = make_report(records)
    console = table_console()
    for block in report.blocks:
        console.print(to_table(report, block))
    agreement = agreement_table(records)
    if agreement is not None:
        console.print(agreement)
    costs = cost_table(records)
    if costs is not None:
        console.print(costs)
    for warning in report.warnings:
        console.print(warning, style="yellow", markup=False, highlight=False)
    for note in report.notes:
        console.print(note, style="dim")
    if options.markdown is not None:
        text = "\n".join(
            filter(None, (to_markdown(report), agreement_markdown(records), cost_markdown(records)))
        )
        options.markdown.write_text(text, encoding="utf-8")
    return 0
