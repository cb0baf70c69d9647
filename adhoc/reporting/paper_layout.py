"""Results in the layout of the paper's tables: one for each joining step, and the ablation."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace

from adhoc.core.counting import counted
from adhoc.reporting.few_houses import few_houses
from adhoc.reporting.paper_numbers import PaperBlock, PaperNumbers, PaperRow
from adhoc.reporting.paper_order import ABLATIONS, FULL_METHOD, ablation_order
from adhoc.reporting.report import Block, Report
from adhoc.reporting.rows import FEWER_IS_BETTER, METRICS, ResultRow
from adhoc.reporting.table import Cell, Column, Row, Table
from adhoc.statistics.intervals import LEAST_HOUSES, LEVEL

HEADINGS = ("%Suc ↑", "%PS ↑", "#TS ↓", "#AS ↓", "%SE ↑")
"""Of `METRICS`."""
RESULTS = tuple(map(Column, (*HEADINGS, "N")))
TEAM_COLUMNS = (Column("Team", True), Column("ad hoc", True), *RESULTS)
STEP_COLUMNS = (Column("t0", True), Column("Ad hoc policy", True), *RESULTS)
IN_THE_PAPER = "in the paper"
Marked = Collection[tuple[int | None, str, str]]
"""Joining step, team and policy, by their names in the table, of rows whose success differs from the team
alone's beyond chance (see `reporting.comparisons`)."""

_INTERVALS = (
    f"below each number its {LEVEL:.0%} interval by bootstrap over houses, each for itself; [?]: all houses "
    f"are alike, or fewer than {LEAST_HOUSES}"
)
_DAGGER = (
    f"†: the {LEVEL:.0%} interval of the paired difference from the team alone (not shown) excludes zero; "
    "each number by itself, not corrected for many comparisons, so it may stand beside a test that finds "
    "nothing"
)
_BEYOND_CHANCE = (
    "*: success differs from the team alone's beyond chance with all comparisons of the team and step "
    "together"
)


def paper_tables(
    report: Report, intervals: bool = False, paper: PaperNumbers | None = None, marked: Marked = ()
) -> Iterator[Table]:
    """The tables of Quantitative Performance, and that of the ablation for each team that has one.

    The best of the ad hoc policies is bold, as in the paper; several, if they are equal as printed.

    Args:
        report: What was found.
        intervals: Show those that the report was made with.
        paper: The paper's numbers, to be put below ours.
        marked: What is beyond chance; shown with the intervals.
    """
    if not intervals:
        report, marked = _without_intervals(report), ()
    for block in report.blocks:
        main = [row for row in block.rows if not _is_ablation(row)]
        teams = dict.fromkeys(row.team for row in main)
        groups = [[row for row in main if row.team == team] for team in teams]
        groups = [rows for rows in groups if len(rows) > 1 or block.join_step is None]
        if groups:
            yield Table(
                "team-alone" if block.join_step is None else f"joining-{block.join_step}",
                f"{_when(block)}; {report.model}",
                TEAM_COLUMNS,
                tuple(
                    _group(
                        rows,
                        [row.team_name for row in rows],
                        _paper_rows(paper, block, rows, False),
                        marked,
                        block,
                    )
                    for rows in groups
                ),
                tuple(_remarks([row for rows in groups for row in rows], paper)),
            )
    yield from _ablations(report, paper, marked)


def paper_only(paper: PaperNumbers) -> Iterator[Table]:
    """The paper's own tables, as it prints them."""
    for table in paper.tables:
        by_step = len({block.join_step for block in table.blocks}) > 1
        columns = (STEP_COLUMNS if by_step else TEAM_COLUMNS)[:-1]
        yield Table(
            f"paper-{table.number}",
            f"{table.name[0].upper()}{table.name[1:]} of the paper: {table.caption}",
            columns,
            tuple(
                tuple(
                    Row(
                        (
                            Cell(block.heading),
                            Cell(_as_printed(row.label)),
                            *(Cell(it.text, "", it.bold) for it in row.cells),
                        )
                    )
                    for row in block.rows
                )
                for block in table.blocks
            ),
        )


def result_cells(
    row: ResultRow, best: Collection[str] = (), is_beyond_chance: bool = False
) -> Iterator[Cell]:
    """The five numbers of a row, improvements in brackets, `-` where there is none and `n/a` where the team
    alone has zero to improve on; and the number of its episodes."""
    for metric in METRICS:
        mark = "*" if is_beyond_chance and metric == "success" else ""
        mark += "†" if row.uncertainty is not None and row.uncertainty.is_marked(metric) else ""
        interval = None if row.uncertainty is None else row.uncertainty.values.get(metric)
        below = "" if interval is None else "[?]"
        if interval is not None and interval.tells_spread:
            digits = 0 if metric in FEWER_IS_BETTER else 1
            below = f"[{interval.low:.{digits}f}, {interval.high:.{digits}f}]"
        yield Cell(f"{_printed(row, metric)}{_bracket(row, metric)}{mark}", below, metric in best)
    yield Cell(str(row.scores.episodes))


def best_of(rows: Sequence[ResultRow]) -> dict[int, set[str]]:
    """By place in `rows`, the metrics in which an ad hoc policy is the best as printed; none where there is
    one policy only or all are equal."""
    joined = [(number, row) for number, row in enumerate(rows) if row.who is not None]
    found: dict[int, set[str]] = {}
    for metric in METRICS:
        values = {
            number: float(_printed(row, metric)) for number, row in joined if _printed(row, metric) != "-"
        }
        if len(set(values.values())) > 1:
            best = (min if metric in FEWER_IS_BETTER else max)(values.values())
            for number in (number for number, value in values.items() if value == best):
                found.setdefault(number, set()).add(metric)
    return found


