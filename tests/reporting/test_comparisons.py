"""Every policy against the team alone and against every other, on the same scenarios."""

from __future__ import annotations

import math

import pytest
from test_ordering import alone, joined, record

from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.contender import ALONE
from adhoc.reporting.comparison_table import comparison_tables, p_text
from adhoc.reporting.comparisons import Scope, families
from adhoc.reporting.power_table import power_tables
from adhoc.reporting.rendering.markdown import markdown_table
from adhoc.reporting.results import Results

RECORDS = [
    *alone(),
    *joined("a", {0, 1, 2, 3, 4, 5, 6, 7}),
    *joined("b", {0, 8}),
]


def rows(sections):
    lines = "\n".join(map(markdown_table, sections)).splitlines()
    cells = ([cell.strip() for cell in line.strip("|").split("|")] for line in lines)
    return [row for row in cells if len(row) == 9 and row[4][0].isdigit()]


def power_rows(found, **options):
    text = "\n".join(map(markdown_table, power_tables(found, **options)))
    return {
        (cells[1], cells[2]): cells[3:]
        for cells in ([it.strip() for it in line.strip("|").split("|")] for line in text.splitlines())
        if len(cells) == 9 and cells[1] in ("a", "b")
    }


def test_all_against_the_team_alone_and_then_every_pair():
    (family,) = families(Results.of(RECORDS))
    assert [(it.policy, it.against) for it in family.comparisons] == [("a", ALONE), ("b", ALONE), ("a", "b")]
    assert [(it.test.wins, it.test.losses) for it in family.comparisons] == [(8, 0), (2, 0), (7, 1)]
    assert [round(it.points.mean, 1) for it in family.comparisons] == [66.7, 16.7, 50.0]


def test_p_values_are_corrected_for_all_of_the_family():
    """2/256 of three, 2 x 9/256 of two, and 1/2."""
    (family,) = families(Results.of(RECORDS))
    assert [it.test.p_houses for it in family.comparisons] == pytest.approx([2 / 256, 0.5, 18 / 256])
    assert [it.p_adjusted for it in family.comparisons] == pytest.approx([6 / 256, 0.5, 36 / 256])
    assert [it.beyond_chance for it in family.comparisons] == [True, False, False]
    assert {it.family_size for it in family.comparisons} == {3}


def test_the_whole_report_may_be_one_family():
    records = [*RECORDS, *joined("a", set(), join_step=100)]
    here, later = families(Results.of(records))
    assert (here.comparisons[0].family_size, later.comparisons[0].family_size) == (3, 1)
    assert here.comparisons[0].p_adjusted == pytest.approx(6 / 256)
    here, later = families(Results.of(records), Scope.REPORT)
    assert {it.family_size for it in (*here.comparisons, *later.comparisons)} == {4}
    assert here.comparisons[0].p_adjusted == pytest.approx(8 / 256)


def test_tasks_of_one_house_are_not_independent():
    """Twelve wins in two houses: McNemar's test would be sure, houses say nothing."""
    houses = ["x"] * 6 + ["y"] * 6
    records = [
        {**it, "house_id": house}
        for made in (alone(), joined("a", set(range(12))))
        for it, house in zip(made, houses)
    ]
    (comparison,) = families(Results.of(records))[0].comparisons
    assert comparison.test.p_episodes == 2 / 4096
    assert comparison.test.p_houses == comparison.p_adjusted == 0.5
    assert not comparison.beyond_chance


def test_a_comparison_can_be_seen_from_the_other_side():
    (family,) = families(Results.of(RECORDS))
    there, back = family.between("a", "b"), family.between("b", "a")
    assert (back.test.wins, back.test.losses) == (1, 7)
    assert (back.points.low, back.points.mean) == (-there.points.high, -there.points.mean)
    assert (back.p_adjusted, back.pilot.difference) == (there.p_adjusted, -there.pilot.difference)
    assert family.between("a", "nobody") is None


