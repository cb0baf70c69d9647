"""Who succeeds more often than whom, and what the episodes allow to say about it."""

from __future__ import annotations

from adhoc.reporting.comparison_table import comparison_tables
from adhoc.reporting.comparisons import families
from adhoc.reporting.ordering import ordering_tables, orderings, told
from adhoc.reporting.power_table import power_tables
from adhoc.reporting.rendering.markdown import markdown_table
from adhoc.reporting.results import Results
from adhoc.statistics.intervals import Interval

HOUSES = [f"house {number}" for number in range(12)]


def record(policy, house, success, join_step=50, team="Heuristic based", model=None):
    return {
        "team": team,
        "team_label": team,
        "task_id": f"task in {house}",
        "house_id": house,
        "scenario_hash": house,
        "max_steps": 500,
        "policy": policy,
        "policy_label": policy,
        "model": model,
        "join_step": join_step,
        "success": success,
        "config_hash": "x",
        "team_model": model if policy == "none" or team == "LLM based" else None,
    }


def alone(success=False, **options):
    return [record("none", house, success, None, **options) for house in HOUSES]


def joined(policy, succeeds, **options):
    return [record(policy, house, number in succeeds, **options) for number, house in enumerate(HOUSES)]


def test_the_most_successful_comes_first_with_its_paired_differences():
    records = [*alone(), *joined("poor", {0}), *joined("good", {0, 1, 2, 3, 4, 5})]
    (ordering,) = orderings(families(Results.of(records)))
    good, poor = ordering.places
    assert (good.policy, poor.policy) == ("good", "poor")
    assert good.success.mean == good.over_alone.mean == 50.0
    assert good.over_best is None
    assert poor.over_best is not None
    assert round(poor.over_best.mean, 1) == -41.7
    assert good.over_alone.excludes_zero
    assert poor.over_best.excludes_zero
    assert not poor.over_alone.excludes_zero


def test_equal_policies_are_not_told_apart():
    records = [*alone(), *joined("a", {0, 1}), *joined("b", {2, 3})]
    (ordering,) = orderings(families(Results.of(records)))
    assert [it.policy for it in ordering.places] == ["a", "b"]
    assert not ordering.places[1].over_best.excludes_zero


def test_teams_and_joining_steps_are_ordered_each_for_itself():
    records = [
        *alone(),
        *alone(team="LLM based", model="m"),
        *joined("a", {0}, join_step=100),
        *joined("a", {0}, team="LLM based", model="m"),
        *joined("a", {0}),
    ]
    assert [(it.join_step, it.team) for it in orderings(families(Results.of(records)))] == [
        (50, "Heuristic based"),
        (50, "LLM based"),
        (100, "Heuristic based"),
    ]
    assert [sum(map(len, it.groups)) for it in ordering_tables(families(Results.of(records)))] == [2, 1]


def test_teams_stand_in_the_same_order_in_all_tables():
    """The records begin with the paper's last team."""
    teams = ("llm", "mine", "learned", "heuristic")
    records = [it for team in teams for it in (*alone(team=team), *joined("a", {0}, team=team))]
    found = families(Results.of(records))
    for table in (*ordering_tables(found), *comparison_tables(found), *power_tables(found)):
        assert [group[0].cells[0].text for group in table.groups] == ["heuristic", "learned", "llm", "mine"]


def test_only_shared_scenarios_are_compared():
    records = [*alone(), *joined("a", set(range(12))), *joined("b", {0, 1})[:2]]
    (ordering,) = orderings(families(Results.of(records)))
    assert ordering.places[1].over_best.mean == 0.0
    assert ordering.places[1].episodes == 2


def test_a_policy_has_its_model_in_its_name_only_where_two_are_told_apart_in_one_team():
    records = [
        *alone(),
        *alone(team="LLM based", model="m"),
        *joined("Random", {0}),
        *joined("Random", {0}, team="LLM based", model="m"),
    ]
    assert [it.places[0].policy for it in orderings(families(Results.of(records)))] == ["Random", "Random"]


def page(records):
    return "\n".join(map(markdown_table, ordering_tables(families(Results.of(records)))))


def test_the_page_marks_what_is_beyond_chance():
    text = page([*alone(), *joined("good", {0, 1, 2, 3, 4, 5})])
    assert "| Heuristic based | good | 50.0 [" in text
    assert "]* | - | 12 |" in text
    assert page(alone()) == ""


def test_five_houses_are_never_beyond_chance_whatever_the_interval_says():
    text = page([*alone(), *joined("good", {0, 1, 2, 3, 4})])
    assert "good" in text
    assert "]*" not in text


def test_many_comparisons_take_the_mark_from_one_that_had_it_alone():
    """Six wins of six have p = 0.03, and three times that among three comparisons."""
    text = page([*alone(), *joined("good", {0, 1, 2, 3, 4, 5}), *joined("poor", {0, 1})])
    assert "]*" not in text


def test_how_a_number_is_told():
    assert told(Interval(12.34, -1.0, 20.0), True) == "+12.3 [-1.0, +20.0]"
    assert told(Interval(12.34, -0.04, 20.0), True, star=True) == "+12.3 [+0.0, +20.0]*"
    assert told(Interval(50.0, 40.0, 60.0), False) == "50.0 [40.0, 60.0]"
    assert told(Interval(50.0, 40.0, 60.0, houses=5), False) == "50.0 [40.0, 60.0]"
    assert told(Interval(50.0, 40.0, 60.0, houses=4), False) == "50.0 [?]"
    assert told(Interval(50.0, 50.0, 50.0), False) == "50.0 [?]"
    assert told(Interval(50.0, float("-inf"), float("inf")), False) == "50.0 [?]"
