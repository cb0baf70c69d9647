"""The paper's tables as numbers, from episode records and from nothing else (section Quantitative
Performance)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from adhoc.evaluation.contender import ALONE
from adhoc.evaluation.records import Record
from adhoc.reporting.contestants import Contestant, Team
from adhoc.reporting.pairing import Pair
from adhoc.reporting.paper_order import policy_order, team_order
from adhoc.reporting.remarks import remarks
from adhoc.reporting.results import Results
from adhoc.reporting.rows import ResultRow, averages, gain_of, unaided_successes, uncertainties


@dataclass(frozen=True)
class Block:
    """All rows of one joining step, in the paper's order: of each team first the team alone."""

    join_step: int | None
    """None if the records hold no newcomer."""
    rows: tuple[ResultRow, ...]


@dataclass(frozen=True)
class Report:
    """All results, and what a reader must know of them."""

    blocks: tuple[Block, ...]
    models: tuple[str, ...]
    """Names of the language models that made it; empty if none was used."""
    notes: tuple[str, ...]
    warnings: tuple[str, ...] = ()

    @property
    def title(self) -> str:
        """What it is and which model made it."""
        return f"Heterogeneous ad hoc teamwork; {self.model}"

    @property
    def model(self) -> str:
        """Which model made it, for the title of every table."""
        return f"language model: {', '.join(self.models) or 'none used'}"


def make_report(results: Results, intervals: bool = False) -> Report:
    """Derive all rows. Episodes without a team-alone partner are in none and counted in a note.

    With `intervals` it also says how far each number can be trusted.
    """
    drafts = list(_drafts(results))
    if intervals:
        found = uncertainties([(draft.mine, draft.alone) for draft in drafts])
        drafts = [replace(it, row=replace(it.row, uncertainty=how)) for it, how in zip(drafts, found)]
    blocks = tuple(
        Block(step, tuple(it.row for it in drafts if it.join_step == step))
        for step in dict.fromkeys(it.join_step for it in drafts)
    )
    told = remarks(results)
    return Report(blocks, results.models, told.notes, told.warnings)


@dataclass(frozen=True)
class _Draft:
    """A row and what it was made from."""

    join_step: int | None
    row: ResultRow
    mine: Sequence[Record]
    alone: Sequence[Record]


def _drafts(results: Results) -> Iterator[_Draft]:
    groups: dict[int, dict[Team, dict[Contestant, list[Pair]]]] = {}
    for pair in results.pairs:
        teams_then = groups.setdefault(pair.joined["join_step"], {})
        teams_then.setdefault(pair.who.team, {}).setdefault(pair.who, []).append(pair)
    if not groups:
        alone = {who.team: records for (who, step), records in results.groups.items() if step is None}
        for team in sorted(alone, key=team_order):
            yield _alone(None, team, alone[team], results)
    for step in sorted(groups):
        for team in sorted(groups[step], key=team_order):
            mine = groups[step][team]
            references = {id(pair.alone): pair.alone for of_one in mine.values() for pair in of_one}
            yield _alone(step, team, list(references.values()), results)
            for who in sorted(mine, key=policy_order):
                yield _joined(step, who, mine[who], results)


def _alone(step: int | None, team: Team, records: Sequence[Record], results: Results) -> _Draft:
    row = ResultRow(team, None, results.teams[team], ALONE, averages(records), None)
    return _Draft(step, row, records, ())


def _joined(step: int, who: Contestant, mine: Sequence[Pair], results: Results) -> _Draft:
    joined = [pair.joined for pair in mine]
    scores = averages(joined)
    row = ResultRow(
        who.team,
        who,
        results.teams[who.team],
        results.rows[who],
        scores,
        gain_of(mine, scores),
        unaided=unaided_successes(mine),
    )
    return _Draft(step, row, joined, [pair.alone for pair in mine])
