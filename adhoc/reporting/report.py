"""The paper's table from episode records, and from nothing else (section Experimental Results)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich import box
from rich.table import Table

from adhoc.core.errors import RecordError
from adhoc.evaluation.llm_field import JUDGED
from adhoc.evaluation.metrics import EpisodeScore, Improvement, Scores, average, improvement
from adhoc.evaluation.records import FILE_NAME, Record, RecordFile
from adhoc.reporting.pairing import (
    Contestant,
    Pair,
    PairKey,
    Team,
    alone_records,
    check_settings,
    contestant,
    labels,
    pair_key,
    pairs,
    team_names,
    team_of,
)

COLUMNS = ("Team", "ad hoc", "%Suc ↑", "%PS ↑", "#TS ↓", "#AS ↓", "%SE ↑", "N")


@dataclass(frozen=True)
class Row:
    """One team with one ad hoc policy (or without), at one joining step.

    `scores` are over the episodes whose team-alone episode is there too, `gain` against those.
    """

    team: str
    ad_hoc: str
    scores: Scores
    gain: Improvement | None
    """None for the team alone."""


@dataclass(frozen=True)
class Names:
    """What teams and rows are called."""

    teams: Mapping[Team, str]
    rows: Mapping[Contestant, str]


@dataclass(frozen=True)
class Block:
    """One table of the paper: all rows of one joining step."""

    join_step: int | None
    """None if the folder holds no newcomer."""
    rows: tuple[Row, ...]


@dataclass(frozen=True)
class Report:
    """Everything that is printed."""

    blocks: tuple[Block, ...]
    models: tuple[str, ...]
    """Names of the language models that made it; empty if none was used."""
    notes: tuple[str, ...]
    warnings: tuple[str, ...] = ()
    """How much of each row is not the model's doing: invalid replies, and safe choices taken instead."""

    @property
    def title(self) -> str:
        """What it is and which model made it."""
        return f"Heterogeneous ad hoc teamwork; language model: {', '.join(self.models) or 'none used'}"


def read_folders(folders: Iterable[str | Path]) -> list[Record]:
    """The records of all folders. Raises RecordError if a folder has none, one is damaged, or the same
    episode is in two folders."""
    records: dict[str, Record] = {}
    for folder in folders:
        found = RecordFile(folder).read()
        if not found:
            raise RecordError(f"{Path(folder) / FILE_NAME}: no episode records; is it the out=... of a run?")
        for record in found:
            if record["episode_id"] in records:
                raise RecordError(f"{folder}: episode {record['episode_id']!r} is in another folder as well")
            records[record["episode_id"]] = record
    return list(records.values())


def make_report(records: Sequence[Record]) -> Report:
    """Derive the table. Episodes without a team-alone partner are left out of it and counted in a note.

    Raises RecordError for records that do not belong together (see `reporting.pairing`).
    """
    check_settings(records)
    alone, paired = alone_records(records), pairs(records)
    join_steps: list[int | None] = sorted({pair.joined["join_step"] for pair in paired})
    joined = [pair.joined for pair in paired]
    names = Names(team_names(records), labels(joined))
    return Report(
        tuple(_block(join_step, paired, alone, names) for join_step in join_steps or [None]),
        tuple(sorted({record["model"] for record in records if record["model"] is not None})),
        tuple(_notes(records, len(paired))),
        tuple(_warnings([*alone.values(), *joined], names)),
    )


def to_table(report: Report, block: Block) -> Table:
    """One block as a table for the terminal."""
    table = Table(
        title=f"{report.title}\n{_when(block)}",
        title_justify="left",
        box=box.SIMPLE_HEAD,
        collapse_padding=True,
        pad_edge=False,
    )
    for column in COLUMNS:
        is_name = column in COLUMNS[:2]
        table.add_column(column, justify="left" if is_name else "right", no_wrap=not is_name)
    team = None
    for row in block.rows:
        cells = row_cells(row)
        if team is not None and row.team != team:
            table.add_section()
        table.add_row("" if row.team == team else cells[0], *cells[1:])
        team = row.team
    return table


def to_markdown(report: Report) -> str:
    """The whole report as Markdown."""
    lines = [f"# {report.title}", ""]
    for block in report.blocks:
        lines += [f"## {_when(block)}", ""]
        lines += ["| " + " | ".join(COLUMNS) + " |", "|---|---|" + "---:|" * (len(COLUMNS) - 2)]
        lines += ["| " + " | ".join(row_cells(row)) + " |" for row in block.rows]
        lines.append("")
    lines += [f"- **{warning}**" for warning in report.warnings]
    lines += [f"- {note}" for note in report.notes]
    return "\n".join(lines).rstrip() + "\n"


