"""`adhoc report DIR...`: the paper's table from records."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from adhoc.cli.table_console import table_console
from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.common_sense import agreement_markdown, agreement_table
from adhoc.evaluation.records import Record
from adhoc.reporting.cost_table import cost_markdown, cost_table
from adhoc.reporting.ordering import ordering_markdown, ordering_tables
from adhoc.reporting.prediction_table import prediction_markdown, prediction_table
from adhoc.reporting.report import make_report, read_folders, to_markdown, to_table


def main(arguments: Sequence[str]) -> int:
    """Print the table, and write it as Markdown if asked. Raises RecordError for unreadable folders."""
    parser = argparse.ArgumentParser(
        prog="adhoc report",
        description="The paper's table (%Suc, %PS, #TS, #AS, %SE) from the records of one or more runs.",
    )
    parser.add_argument("folders", nargs="+", metavar="DIR", help="a run folder, the out=... of `adhoc run`")
    parser.add_argument("--markdown", metavar="FILE", type=Path, help="write the table as Markdown, too")
    parser.add_argument(
        "--intervals", action="store_true", help="the order of policies by success, with intervals, too"
    )
    for option, what in (("--team", "team"), ("--policy", "ad hoc robot")):
        parser.add_argument(
            option,
            action="append",
            metavar="NAME",
            help=f"only this {what}, by its name in the configuration or its label; may be repeated",
        )
    options = parser.parse_args(list(arguments))
    records = _chosen(read_folders(options.folders), options.team, options.policy)
    report = make_report(records)
    console = table_console()
    for block in report.blocks:
        console.print(to_table(report, block))
    for table in ordering_tables(records) if options.intervals else ():
        console.print(table)
    agreement = agreement_table(records)
    if agreement is not None:
        console.print(agreement)
    predictions = prediction_table(records)
    if predictions is not None:
        console.print(predictions)
    costs = cost_table(records)
    if costs is not None:
        console.print(costs)
    for warning in report.warnings:
        console.print(warning, style="yellow", markup=False, highlight=False)
    for note in report.notes:
        console.print(note, style="dim")
    if options.markdown is not None:
        sections = (
            to_markdown(report),
            ordering_markdown(records) if options.intervals else "",
            agreement_markdown(records),
            prediction_markdown(records),
            cost_markdown(records),
        )
        text = "\n".join(filter(None, sections))
        options.markdown.write_text(text, encoding="utf-8")
    return 0


def _chosen(
    records: Sequence[Record], teams: Sequence[str] | None, policies: Sequence[str] | None
) -> list[Record]:
    """The records of these teams and policies, with the teams alone; all where nothing is named."""
    for field, names in (("team", teams), ("policy", policies)):
        known = sorted({str(record[field]) for record in records})
        labels = {str(record[f"{field}_label"]) for record in records}
        unknown = [name for name in names or () if name not in known and name not in labels]
        if unknown:
            raise ConfigurationError(
                f"--{field} {unknown[0]!r}: not in these folders; there are {', '.join(map(repr, known))}"
            )
    return [
        record
        for record in records
        if _is_one_of(record, "team", teams)
        and (record["join_step"] is None or _is_one_of(record, "policy", policies))
    ]


def _is_one_of(record: Record, field: str, names: Sequence[str] | None) -> bool:
    return names is None or record[field] in names or record[f"{field}_label"] in names
