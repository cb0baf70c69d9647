"""What tables say of intervals from few houses."""

from __future__ import annotations

import re

import pytest
from test_ordering import alone, joined
from test_report import episode, failed

from adhoc.core.counting import counted
from adhoc.reporting.comparison_table import comparison_tables
from adhoc.reporting.comparisons import families
from adhoc.reporting.few_houses import few_houses
from adhoc.reporting.ordering import ordering_tables
from adhoc.reporting.paper_layout import paper_tables
from adhoc.reporting.rendering.markdown import markdown_table
from adhoc.reporting.report import make_report
from adhoc.reporting.results import Results
from adhoc.reporting.sensitivity import Setting, sensitivity, sensitivity_markdown

TOO_NARROW = "{} houses: intervals from fewer than 10 houses are too narrow (docs/statistics.md)"
NONE = "{} houses: no intervals ([?]) from fewer than 5 houses (docs/statistics.md)"


def test_enough_houses_need_no_remark():
    assert list(few_houses([10, 90])) == []


def test_several_numbers_of_houses_are_told_at_once():
    assert list(few_houses([9, 5, 12, 7, 1, 3])) == [
        TOO_NARROW.format("5 to 9"),
        NONE.format("1 to 3"),
    ]
    assert next(few_houses([1])).startswith("1 house: no")


def test_one_of_a_thing_is_singular():
    assert [counted(it, "scenario") for it in (0, 1, 2, 1200)] == [
        "0 scenarios", "1 scenario", "2 scenarios", "1,200 scenarios",
    ]  # fmt: skip


def in_houses(records, houses):
    """The same tasks, in so many houses; the last of them has all that are over."""
    return [{**it, "house_id": str(min(int(it["house_id"].split()[1]), houses - 1))} for it in records]


def every_page(houses):
    """All that shows intervals, of tasks in so many houses."""
    records = in_houses([*alone(), *joined("good", {0, 2, 3, 7, 11})], houses)
    found = families(Results.of(records))
    yield "\n".join(map(markdown_table, ordering_tables(found)))
    yield "\n".join(map(markdown_table, comparison_tables(found)))
    of_model = {"model": "m"}
    runs = {it: in_houses([*alone(), *joined("x", {1, 2, 4}, **of_model)], houses) for it in [Setting()]}
    yield sensitivity_markdown(sensitivity(runs))
    results = []
    for task in range(12):
        here = {"house_id": f"house {task}"}
        joins = episode if task % 2 else failed
        results += [failed(f"t{task}", **here), joins(f"t{task}", "x", 0, **here)]
    (table,) = paper_tables(
        make_report(Results.of(in_houses(results, houses)), intervals=True), intervals=True
    )
    yield markdown_table(table)


@pytest.mark.parametrize(
    ("houses", "remark"),
    [
        (3, NONE.format(3)),
        (4, NONE.format(4)),
        (5, TOO_NARROW.format(5)),
        (9, TOO_NARROW.format(9)),
        (10, None),
    ],
)
def test_every_table_with_intervals_goes_by_one_rule(houses, remark):
    for page in every_page(houses):
        bounds = re.findall(r"\[[-+]?\d[\d.]*, [-+]?\d[\d.]*\]", page)
        assert bool(bounds) is (houses >= 5), page
        assert (remark is None) is ("fewer than 10 houses" not in page and "no intervals" not in page)
        assert remark is None or remark in page
