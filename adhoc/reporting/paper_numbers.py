"""The paper's own tables, cell by cell as they are printed (Tables 1 to 3, and that of the ablation)."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import Any

from adhoc.evaluation.contender import NO_AD_HOC
from adhoc.reporting.printed import PrintedCell, read_cell

FILE_NAME = "paper_numbers.json"
METRICS = ("success", "partial_success", "temporal_steps", "action_steps", "efficiency")
"""The columns of all of the paper's tables, by their names in `evaluation.metrics.Scores`."""
ABLATION_TABLE = 4


@dataclass(frozen=True)
class PaperRow:
    """One row: a policy, and what it is called in the library's configurations."""

    policy: str
    label: str
    cells: tuple[PrintedCell, ...]
    """In the order of `METRICS`."""
    model: str | None = None
    """Part of the model's name, where it is another than that of the other rows."""

    @property
    def is_alone(self) -> bool:
        """Whether it is the team without an ad hoc robot."""
        return self.policy == NO_AD_HOC

    def cell(self, metric: str) -> PrintedCell:
        """The cell of a column."""
        return self.cells[METRICS.index(metric)]


@dataclass(frozen=True)
class PaperBlock:
    """The rows of one team at one joining step, the team alone first."""

    heading: str
    team: str
    join_step: int
    rows: tuple[PaperRow, ...]

    @property
    def alone(self) -> PaperRow:
        """The team alone, which all percentages refer to."""
        return next(row for row in self.rows if row.is_alone)


@dataclass(frozen=True)
class PaperTable:
    """One table of the paper."""

    number: int
    caption: str
    blocks: tuple[PaperBlock, ...]

    @property
    def name(self) -> str:
        """What it is referred to by."""
        return "the ablation table" if self.is_ablation else f"Table {self.number}"

    @property
    def is_ablation(self) -> bool:
        """Whether it takes parts of the method away."""
        return self.number == ABLATION_TABLE


@dataclass(frozen=True)
class PaperNumbers:
    """Everything, and what it was measured with."""

    source: str
    model: str
    tasks: int
    tables: tuple[PaperTable, ...]

    def blocks(self) -> Iterator[tuple[PaperTable, PaperBlock]]:
        """All blocks with their tables."""
        return ((table, block) for table in self.tables for block in table.blocks)


@lru_cache(maxsize=1)
def paper_numbers() -> PaperNumbers:
    """The tables of the paper, from the file `paper_numbers.json` beside this one."""
    data = json.loads(files("adhoc.reporting").joinpath(FILE_NAME).read_text(encoding="utf-8"))
    return PaperNumbers(data["source"], data["model"], data["tasks"], tuple(map(_table, data["tables"])))


def _table(data: Mapping[str, Any]) -> PaperTable:
    blocks = (_block(block, f"{FILE_NAME}, table {data['number']}") for block in data["blocks"])
    return PaperTable(data["number"], data["caption"], tuple(blocks))


def _block(data: Mapping[str, Any], where: str) -> PaperBlock:
    rows = tuple(_row(row, f"{where}, {data['heading']}") for row in data["rows"])
    return PaperBlock(data["heading"], data["team"], data["join_step"], rows)


def _row(data: Mapping[str, Any], where: str) -> PaperRow:
    cells = tuple(read_cell(cell, f"{where}, {data['label']}") for cell in data["cells"])
    return PaperRow(data["policy"], data["label"], cells, data.get("model"))