def test_policies_without_a_common_scenario_are_not_compared():
    (family,) = families(Results.of([*alone(), *joined("a", {0})[:6], *joined("b", {7})[6:]]))
    assert [(it.policy, it.against) for it in family.comparisons] == [("a", ALONE), ("b", ALONE)]


def test_the_table_holds_every_pair_or_those_that_may_be_no_chance():
    found = families(Results.of([*RECORDS, *joined("c", {0, 1, 2, 3, 4, 5, 8, 9})]))
    every, some = (rows(comparison_tables(found, every_pair)) for every_pair in (True, False))
    assert [cells[1:3] for cells in every] == [
        ["a", ALONE],
        ["c", ALONE],
        ["b", ALONE],
        ["a", "c"],
        ["a", "b"],
        ["c", "b"],
    ]
    assert [cells[1:3] for cells in some] == [["a", ALONE], ["c", ALONE], ["b", ALONE], ["c", "b"]]
    assert some[0][4:] == ["8 : 0", "0.008", "0.008", "0.047", "12 (12)"]
    assert some[0][3].endswith("]*")
    (table,) = comparison_tables(found, every_pair=False)
    assert any(it.startswith("2 pairs with p by houses over 0.05 are not shown") for it in table.remarks)


def test_p_values_are_told_with_three_digits():
    assert [p_text(it) for it in (1.0, 0.0123, 0.0009)] == ["1.000", "0.012", "<0.001"]


def test_how_many_tasks_the_observed_difference_needs():
    """8 of 12 tasks, all won: Connor's formula with 2/3 and 2/3 gives 9.4, and 1.5 for whole tasks."""
    told = power_rows(families(Results.of(RECORDS)))
    points, differ, deff, tasks, in_family, _ = told["a", ALONE]
    assert (points, differ, deff, tasks) == ("+66.7", "66.7%", "1.00", "11 (11)")
    assert in_family == "14 (14)"  # at 5% / 3
    assert power_rows(families(Results.of([*alone(), *joined("a", set())])))["a", ALONE][3:5] == ["-", "-"]


def test_how_many_tasks_a_given_difference_needs():
    told = power_rows(families(Results.of(RECORDS)), points=20.0)
    assert told["b", ALONE][1:4] == ["16.7%", "1.00", "42 (42)*"]
    assert int(told["a", ALONE][3].split()[0]) > 42


def test_numbers_for_which_disagreement_was_assumed_are_marked_and_explained():
    """Of 12 tasks, a differs from the team alone in 8, b in 2 and c in none; 20 points need 2.4."""
    found = families(Results.of([*RECORDS, *joined("c", set())]))
    lower_bound = "the least possible was assumed, so this is a lower bound"
    (table,) = power_tables(found, 20.0)
    cells = {row.cells[1].text: [it.text for it in row.cells[4:]] for row in table.groups[0][:3]}
    assert cells["a"][0] == "66.7%"
    assert not any(it.endswith("*") for it in cells["a"])
    assert cells["c"][0] == "0.0%"
    assert all(it.endswith("*") for it in (*cells["b"][2:], *cells["c"][2:])), "told now, too"
    assert lower_bound in table.remarks[-1]
    (table,) = power_tables(families(Results.of([*alone(), *joined("a", {0, 1, 2, 3, 4, 5, 6, 7})])), 20.0)
    assert not any(lower_bound in it for it in table.remarks)


@pytest.mark.parametrize("points", [0.0, -5.0, 101.0, math.nan])
def test_a_difference_that_is_none_is_an_error(points):
    with pytest.raises(ConfigurationError, match="above 0 and at most 100"):
        list(power_tables(families(Results.of(RECORDS)), points))


def test_one_house_tells_how_to_say_so():
    records = [record("none", "h", False, None), record("a", "h", True)]
    assert rows(comparison_tables(families(Results.of(records))))[0][3:] == [
        "+100.0 [?]",
        "1 : 0",
        "1.000",
        "1.000",
        "1.000",
        "1 (1)",
    ]
    assert power_rows(families(Results.of(records)))["a", ALONE][2:] == ["?", "-", "-", "none"]
