"""Writing all figures of a report into a folder."""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure

from adhoc.core.whole_file import write_whole
from adhoc.evaluation.records import writing
from adhoc.reporting.figures.by_group import success_by_group
from adhoc.reporting.figures.by_step import success_by_step
from adhoc.reporting.figures.drawing import draw_by_group, draw_by_step
from adhoc.reporting.figures.style import DOTS_PER_INCH, paper_style
from adhoc.reporting.report import Report
from adhoc.reporting.results import Results
from adhoc.reporting.table import Picture


def write_figures(report: Report, results: Results, folder: Path) -> list[Picture]:
    """Draw everything that the records can tell, as SVG and PNG; files of the same names are replaced.

    Args:
        report: Made from the results, with intervals.
        results: For what parts scenarios.
        folder: Is made if it is missing.

    Raises:
        RecordError: A file cannot be written; it is then as it was.
    """
    with paper_style():
        return [_written(name, title, figure, folder) for name, title, figure in _figures(report, results)]


def _figures(report: Report, results: Results) -> Iterator[tuple[str, str, Figure]]:
    """Their names, titles and drawings."""
    model = ", ".join(report.models) or "none used"
    for steps in success_by_step(report):
        title = f"Success by joining step, {steps.team_name}; model: {model}"
        yield f"joining-step-{steps.team_name}", title, draw_by_step(steps, model)
    for groups in success_by_group(results):
        title = f"{groups.policy_name} {groups.grouping.title}, {groups.team_name}; model: {model}"
        yield f"{groups.grouping.key}-{groups.team_name}", title, draw_by_group(groups, model)


def _written(name: str, title: str, figure: Figure, folder: Path) -> Picture:
    path = folder / re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
    buffer = BytesIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    # What stands where is found out once; finding it again takes as long as drawing.
    figure.set_layout_engine("none")
    pixels = BytesIO()
    figure.savefig(pixels, format="png", dpi=DOTS_PER_INCH)
    for ending, content in ((".svg", buffer), (".png", pixels)):
        file = path.with_suffix(ending)
        with writing(file):
            write_whole(file, content.getvalue())
    return Picture(title, str(path), buffer.getvalue().decode())
