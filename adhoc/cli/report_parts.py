"""What a report is made of: the tables and figures that the options of `adhoc report` ask for."""

from __future__ import annotations

import argparse
import gc
import warnings
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path

from adhoc.cli.report_options import name_of
from adhoc.core.counting import counted
from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.records import UNFINISHED_NAME, Record, RecordFile
from adhoc.experiments.failures import FAILURES_NAME, FailureFile
from adhoc.experiments.provenance.file import unfinished_runs
from adhoc.reporting.agreement_table import agreement_table
from adhoc.reporting.comparison_table import comparison_tables
from adhoc.reporting.comparisons import Scope, families
from adhoc.reporting.contradiction_table import contradiction_table
from adhoc.reporting.cost_table import cost_table
from adhoc.reporting.effort_table import effort_table
from adhoc.reporting.folders import folder_settings, read_folders
from adhoc.reporting.ordering import ordering_tables
from adhoc.reporting.paper_layout import paper_only, paper_tables
from adhoc.reporting.paper_numbers import PaperNumbers, paper_numbers
from adhoc.reporting.power_table import power_tables
from adhoc.reporting.prediction_table import prediction_table
from adhoc.reporting.report import make_report
from adhoc.reporting.results import Results
from adhoc.reporting.table import Document, Picture, Table


class Reported:
    """Everything that the records of some folders tell, as far as it is asked for.

    Raises RecordError for records that cannot be read or do not belong together, ConfigurationError for a
    team or policy that is not there.
    """

    def __init__(self, options: argparse.Namespace) -> None:
        self._options = options
        self._paper = paper_numbers() if options.paper else None
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            everything = read_folders(options.folders)
        self._damage = [str(it.message) for it in found]
        for it in found:
            warnings.warn(it.message, it.category, stacklevel=2)
        self._warnings = list(_unrecorded(options.folders, {record["episode_id"] for record in everything}))
        # Nothing of the many records goes before the end: looking for waste among them is in vain.
        gc.freeze()
        records = _chosen(everything, options.team, options.policy)
        self._results = Results.of(records, folder_settings(options.folders))
        needs_intervals = options.intervals or options.figures is not None
        self._report = make_report(self._results, needs_intervals)
        compares = options.intervals or options.power
        self._families = families(self._results, Scope(options.family)) if compares else []
        self._common = [
            agreement_table(records),
            prediction_table(self._results),
            effort_table(self._results),
            cost_table(records),
        ]

    def document(self, for_file: bool) -> Document:
        """The whole report. In the terminal comparisons that tell little are left out, and so is what was
        warned of while reading."""
        marked = {
            (family.board.join_step, family.board.team, it.policy)
            for family in self._families
            for it in family.against_alone
            if it.beyond_chance
        }
        tables = [
            *paper_tables(self._report, self._options.intervals, self._paper, marked),
            *(it.about(self._report.model) for it in self._common if it is not None),
            *(it.about(self._report.model) for it in self._statistics(every_pair=for_file)),
            *([] if self._paper is None else [contradiction_table(self._paper).about(_model(self._paper))]),
        ]
        return Document(
            self._report.title,
            tuple(tables),
            (*(self._damage if for_file else ()), *self._warnings, *self._report.warnings),
            (*self._report.notes, *self._figure_notes(for_file)),
            self._pictures,
        )

    @cached_property
    def _pictures(self) -> tuple[Picture, ...]:
        """Drawn when they are first asked for."""
        if self._options.figures is None:
            return ()
        from adhoc.reporting.figures.writing import write_figures

        return tuple(write_figures(self._report, self._results, self._options.figures))

    def _figure_notes(self, for_file: bool) -> Iterator[str]:
        if self._options.figures is None:
            return
        if not for_file:
            yield f"{counted(len(self._pictures), 'figure')}, as SVG and PNG, in {self._options.figures}"
        records = self._results.records
        untold = sum(it["join_step"] is not None and it.get("newcomer") is None for it in records)
        if untold:
            yield (
                f"{counted(untold, 'episode')} recorded by a version that did not tell the ad hoc robot's "
                "ability, not in the figures by it"
            )

    def _statistics(self, every_pair: bool) -> Iterator[Table]:
        found, options = self._families, self._options
        if options.intervals:
            yield from ordering_tables(found)
            yield from comparison_tables(found, every_pair)
        if options.power:
            yield from power_tables(found, options.difference, every_pair)


def paper_document() -> Document:
    """The paper's own tables, and where they contradict each other."""
    paper = paper_numbers()
    tables = (*paper_only(paper), contradiction_table(paper))
    return Document(
        f"The paper's numbers; {_model(paper)}; {paper.tasks} tasks",
        tuple(it.about(_model(paper)) for it in tables),
        notes=(f"{paper.source}; every cell as it is printed there",),
    )


def _model(paper: PaperNumbers) -> str:
    return f"language model: {paper.model}"


def _unrecorded(folders: Sequence[str | Path], recorded: set[str]) -> Iterator[str]:
    """Episodes that were begun and are in no row."""
    for folder in folders:
        name = name_of(folder)
        unfinished = unfinished_runs(folder)
        if unfinished:
            yield (
                f"{name}: {counted(len(unfinished), 'run')} did not finish, so rows may lack episodes; the "
                "same command goes on, and adhoc verify says what is missing"
            )
        failed = sum(it.episode_id not in recorded for it in FailureFile(folder).failures)
        if failed:
            yield (
                f"{name}/{FAILURES_NAME}: {counted(failed, 'episode')} failed with an error, in no row; a "
                "row without its hardest episodes is no fair one"
            )
        cut = sum(it["episode_id"] not in recorded for it in RecordFile(folder, UNFINISHED_NAME).read())
        if cut:
            yield f"{name}/{UNFINISHED_NAME}: {counted(cut, 'episode')} cut short by a budget, in no row"


def _chosen(
    records: Sequence[Record], teams: Sequence[str] | None, policies: Sequence[str] | None
) -> list[Record]:
    """The records of these teams and policies, with the teams alone; all where nothing is named."""
    if teams is None and policies is None:
        return list(records)
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
