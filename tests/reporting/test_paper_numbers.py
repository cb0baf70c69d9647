"""The paper's numbers, as printed, and which of them contradict each other."""

from __future__ import annotations

from dataclasses import replace

import pytest

from adhoc.core.errors import RecordError
from adhoc.reporting.contradiction_table import contradiction_table
from adhoc.reporting.contradictions import contradictions
from adhoc.reporting.paper_layout import paper_only
from adhoc.reporting.paper_numbers import METRICS, PaperNumbers, PaperTable, paper_numbers
from adhoc.reporting.printed import read_cell


def named(numbers):
    return [
        (
            it.place.table,
            it.place.heading,
            it.place.join_step,
            it.place.row,
            it.place.metric,
            it.place.printed,
        )
        for it in contradictions(numbers)
    ]


def test_all_cells_are_there_as_printed():
    paper = paper_numbers()
    assert [len(block.rows) for _, block in paper.blocks()] == [8] * 9 + [7] * 3
    assert [(block.team, block.join_step) for table, block in paper.blocks() if table.is_ablation] == [
        ("llm", 0), ("llm", 50), ("llm", 100),
    ]  # fmt: skip
    bold = [row.label for _, block in paper.blocks() for row in block.rows if row.cells[0].bold]
    assert bold == ["IRoT-LLM"] * 12
    texts = {cell.text for _, block in paper.blocks() for row in block.rows for cell in row.cells}
    assert {"2213 (-18.8)", "453.2(0)", "1890.2", "367.3 (-)"} <= texts, "its slips are kept"
    irot = paper.tables[1].blocks[0].rows[-1]
    assert [cell.bold for cell in irot.cells] == [True, True, True, False, False]


def test_exactly_the_cells_that_contradict_others_are_named():
    """Each was worked out by hand from the paper's tables; the reasons are in the parametrised test below."""
    ablation, heuristic, learned, llm = "the ablation table", "Heuristic based", "Learning based", "LLM based"
    found = dict.fromkeys(named(paper_numbers()))
    assert list(found) == [
        ("Table 1", llm, 0, "Random", "action_steps", "2186.1 (-20.1)"),
        ("Table 2", heuristic, 50, "No ad hoc", "temporal_steps", "367.3 (-)"),
        ("Table 2", learned, 50, "Random", "temporal_steps", "437.8 (0)"),
        ("Table 2", llm, 50, "No ad hoc", "action_steps", "1813.1 (-)"),
        ("Table 3", heuristic, 100, "GPL-LLM", "action_steps", "1945.6 (-4.5)"),
        ("Table 3", heuristic, 100, "IRoT-LLM", "action_steps", "1822.8 (2.1)"),
        ("Table 3", learned, 100, "CoT-LLM", "temporal_steps", "449.2 (2.5)"),
        ("Table 3", llm, 100, "IRoT-LLM", "temporal_steps", "407.5 (10.1)"),
        (ablation, "50", 50, "No ad hoc", "temporal_steps", "435.2 (-)"),
        (ablation, "100", 100, "No ad hoc", "temporal_steps", "435.2 (-)"),
        (ablation, "100", 100, "IRoT w/o Ev.", "partial_success", "20.8 (13.2)"),
        (ablation, "100", 100, "IRoT w/o Rf.", "partial_success", "20.6 (12.5)"),
        (ablation, "100", 100, "IRoT-LLM", "temporal_steps", "407.6 (10.0)"),
    ]


@pytest.mark.parametrize(
    ("printed", "reason"),
    [
        # 2186.1 / 1813.3 = 1.2056
        ("2186.1 (-20.1)", "2186.1 is -20.57 to -20.55 percent, not -20.1"),
        # 410.8 / (1 - 0.121) = 467.3 and likewise for all rows; the other tables have 467.3
        ("367.3 (-)", "7 of the 7 percentages that refer to it do not fit it; 7 fit 467.3"),
        ("367.3 (-)", "the same is 467.3 in Table 1, t0=0; 467.3 in Table 3, t0=100"),
        # 2133.3 / 1813.1 = 1.17660, but 2133.3 / 1813.3 = 1.17647, and 2133.25 / 1813.35 = 1.17641
        ("1813.1 (-)", "1 of the 7 percentages that refer to it do not fit it; 7 fit 1813.3"),
        ("1813.1 (-)", "the same is 1813.3 in Table 1, t0=0; 1813.3 in Table 3, t0=100"),
        # 437.8 / 473.8 = 0.924
        ("437.8 (0)", "437.8 is 7.58 to 7.62 percent, not 0"),
        # 449.2 / 473.8 = 0.948
        ("449.2 (2.5)", "449.2 is 5.17 to 5.21 percent, not 2.5"),
        # 1945.6 / 1863.2 = 1.0442
        ("1945.6 (-4.5)", "-4.43 to -4.42 percent, not -4.5 (a slip in the last digit)"),
        # 427.1 / (1 - 0.058) = 453.4
        ("435.2 (-)", "6 of the 6 percentages that refer to it do not fit it; 6 fit 453.2"),
        # 27.2 * 1.132 = 30.8
        ("20.8 (13.2)", "not 13.2; that would be 30.72 to 30.86"),
        ("20.8 (13.2)", "less than its %Suc of 22.9"),
        ("20.6 (12.5)", "not 12.5; that would be 30.53 to 30.67"),
        ("407.6 (10.0)", "the same is 407.5 in Table 3, t0=100"),
    ],
)  # fmt: skip
def test_the_reasons(printed, reason):
    reasons = [it.reason for it in contradictions(paper_numbers()) if it.place.printed == printed]
    assert any(reason in it for it in reasons), reasons


