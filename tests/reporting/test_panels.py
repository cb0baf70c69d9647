"""Which columns stand side by side, and that nothing is lost in a terminal that is narrow."""

from __future__ import annotations

import io

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console
from test_ordering import alone, joined
from test_report import episode, failed

from adhoc.reporting.comparison_table import comparison_tables
from adhoc.reporting.comparisons import families
from adhoc.reporting.effort_table import effort_table
from adhoc.reporting.ordering import ordering_tables
from adhoc.reporting.paper_layout import paper_tables
from adhoc.reporting.paper_numbers import paper_numbers
from adhoc.reporting.rendering.panels import Panel, Width, panels
from adhoc.reporting.rendering.terminal import terminal_table
from adhoc.reporting.report import make_report
from adhoc.reporting.results import Results
from adhoc.reporting.table import plain_table


def result_tables():
    """Every kind of table with several columns of names and of numbers."""
    records = []
    for number in range(12):
        task, here = f"task {number}", {"house_id": f"house {number}", "team_label": "Learning based"}
        records.append(failed(task, temporal_steps=500 - number, **here))
        for policy in ("irot", "irot_no_evaluation_no_reflection"):
            made = episode if number % 3 else failed
            label = "IRoT-LLM" if policy == "irot" else "IRoT w/o Ev. & Rf."
            records.append(made(task, policy, 0, "m", policy_label=label, first_help=None, **here))
    yield from paper_tables(make_report(Results.of(records), intervals=True), True, paper_numbers())
    yield effort_table(Results.of(records))
    long = {"team": "Learning based"}
    found = families(
        Results.of(
            [*alone(**long), *joined("IRoT w/o Ev. & Rf.", {0, 1}, **long), *joined("CoT", {3}, **long)]
        )
    )
    yield from ordering_tables(found)
    yield from comparison_tables(found)


def printed(table, width):
    console = Console(width=width, file=io.StringIO(), markup=False)
    console.print(terminal_table(table), crop=False)
    return console.file.getvalue()


@pytest.mark.parametrize("width", [60, 80, 100])
@pytest.mark.parametrize("table", list(result_tables()), ids=lambda it: it.key)
def test_every_name_and_number_is_printed_whole(table, width):
    text = printed(table, width)
    assert "…" not in text
    assert max(map(len, text.splitlines())) <= width
    words = set(text.split())
    for row in (row for group in table.groups for row in group):
        for column, cell in zip(table.columns, row.cells):
            if column.is_name:
                assert set(cell.text.split()) <= words
            for number in (cell.text, cell.below):
                assert column.is_name or number in text, "in one piece"
    for column in table.columns:
        assert set(column.heading.split()) <= words


@pytest.mark.parametrize("table", list(result_tables()), ids=lambda it: it.key)
def test_a_wide_terminal_has_one_panel_and_every_name_on_one_line(table):
    text = printed(table, 200)
    assert text.count("───\n") == 1
    for row in (row for group in table.groups for row in group):
        assert all(cell.text in text for cell in row.cells)


def test_a_console_that_is_too_narrow_for_anything_is_overrun_and_cuts_nothing():
    text = printed(
        plain_table("t", "T", ["Team", "%Suc", "N"], 1, [[["somebody", "12345678901234", "5"]]]), 10
    )
    assert "somebody" in text
    assert "12345678901234" in text


def test_names_stand_in_every_panel():
    columns = [Width(10, 10, True), *[Width(10, 10, False)] * 3]
    assert panels(columns, 32, 1) == [Panel((0, 1, 2), (10, 10, 10)), Panel((0, 3), (10, 10))]


def test_names_are_broken_only_where_that_spares_a_panel():
    names, number = Width.of("Team", ["Heuristic based"], True), Width(10, 10, False)
    assert (names.full, names.least) == (15, 9)
    assert panels([names, number, number], 36, 1) == [Panel((0, 1, 2), (14, 10, 10))]
    assert panels([names, *[number] * 3], 37, 1) == [
        Panel((0, 1, 2), (15, 10, 10)),
        Panel((0, 3), (15, 10)),
    ]


widths = st.builds(Width.of, st.just("a b"), st.lists(st.text("x ", max_size=40), max_size=3), st.booleans())


@given(st.lists(widths, min_size=1, max_size=12), st.integers(5, 120), st.integers(1, 4))
def test_every_column_stands_once_and_the_names_in_all_panels(columns, room, gap):
    found = panels(columns, room, gap)
    names = next((at for at, it in enumerate(columns) if not it.is_name), len(columns))
    told = [at for panel in found for at in panel.columns[names:]]
    assert told == list(range(names, len(columns)))
    for panel in found:
        assert panel.columns[:names] == tuple(range(names))
        assert all(columns[at].least <= it <= columns[at].full for at, it in zip(panel.columns, panel.widths))
        is_within = sum(panel.widths) + gap * (len(panel.widths) - 1) <= room
        assert is_within or all(columns[at].least == it for at, it in zip(panel.columns, panel.widths))
