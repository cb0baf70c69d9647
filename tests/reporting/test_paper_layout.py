"""Results in the layout of the paper's tables."""

from __future__ import annotations

import re

import pytest
from test_report import episode, failed

from adhoc.reporting.paper_layout import best_of, paper_only, paper_tables
from adhoc.reporting.paper_numbers import paper_numbers
from adhoc.reporting.report import make_report
from adhoc.reporting.results import Results

LLM = {"team": "llm", "team_label": "LLM based"}
HEURISTIC = {"team": "heuristic", "team_label": "Heuristic based"}


def named(task, policy, label, step, make=failed, model="gpt", **changes):
    return make(task, policy, step, model, policy_label=label, episode_id=f"{task} {policy} {step} {model} "
                f"{changes.get('team')}", **changes)  # fmt: skip


def records(step=0):
    """In an order that no table has."""
    return [
        named("a", "irot", "IRoT-LLM", step, episode, temporal_steps=400, **LLM),
        named("a", "irot_no_evaluation", "IRoT w/o Ev.", step, **LLM),
        named("a", "mine", "Mine", step, **LLM),
        named("a", "random", "Random", step, **LLM),
        named("a", "random", "Random", step, **HEURISTIC),
        failed("a", episode_id="h", **HEURISTIC),
        named("a", "no_subtask_planner", "w/o STP.", step, **LLM),
        failed("a", episode_id="l", **LLM),
    ]


def names(table):
    return [[row.cells[1].text for row in group] for group in table.groups]


def test_teams_and_policies_stand_in_the_papers_order_and_ablations_apart():
    main, ablation = paper_tables(make_report(Results.of(records())))
    assert [group[0].cells[0].text for group in main.groups] == ["Heuristic based", "LLM based"]
    assert names(main) == [["No ad hoc", "Random"], ["No ad hoc", "Random", "IRoT-LLM", "Mine"]]
    assert main.key == "joining-0"
    assert ablation.title == "Ablation of the sub-task planner; team: LLM based; language model: gpt"
    assert names(ablation) == [["No ad hoc", "w/o STP.", "IRoT w/o Ev.", "IRoT-LLM"]]
    assert [cell.text for cell in ablation.groups[0][3].cells] == [
        "0", "IRoT-LLM", "100.0 (n/a)", "100.0 (100.0)", "400.0 (20.0)", "240.0 (84.0)", "0.0", "1",
    ]  # fmt: skip


def test_every_joining_step_is_a_table_and_a_group_of_the_ablation():
    alone = [it for it in records() if it["join_step"] is None]
    joined = [it for step in (100, 0) for it in records(step) if it["join_step"] is not None]
    tables = list(paper_tables(make_report(Results.of([*joined, *alone]))))
    assert [table.key for table in tables] == ["joining-0", "joining-100", "ablation"]
    assert [group[0].cells[0].text for group in tables[2].groups] == ["0", "100"]


def test_the_best_newcomer_is_bold_and_all_that_are_equal():
    (main, _) = paper_tables(make_report(Results.of(records())))
    bold = [[[cell.bold for cell in row.cells[2:7]] for row in group] for group in main.groups]
    assert not any(map(any, bold[0])), "one policy is not the best of anything"
    assert bold[1] == [
        [False] * 5,
        [False] * 5,
        [True, True, True, True, False],
        [False] * 5,
    ], "fewer steps are better, and where all are equal nobody is best"


def test_equal_as_printed_is_equal():
    """1 of 3 and 0.33333 of 1 are both printed as 33.3."""
    report = make_report(
        Results.of(
            [
                failed("a"),
                failed("a", "x", 0, partial_success=0.33333),
                failed("a", "y", 0, partial_success=1 / 3),
                failed("a", "z", 0, partial_success=0.25),
            ]
        )
    )
    rows = report.blocks[0].rows
    best = best_of(rows)
    assert [row.ad_hoc for number, row in enumerate(rows) if "partial_success" in best.get(number, ())] == [
        "x",
        "y",
    ]


def test_intervals_stand_below_and_marks_behind():
    many = [it for number in range(12) for it in _house(number)]
    report = make_report(Results.of(many), intervals=True)
    marked = {(0, "Heuristic based", "Good")}
    (table,) = paper_tables(report, intervals=True, marked=marked)
    alone, good, same = table.groups[0]
    assert alone.cells[2].below == "[?]", "all houses are alike"
    assert good.cells[2].text == "75.0 (n/a)*†"
    assert re.fullmatch(r"\[[\d.]+, [\d.]+\]", good.cells[2].below)
    assert "†" not in same.cells[2].text
    assert "." not in good.cells[4].below, "steps are whole"
    assert [it[:10] for it in table.remarks] == ["below each", "†: the 95%", "*: success"]
    (plain,) = paper_tables(report, marked=marked)
    assert not plain.has_lines_below
    assert plain.groups[0][1].cells[2].text == "75.0 (n/a)"


