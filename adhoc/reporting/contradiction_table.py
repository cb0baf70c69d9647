"""The cells of the paper's tables that contradict each other, as a table."""

from __future__ import annotations

from itertools import groupby

from adhoc.reporting.contradictions import TOLERANCE, contradictions
from adhoc.reporting.paper_layout import HEADINGS
from adhoc.reporting.paper_numbers import METRICS, PaperNumbers
from adhoc.reporting.table import Cell, Column, Row, Table

COLUMNS = (Column("where", True), Column("column", True), Column("printed"), Column("why", True))
TITLE = "Cells of the paper's tables that contradict each other"


def contradiction_table(paper: PaperNumbers) -> Table:
    """One row for each cell that `contradictions` names."""
    rows = []
    for place, found in groupby(contradictions(paper), key=lambda it: it.place):
        heading = HEADINGS[METRICS.index(place.metric)].partition(" ")[0]
        reasons = "; ".join(it.reason for it in found)
        rows.append(Row((Cell(str(place)), Cell(heading), Cell(place.printed), Cell(reasons))))
    cells = sum(len(row.cells) for _, block in paper.blocks() for row in block.rows)
    remark = f"found by a check of all {cells} cells against each other; {TOLERANCE}"
    return Table("contradictions", TITLE, COLUMNS, (tuple(rows),), (remark,))
