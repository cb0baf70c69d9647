"""What models were used for, from records: the cost table and the estimate."""

from __future__ import annotations

import pytest
from test_records import record

from adhoc.experiments.estimate import spread_evenly, spread_of
from adhoc.reporting.cost_table import CostRow, Use, cost_rows, cost_table, dollars
from adhoc.reporting.rendering.markdown import markdown_table


def episode(task, stages, policy="IRoT-LLM", join_step=0, model="gpt", replayed=0):
    uses = [Use(*numbers) for numbers in stages.values()]
    names = ("calls", "prompt_tokens", "completion_tokens", "cost_usd")
    return record(
        episode_id=f"{task}-{policy}-{join_step}",
        task_id=task,
        team_label="Heuristic based",
        policy_label=policy,
        join_step=join_step,
        model=model,
        llm={
            **{name: sum(getattr(use, name) for use in uses) for name in names},
            "replayed": replayed,
            "stages": {stage: dict(zip(names, numbers)) for stage, numbers in stages.items()},
        },
    )


RECORDS = [
    episode("a", {"team generate": (1, 10, 1, 0.25)}, join_step=None),
    episode("a", {"generate": (2, 20, 2, 0.5), "team generate": (1, 10, 1, 0.25)}, replayed=1),
    episode("b", {"team reflect": (4, 40, 4, 1.0), "evaluate": (3, 30, 3, 0.75)}),
    episode("a", {}, policy="Random"),
    episode("a", {"generate": (9, 90, 9, 0.0)}, policy="Offline", model="offline (not a language model)"),
]


def test_rows_are_sums_by_stage_with_the_team_as_one():
    irot, team = "IRoT-LLM (gpt)", "Heuristic based alone (gpt)"
    assert cost_rows(RECORDS) == [
        CostRow(team, "team", Use(1, 10, 1, 0.25), 1),
        CostRow(team, "all", Use(1, 10, 1, 0.25), 1),
        CostRow(irot, "evaluate", Use(3, 30, 3, 0.75), 2),
        CostRow(irot, "generate", Use(2, 20, 2, 0.5), 2),
        CostRow(irot, "team", Use(5, 50, 5, 1.25), 2),
        CostRow(irot, "all", Use(10, 100, 10, 2.5), 2),
    ]


def test_the_table_tells_what_the_ledger_spared():
    text = markdown_table(cost_table(RECORDS))
    assert "| IRoT-LLM (gpt) | all | 10 | 100 | 10 | 2.50 | 1.25 |" in text
    assert "1 calls were answered by a ledger" in text
    assert "ledger" not in markdown_table(cost_table(RECORDS[2:3]))


def test_without_a_language_model_there_is_no_table():
    assert cost_table(RECORDS[3:]) is None
    assert cost_table(RECORDS) is not None


@pytest.mark.parametrize(
    ("amount", "told"),
    [(0.0, "-"), (0.00012, "0.0001"), (0.5, "0.5000"), (1.0, "1.00"), (12345.678, "12,345.68")],
)
def test_dollars(amount, told):
    assert dollars(amount) == told


def test_a_spread_is_over_scenarios_and_both_their_episodes():
    spread = spread_of(RECORDS[:3])
    assert spread.mean == Use(5.5, 55.0, 5.5, 1.375)
    assert spread.least == Use(4, 40, 4, 1.0)
    assert spread.most == Use(7, 70, 7, 1.75)
    assert spread.times(2).mean == Use(11, 110, 11, 2.75)


@pytest.mark.parametrize(
    ("number", "count", "positions"),
    [(8, 4, [1, 3, 5, 7]), (30, 4, [3, 11, 18, 26]), (3, 4, [0, 1, 2]), (1, 4, [0]), (1350, 2, [337, 1012])],
)
def test_positions_are_spread_evenly(number, count, positions):
    assert spread_evenly(number, count) == positions
