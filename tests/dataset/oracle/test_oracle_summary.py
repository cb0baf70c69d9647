"""The table of ceilings."""

from __future__ import annotations

import io

import pytest
from oracle_houses import idle, kitchen, robot, scenario
from rich.console import Console

from adhoc.core.errors import ConfigurationError
from adhoc.dataset.oracle import Ceiling, summarise, to_markdown, to_table
from adhoc.evaluation.scenario import Difficulty, Scenario


def task(task_id: str, difficulty: Difficulty, size: int) -> Scenario:
    team = [robot(f"robot {number}", 1.0, 1.0) for number in range(size)]
    made = scenario(kitchen(), [], team, idle("newcomer", 0.5, 3.5))
    return Scenario(task_id, made.house, (), made.team, made.newcomer, 0, difficulty)


TASKS = [
    task("a", Difficulty.EASY, 3),
    task("b", Difficulty.EASY, 3),
    task("c", Difficulty.EASY, 4),
    task("d", Difficulty.DIFFICULT, 3),
]
CEILINGS = [
    Ceiling("a", "team", 20, 10, least_steps=8),
    Ceiling("b", "newcomer", None, 30, least_steps=21),
    Ceiling("c", "none", None, None, "no robot can carry it", True),
    Ceiling("d", "none", None, None, "not solved by the oracle: batteries", False),
]


def test_shares_and_medians_by_difficulty_and_team_size():
    rows = {(row.difficulty, row.teammates): row for row in summarise(CEILINGS, TASKS)}
    assert list(rows) == [
        ("Easy", "3"),
        ("Easy", "4"),
        ("Easy", "all"),
        ("Difficult", "3"),
        ("Difficult", "all"),
        ("all", "all"),
    ]
    three = rows["Easy", "3"]
    assert (three.tasks, three.team, three.newcomer, three.none, three.proven) == (2, 0.5, 0.5, 0.0, 0.0)
    assert (three.team_steps, three.joint_steps, three.least_steps) == (20.0, 20.0, 14.5)
    four = rows["Easy", "4"]
    assert (four.none, four.proven, four.team_steps, four.joint_steps) == (1.0, 1.0, None, None)
    everything = rows["all", "all"]
    assert (everything.tasks, everything.none, everything.proven) == (4, 0.5, 0.25)


def test_markdown_and_terminal_show_the_same_cells():
    rows = summarise(CEILINGS, TASKS)
    lines = to_markdown(rows).splitlines()
    assert lines[0].startswith("| difficulty | team | tasks | team alone |")
    assert lines[2] == "| Easy | 3 | 2 | 50.0% | 50.0% | 0.0% | 0.0% | 20 | 20 | 14.5 |"
    assert lines[3] == "| Easy | 4 | 1 | 0.0% | 0.0% | 100.0% | 100.0% | - | - | - |"
    shown = io.StringIO()
    Console(width=160, file=shown).print(to_table(rows))
    for cell in ("Difficult", "50.0%", "14.5"):
        assert cell in shown.getvalue()


def test_nothing_is_summarised_to_nothing():
    assert summarise([], TASKS) == ()


def test_a_ceiling_of_no_task_is_an_error():
    with pytest.raises(ConfigurationError, match="'x'"):
        summarise([Ceiling("x", "team", 1, 1)], TASKS)