def row_cells(row: Row) -> list[str]:
    """The cells of one row, in the order of `COLUMNS`; improvements in brackets, `-` where there is none
    and `n/a` where the team alone has zero to improve on."""
    scores, gain = row.scores, row.gain
    return [
        row.team,
        row.ad_hoc,
        f"{scores.success:.1f} {_bracket('success', gain)}",
        f"{scores.partial_success:.1f} {_bracket('partial_success', gain)}",
        f"{scores.temporal_steps:.1f} {_bracket('temporal_steps', gain)}",
        f"{scores.action_steps:.1f} {_bracket('action_steps', gain)}",
        "-" if scores.efficiency is None else f"{scores.efficiency:.1f}",
        str(scores.episodes),
    ]


def _block(
    join_step: int | None, paired: Sequence[Pair], alone: Mapping[PairKey, Record], names: Names
) -> Block:
    here = [pair for pair in paired if pair.joined["join_step"] == join_step]
    rows = []
    for team in dict.fromkeys(map(team_of, alone.values())):
        of_team = [pair for pair in here if team_of(pair.joined) == team]
        keys = dict.fromkeys(pair_key(pair.joined) for pair in of_team)
        references = [alone[key] for key in keys] or [
            record for record in alone.values() if not here and team_of(record) == team
        ]
        if references:
            rows.append(Row(names.teams[team], "No ad hoc", _average(references), None))
        for who in dict.fromkeys(contestant(pair.joined) for pair in of_team):
            mine = [pair for pair in of_team if contestant(pair.joined) == who]
            rows.append(_row(names.teams[team], names.rows[who], mine))
    return Block(join_step, tuple(rows))


def _row(team: str, label: str, mine: Sequence[Pair]) -> Row:
    scores = _average([pair.joined for pair in mine])
    return Row(team, label, scores, improvement(_average([pair.alone for pair in mine]), scores))


def _average(records: Sequence[Record]) -> Scores:
    return average(
        [
            EpisodeScore(
                record["success"],
                record["partial_success"],
                record["temporal_steps"],
                record["action_steps"],
                record["efficiency"],
            )
            for record in records
        ]
    )


def _notes(records: Sequence[Record], paired: int) -> Iterable[str]:
    joined = sum(record["join_step"] is not None for record in records)
    houses = len({record["house_id"] for record in records})
    scenarios = len({(record["task_id"], record["scenario_hash"]) for record in records})
    steps = " or ".join(map(str, sorted({record["max_steps"] for record in records})))
    yield f"scenarios: {scenarios}; houses: {houses}; steps: at most {steps}"
    yield f"{paired} paired episodes, N in a row"
    yield "in brackets: percent better than the team alone in the same scenarios"
    if joined > paired:
        yield f"{joined - paired} episodes left out: their team-alone episode is missing"
    never = sum(record["join_step"] is not None and not record["joined"] for record in records)
    if never:
        yield f"{never} of them ended before the newcomer would have joined"
    versions = sorted({record["library_version"] for record in records})
    if len(versions) > 1:
        yield f"made by several versions of the library: {', '.join(versions)}"


def _warnings(records: Sequence[Record], names: Names) -> Iterable[str]:
    """One line for each row's name in whose episodes a model was not understood or a planner gave up.

    Of a team alone it is the team's own models and planners, which its rows with a newcomer count too.
    """
    by_name: dict[str, list[Record]] = {}
    for record in records:
        alone = record["join_step"] is None
        team = names.teams[team_of(record)]
        name = f"{team} alone" if alone else names.rows[contestant(record)]
        name = name if alone or len(names.teams) == 1 else f"{name} beside {team}"
        by_name.setdefault(name, []).append(record)
    for name, mine in by_name.items():
        invalid, repaired = _total(mine, "llm", "invalid"), _total(mine, "llm", "repaired")
        asked = _asked(mine) or _total(mine, "llm", "calls")
        counts = "team_planning" if mine[0]["join_step"] is None else "planning"
        decisions, fallbacks = _total(mine, counts, "sub_tasks"), _total(mine, counts, "fallbacks")
        parts = [f"{invalid} of {asked} questions to the model got no usable reply"] if invalid else []
        parts += [f"{repaired} of {asked} only when asked again"] if repaired else []
        parts += [f"{fallbacks} of {decisions} decisions fell back to the safe choice"] if fallbacks else []
        if parts:
            yield f"{name}: {'; '.join(parts)}"


def _asked(records: Sequence[Record]) -> int:
    """How many questions the models were asked; one that was asked again after a bad reply counts once.

    Records of other versions may not tell.
    """
    outcomes = [record.get("llm", {}).get("outcomes", {}) for record in records]
    return sum(int(counts.get(outcome, 0)) for counts in outcomes for outcome in JUDGED)


def _total(records: Sequence[Record], field: str, count: str) -> int:
    """The sum of a count over records; those of other versions may lack it."""
    return sum(int(record.get(field, {}).get(count, 0)) for record in records)


def _when(block: Block) -> str:
    return (
        "The team alone" if block.join_step is None else f"The ad hoc robot joins at step {block.join_step}"
    )


def _bracket(metric: str, gain: Improvement | None) -> str:
    if gain is None:
        return "(-)"
    value: float | None = getattr(gain, metric)
    return "(n/a)" if value is None else f"({value:.1f})"