def with_cell(printed: str, row: int = 7, metric: str = "success") -> PaperNumbers:
    """Table 1's first block alone, which is without fault, with one cell replaced."""
    paper = paper_numbers()
    block = paper.tables[0].blocks[0]
    cells = list(block.rows[row].cells)
    cells[METRICS.index(metric)] = read_cell(printed, "here")
    rows = (*block.rows[:row], replace(block.rows[row], cells=tuple(cells)), *block.rows[row + 1 :])
    return replace(paper, tables=(PaperTable(1, "", (replace(block, rows=rows),)),))


def test_a_block_without_fault_is_not_named():
    assert named(with_cell("21.0 (37.3)")) == []


@pytest.mark.parametrize(
    ("printed", "fits"),
    [
        # 15.3 is 15.25 to 15.35, and 21.0 is 20.95 to 21.05: 36.48 to 38.03 percent, printed as 36.5 to 38.0.
        ("21.0 (36.5)", True),
        ("21.0 (36.4)", False),
        ("21.0 (38.0)", True),
        ("21.0 (38.1)", False),
        ("21.0 (-37.3)", False),
        ("21.0", True),
        ("21 (40)", True),
    ],
)
def test_a_percentage_may_be_anything_that_rounding_allows(printed, fits):
    found = [it for it in named(with_cell(printed)) if it[4] == "success"]
    assert bool(found) is not fits


def test_of_the_team_alone_one_wrong_number_is_named_instead_of_seven():
    (found,) = named(with_cell("16.3 (-)", row=0))
    assert found[3:] == ("No ad hoc", "success", "16.3 (-)")


def test_a_misprint_that_is_nowhere_repeated_is_told_by_what_its_percentages_fit():
    """19.85 / 1.3005 = 15.263 of CoT-LLM, and 21.05 / 1.3725 = 15.337 of IRoT-LLM, are the tightest."""
    (found,) = contradictions(with_cell("16.3 (-)", row=0))
    assert "7 of the 7 percentages that refer to it do not fit it; 7 fit 15.26 to 15.34" in found.reason


def test_of_two_numbers_of_a_team_the_percentages_tell_the_misprint():
    """Each is printed once; the block with 15.4 is otherwise the same, so that all percentages fit 15.3."""
    right, wrong = with_cell("15.3 (-)", row=0), with_cell("15.6 (-)", row=0)
    both = PaperNumbers("", "", 1, (right.tables[0], replace(wrong.tables[0], number=2)))
    assert [(it[0], it[5]) for it in dict.fromkeys(named(both))] == [("Table 2", "15.6 (-)")]


def test_success_above_partial_success_is_named():
    found = named(with_cell("30.9 (102.0)"))
    assert [it[4] for it in found] == ["partial_success"]


@pytest.mark.parametrize("printed", ["", "12.3 [4]", "(1)", "1.2.3", "12,3", "nan"])
def test_what_is_no_cell_is_an_error(printed):
    with pytest.raises(RecordError, match="here"):
        read_cell(printed, "here")


def test_the_papers_tables_alone():
    tables = list(paper_only(paper_numbers()))
    assert [len(table.groups) for table in tables] == [3, 3, 3, 3]
    assert [cell.text for cell in tables[3].groups[1][1].cells] == [
        "50", "w/o STP.", "21.6 (2.4)", "27.7 (1.8)", "446.1 (1.6)", "2132.8 (-17.6)", "0.4",
    ]  # fmt: skip
    assert tables[0].groups[0][7].cells[2].bold
    found = contradiction_table(paper_numbers())
    assert len(found.groups[0]) == 13
    assert "465 cells" in found.remarks[0]