def test_a_gain_is_positive_where_it_is_better():
    records = []
    for number in range(3):
        task, here = f"task {number}", {"house_id": f"house {number}"}
        good = {"temporal_steps": 100 * number, "action_steps": 1600}
        records += [failed(task, temporal_steps=500, **here), episode(task, "Good", 0, **good, **here)]
    row = make_report(Results.of(records), intervals=True).blocks[0].rows[1]
    assert row.uncertainty is not None
    assert {metric: it.mean for metric, it in row.uncertainty.gains.items()} == {
        "success": 100.0, "partial_success": 50.0, "temporal_steps": 400.0, "action_steps": -100.0,
    }  # fmt: skip
    assert row.uncertainty.values["temporal_steps"].mean == 100.0


@pytest.mark.parametrize("houses", [9, 10])
def test_a_dagger_needs_ten_houses_that_are_not_all_alike(houses):
    many = [it for number in range(houses) for it in _house(number)]
    (table,) = paper_tables(make_report(Results.of(many), intervals=True), intervals=True)
    assert ("†" in table.groups[0][1].cells[2].text) is (houses == 10)


def _house(number):
    here = {"house_id": f"house {number}"}
    task = f"task {number}"
    good = failed if number % 4 == 0 else episode
    return [failed(task, **here), good(task, "Good", 0, **here), failed(task, "Same", 0, **here)]


def test_the_papers_numbers_stand_below_ours():
    main, ablation = paper_tables(make_report(Results.of(records(50))), paper=paper_numbers())
    told = [[cell.text for cell in row.cells] for row in main.groups[1]]
    assert [row[1] for row in told] == [
        "No ad hoc", "in the paper", "Random", "in the paper", "IRoT-LLM", "in the paper", "Mine",
    ]  # fmt: skip
    assert told[5] == [
        "LLM based", "in the paper", "25.6 (21.3)", "34.2 (25.7)", "403.9 (10.9)", "1859.2 (-2.5)", "2.6", "",
    ]  # fmt: skip
    assert main.groups[1][5].faint
    assert [row.cells[2].text for row in ablation.groups[0] if row.faint] == [
        "21.1 (-)", "21.6 (2.4)", "23.5 (11.4)", "25.6 (21.3)",
    ]  # fmt: skip
    assert "gpt-4-1106-preview on its 1350 tasks" in main.remarks[-1]


def test_of_two_models_of_one_policy_each_gets_its_own_row_of_the_paper():
    weaker = named("a", "irot", "IRoT-LLM", 0, model="openai/gpt-3.5-turbo-1106", **LLM)
    _, ablation = paper_tables(make_report(Results.of([*records(), weaker])), paper=paper_numbers())
    told = {
        row.cells[1].text: below.cells[2].text
        for row, below in zip(ablation.groups[0], ablation.groups[0][1:])
    }
    assert told["IRoT-LLM (gpt)"] == "26.3 (24.6)"
    assert told["IRoT-LLM (openai/gpt-3.5-turbo-1106)"] == "25.0 (18.5)"


def test_a_stray_bracket_of_the_paper_is_marked_as_its_own():
    names = [
        row.cells[1].text for table in paper_only(paper_numbers()) for group in table.groups for row in group
    ]
    assert "GPL-LLM) [sic]" in names
    assert "IRoT (GPT-3.5)" in names
    assert sum("[sic]" in it for it in names) == 1


def test_the_dagger_is_explained_where_it_stands():
    many = [it for number in range(12) for it in _house(number)]
    (table,) = paper_tables(make_report(Results.of(many), intervals=True), intervals=True)
    (told,) = (it for it in table.remarks if it.startswith("†"))
    assert "the 95% interval of the paired difference from the team alone (not shown) excludes zero" in told
    assert "not corrected for many comparisons" in told
    (table,) = paper_tables(make_report(Results.of(many[:27]), intervals=True), intervals=True)
    assert not any("†" in it for it in table.remarks), "nobody has one with nine houses"


def test_a_joining_step_that_the_paper_does_not_have_has_no_row_of_it():
    (main, _) = paper_tables(make_report(Results.of(records(7))), paper=paper_numbers())
    assert not any(row.faint for group in main.groups for row in group)