def _ablations(report: Report, paper: PaperNumbers | None, marked: Marked) -> Iterator[Table]:
    teams = dict.fromkeys(row.team for block in report.blocks for row in block.rows if _is_ablation(row))
    for number, team in enumerate(teams):
        groups, shown, name = [], list[ResultRow](), ""
        for block in report.blocks:
            mine = [row for row in block.rows if row.team == team]
            compared = [row for row in mine if row.who and row.who.policy in (*ABLATIONS, FULL_METHOD)]
            if any(map(_is_ablation, compared)):
                alone = [row for row in mine if row.who is None]
                rows = [*alone, *sorted(compared, key=lambda row: ablation_order(row.who))]  # type: ignore[arg-type]
                name = rows[0].team_name
                shown += rows
                steps = [str(block.join_step)] * len(rows)
                groups.append(_group(rows, steps, _paper_rows(paper, block, rows, True), marked, block))
        key = "ablation" if number == 0 else f"ablation-{number + 1}"
        yield Table(
            key,
            f"Ablation of the sub-task planner; team: {name}; {report.model}",
            STEP_COLUMNS,
            tuple(groups),
            tuple(_remarks(shown, paper)),
        )


def _group(
    rows: Sequence[ResultRow],
    headings: Sequence[str],
    beside: Sequence[PaperRow | None],
    marked: Marked,
    block: Block,
) -> tuple[Row, ...]:
    best, shown = best_of(rows), []
    for number, (row, heading, printed) in enumerate(zip(rows, headings, beside)):
        is_beyond = (block.join_step, row.team_name, row.ad_hoc) in marked
        cells = result_cells(row, best.get(number, ()), is_beyond)
        shown.append(Row((Cell(heading), Cell(row.ad_hoc), *cells)))
        if printed is not None:
            numbers = (Cell(it.text) for it in printed.cells)
            shown.append(Row((Cell(heading), Cell(IN_THE_PAPER), *numbers, Cell("")), faint=True))
    return tuple(shown)


def _paper_rows(
    paper: PaperNumbers | None, block: Block, rows: Iterable[ResultRow], ablation: bool
) -> list[PaperRow | None]:
    """The paper's row for each of ours; of several of one policy the model decides, or the last gets it."""
    blocks = [] if paper is None else [
        it for table, it in paper.blocks() if it.join_step == block.join_step and table.is_ablation ==
        ablation
    ]  # fmt: skip
    found = [_paper_row(blocks, row) for row in rows]
    return [None if it is not None and it in found[number + 1 :] else it for number, it in enumerate(found)]


def _paper_row(blocks: Iterable[PaperBlock], row: ResultRow) -> PaperRow | None:
    policy, model = ("none", None) if row.who is None else (row.who.policy, row.who.model)
    candidates = [
        it for block in blocks if block.team == row.team.name for it in block.rows if it.policy == policy
    ]
    named = [it for it in candidates if it.model is not None and it.model in (model or "")]
    return next(iter(named or [it for it in candidates if it.model is None]), None)


def _remarks(rows: Sequence[ResultRow], paper: PaperNumbers | None) -> Iterator[str]:
    known = [row.uncertainty for row in rows if row.uncertainty is not None]
    if known:
        yield _INTERVALS
        if any(it.is_marked(metric) for it in known for metric in METRICS):
            yield _DAGGER
        yield _BEYOND_CHANCE
        yield from few_houses(it.houses for it in known)
    if paper is not None:
        yield (
            f"in italics the paper's own numbers, of {paper.model} on its {paper.tasks} tasks, which "
            "differ from ours"
        )
    yield from _unaided(rows)


def _unaided(rows: Sequence[ResultRow]) -> Iterator[str]:
    """Success that came with a newcomer that brought nothing to its place itself."""
    told = dict.fromkeys(
        f"{row.ad_hoc} beside {row.team_name} ({counted(row.unaided, 'task')})" for row in rows if row.unaided
    )
    if told:
        yield (
            "more success without any object that the newcomer placed in the tasks won (its presence, "
            f"messages or body changed what the team did): {', '.join(told)}"
        )


def _without_intervals(report: Report) -> Report:
    blocks = (
        replace(it, rows=tuple(replace(row, uncertainty=None) for row in it.rows)) for it in report.blocks
    )
    return replace(report, blocks=tuple(blocks))


def _as_printed(label: str) -> str:
    """A name as the paper prints it, a stray bracket marked as not ours."""
    return label if label.count("(") == label.count(")") else f"{label} [sic]"


def _is_ablation(row: ResultRow) -> bool:
    return row.who is not None and row.who.policy in ABLATIONS


def _when(block: Block) -> str:
    if block.join_step is None:
        return "The team alone"
    return f"The ad hoc robot joins at step {block.join_step}"


def _printed(row: ResultRow, metric: str) -> str:
    value: float | None = getattr(row.scores, metric)
    return "-" if value is None else f"{value:.1f}"


def _bracket(row: ResultRow, metric: str) -> str:
    if metric == "efficiency":
        return ""
    if row.gain is None:
        return " (-)"
    value: float | None = getattr(row.gain, metric)
    return " (n/a)" if value is None else f" ({value:.1f})"
