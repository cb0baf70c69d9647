"""What language models were used for: calls, tokens and money, stage by stage, from episode records."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from adhoc.evaluation.records import Record
from adhoc.llm.offline.reasoner import OFFLINE_NAME
from adhoc.llm.team_model import TEAM_PREFIX
from adhoc.reporting.contestants import contestant
from adhoc.reporting.paper_order import Order, policy_order, team_order
from adhoc.reporting.table import Table, plain_table

COLUMNS = ("episodes of", "stage", "calls", "tokens in", "tokens out", "USD", "USD an episode")
TEAM_STAGE = "team"
"""All stages of all teammates as one."""
ALL_STAGES = "all"


@dataclass(frozen=True)
class Use:
    """Calls, tokens and US dollars; sums or means."""

    calls: float = 0.0
    prompt_tokens: float = 0.0
    completion_tokens: float = 0.0
    cost_usd: float = 0.0

    def __add__(self, other: Use) -> Use:
        return Use(
            self.calls + other.calls,
            self.prompt_tokens + other.prompt_tokens,
            self.completion_tokens + other.completion_tokens,
            self.cost_usd + other.cost_usd,
        )

    def times(self, factor: float) -> Use:
        """This much, so many times."""
        return Use(
            factor * self.calls,
            factor * self.prompt_tokens,
            factor * self.completion_tokens,
            factor * self.cost_usd,
        )


@dataclass(frozen=True)
class CostRow:
    """One stage of the episodes of one policy, or all its stages (`ALL_STAGES`), in sum."""

    contestant: str
    """The policy and its model; the team and its model where it was alone."""
    stage: str
    use: Use
    episodes: int


def use_of(record: Record) -> Use:
    """All that an episode asked."""
    return _use(record["llm"])


def total_use(records: Sequence[Record]) -> Use:
    """All that several episodes asked, in sum."""
    asked = [record["llm"] for record in records]
    return Use(*(sum([counts.get(name, 0) for counts in asked]) for name in Use.__dataclass_fields__))


def uses_by_stage(record: Record) -> dict[str, Use]:
    """What every stage of an episode asked; the stages of teammates as `TEAM_STAGE`."""
    uses: dict[str, Use] = {}
    stages: Mapping[str, Any] = record["llm"].get("stages", {})
    for stage, counts in stages.items():
        name = TEAM_STAGE if stage.startswith(TEAM_PREFIX) else stage
        uses[name] = uses.get(name, Use()) + _use(counts)
    return uses


def cost_rows(records: Iterable[Record]) -> list[CostRow]:
    """The rows of the table, one block for each policy with its model; none for episodes without a model, and
    none for the offline reasoner, which is free and whose tokens are nobody's."""
    groups: dict[str, list[Record]] = {}
    asked = [it for it in records if it["llm"]["calls"] and it["model"] != OFFLINE_NAME]
    several = len({it["team_label"] for it in asked}) > 1
    for record in sorted(asked, key=_order):
        groups.setdefault(_contestant(record, several), []).append(record)
    return [row for name, mine in groups.items() for row in stage_rows(name, mine)]


def stage_rows(contestant: str, records: Sequence[Record]) -> Iterator[CostRow]:
    """One row for each stage, the team's after the newcomer's, and one for all."""
    stages: dict[str, Use] = {}
    for record in records:
        for stage, use in uses_by_stage(record).items():
            stages[stage] = stages.get(stage, Use()) + use
    for stage in sorted(stages, key=lambda name: (name == TEAM_STAGE, name)):
        yield CostRow(contestant, stage, stages[stage], len(records))
    yield CostRow(contestant, ALL_STAGES, total_use(records), len(records))


def cost_table(records: Sequence[Record]) -> Table | None:
    """The table; None if no language model was asked."""
    groups: dict[str, list[list[str]]] = {}
    for row in cost_rows(records):
        groups.setdefault(row.contestant, []).append(_cells(row))
    if not groups:
        return None
    return plain_table("calls", "Calls of language models", COLUMNS, 2, groups.values(), [cost_note(records)])


def cost_note(records: Iterable[Record]) -> str:
    """What the numbers mean."""
    replayed = sum(int(record["llm"].get("replayed", 0)) for record in records)
    spared = f"; {replayed} calls were answered by a ledger and cost nothing again" if replayed else ""
    return f"every call of an episode at what it cost when it was made{spared}; '-': free, or no known price"


def dollars(amount: float) -> str:
    """US dollars with as many digits as matter; `-` for nothing."""
    return "-" if amount == 0 else f"{amount:,.2f}" if amount >= 1 else f"{amount:.4f}"


def _cells(row: CostRow) -> list[str]:
    use = row.use
    return [
        row.contestant,
        row.stage,
        f"{use.calls:,.0f}",
        f"{use.prompt_tokens:,.0f}",
        f"{use.completion_tokens:,.0f}",
        dollars(use.cost_usd),
        dollars(use.cost_usd / row.episodes),
    ]


def _contestant(record: Record, several_teams: bool) -> str:
    alone = record["join_step"] is None
    beside = f" beside {record['team_label']}" if several_teams else ""
    name = f"{record['team_label']} alone" if alone else f"{record['policy_label']}{beside}"
    return f"{name} ({record['model']})"


def _order(record: Record) -> tuple[Order, Order]:
    who = contestant(record)
    return team_order(who.team), policy_order(who)


def _use(counts: Mapping[str, Any]) -> Use:
    return Use(*(counts.get(name, 0) for name in Use.__dataclass_fields__))
