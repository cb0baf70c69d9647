"""What a reader must know of a table: how it was made, and what is not as it should be."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from adhoc.core.counting import counted
from adhoc.evaluation.llm_field import JUDGED
from adhoc.evaluation.records import Record
from adhoc.reporting.contestants import Contestant, Team, contestant
from adhoc.reporting.paper_order import policy_order, team_order
from adhoc.reporting.results import Results

OTHER_SCENARIOS = "rows are over different scenarios: compare within a row only"
"""Brackets and differences hold even then: each row has the team alone in its own scenarios beside it."""
MUCH = 0.05
"""From this share of unusable replies or safe choices on, a row says more of them than of its policy."""


@dataclass(frozen=True)
class Remarks:
    """What is said below the tables."""

    notes: tuple[str, ...]
    """How the numbers were made, and where models were now and then not understood."""
    warnings: tuple[str, ...]
    """Mixtures, rows over different tasks, and models that were often not understood."""


def remarks(results: Results) -> Remarks:
    """All remarks on what is shown: the teams alone, and all pairs."""
    shown = [*results.alone.values(), *(pair.joined for pair in results.pairs)]
    told = list(_understanding(results))
    return Remarks(
        (*_notes(results), *(it for it, is_much in told if not is_much)),
        (
            *_versions(shown),
            *_task_versions(shown),
            *_uneven(results),
            *_other_scenarios(results),
            *(it for it, is_much in told if is_much),
        ),
    )


def _notes(results: Results) -> Iterator[str]:
    records, paired = results.records, results.pairs
    joined = sum(record["join_step"] is not None for record in records)
    houses = len({record["house_id"] for record in records})
    scenarios = len({(record["task_id"], record["scenario_hash"]) for record in records})
    steps = " or ".join(map(str, sorted({record["max_steps"] for record in records})))
    yield f"scenarios: {scenarios}; houses: {houses}; steps: at most {steps}"
    yield f"{counted(len(paired), 'paired episode')}, N in a row"
    yield "in brackets: percent better than the team alone in the same scenarios"
    if joined > len(paired):
        left_out = counted(joined - len(paired), "episode")
        yield f"{left_out} left out: the team-alone episode to compare with is missing"
    never = sum(not pair.joined["joined"] for pair in paired)
    if never:
        yield f"{never} of them ended before the newcomer would have joined"


def _versions(records: Iterable[Record]) -> Iterator[str]:
    counts = Counter(str(record["library_version"]) for record in records)
    if len(counts) > 1:
        told = ", ".join(
            f"{version} ({counted(count, 'episode')})" for version, count in sorted(counts.items())
        )
        yield f"made by several versions of the library, which may differ in what they do: {told}"


def _task_versions(records: Iterable[Record]) -> Iterator[str]:
    hashes: dict[str, set[str]] = {}
    for record in records:
        hashes.setdefault(record["task_id"], set()).add(record["scenario_hash"])
    several = sorted(task for task, found in hashes.items() if len(found) > 1)
    if several:
        yield (
            f"{_are(len(several), 'task')} there in several versions (house, objects or robots differ), each "
            f"counted as a task of its own: {', '.join(several[:3])}{', ...' if len(several) > 3 else ''}"
        )


def _uneven(results: Results) -> Iterator[str]:
    """Rows that are not over the scenarios of the others of their team and joining step."""
    counts: dict[tuple[int, Team], Counter[Contestant]] = {}
    scenarios: dict[tuple[int, Team], set[int]] = {}
    for pair in results.pairs:
        block = (pair.joined["join_step"], pair.who.team)
        counts.setdefault(block, Counter())[pair.who] += 1
        scenarios.setdefault(block, set()).add(id(pair.alone))
    for (step, team), found in sorted(counts.items(), key=lambda it: (it[0][0], it[0][1].name)):
        total = len(scenarios[step, team])
        fewer = [f"{results.rows[who]} {count}" for who, count in found.items() if count < total]
        if fewer:
            yield (
                f"{results.teams[team]}, joining at step {step}: {OTHER_SCENARIOS} "
                f"({', '.join(sorted(fewer))} of {counted(total, 'scenario')})"
            )


def _other_scenarios(results: Results) -> Iterator[str]:
    """Teams of one table that are over other scenarios than each other."""
    found: dict[int | None, dict[Team, set[tuple[str, str]]]] = {}
    shown = ((it.joined["join_step"], it.who.team, it.alone) for it in results.pairs)
    alone = ((None, contestant(it).team, it) for it in results.alone.values())
    for step, team, record in shown if results.pairs else alone:
        of_team = found.setdefault(step, {}).setdefault(team, set())
        of_team.add((record["task_id"], record["scenario_hash"]))
    for step, teams in sorted(found.items(), key=lambda it: -1 if it[0] is None else it[0]):
        if any(scenarios != next(iter(teams.values())) for scenarios in teams.values()):
            where = "the team alone" if step is None else f"joining at step {step}"
            common = len(set.intersection(*teams.values()))
            counts = (f"{results.teams[it]} {len(teams[it])}" for it in sorted(teams, key=team_order))
            yield (
                f"{where}: {OTHER_SCENARIOS} ({', '.join(counts)}; {counted(common, 'scenario')} shared by "
                "all)"
            )


def _understanding(results: Results) -> Iterator[tuple[str, bool]]:
    """One line for each row's name in whose episodes a model was not understood or a planner gave up, and
    whether that was in at least `MUCH` of the questions or decisions.

    Of a team alone it is the team's own models and planners, which its rows with a newcomer count too.
    """
    rows: dict[Contestant, list[Record]] = {}
    for record in results.alone.values():
        rows.setdefault(contestant(record), []).append(record)
    for pair in results.pairs:
        rows.setdefault(pair.who, []).append(pair.joined)
    for who in sorted(rows, key=lambda it: (team_order(it.team), policy_order(it))):
        mine = rows[who]
        invalid, repaired = total(mine, "llm", "invalid"), total(mine, "llm", "repaired")
        counts = "team_planning" if mine[0]["join_step"] is None else "planning"
        decisions, fallbacks = total(mine, counts, "sub_tasks"), total(mine, counts, "fallbacks")
        asked = (questions(mine) or total(mine, "llm", "calls")) if invalid or repaired else 0
        parts = [f"{invalid} of {asked} questions to the model got no usable reply"] if invalid else []
        parts += [f"{repaired} of {asked} only when asked again"] if repaired else []
        parts += [f"{fallbacks} of {decisions} decisions fell back to the safe choice"] if fallbacks else []
        if parts:
            is_much = max(invalid, repaired) >= MUCH * asked > 0 or fallbacks >= MUCH * decisions > 0
            yield f"{_row(who, mine[0], results)}: {'; '.join(parts)}", is_much


def _row(who: Contestant, record: Record, results: Results) -> str:
    """Whose episode it is, said without the table around it."""
    team, name = results.teams[who.team], results.rows[who]
    if record["join_step"] is None:
        return f"{team} alone"
    return name if len(results.teams) == 1 else f"{name} beside {team}"


def questions(records: Iterable[Record]) -> int:
    """How many questions the models were asked; one that was asked again after a bad reply counts once.

    Records of other versions may not tell.
    """
    found = [record.get("llm", _NOTHING).get("outcomes") for record in records]
    return sum(count for counts in found if counts for outcome, count in counts.items() if outcome in JUDGED)


def total(records: Iterable[Record], field: str, count: str) -> int:
    """The sum of a count over records; those of other versions may lack it."""
    return sum([record.get(field, _NOTHING).get(count, 0) for record in records])


def _are(number: int, thing: str) -> str:
    return f"{counted(number, thing)} {'is' if number == 1 else 'are'}"


_NOTHING: Mapping[str, int] = {}
