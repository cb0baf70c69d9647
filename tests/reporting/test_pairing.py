"""Which records are compared with each other, and which must not be."""

from __future__ import annotations

import pytest
from test_report import cells_of, episode, failed

from adhoc.core.errors import RecordError
from adhoc.reporting.comparisons import families
from adhoc.reporting.cost_table import cost_rows
from adhoc.reporting.ordering import orderings
from adhoc.reporting.report import make_report
from adhoc.reporting.results import Results


def rows(*records):
    return [cells_of(row)[:4] for row in make_report(Results.of(records)).blocks[0].rows]


def test_two_models_of_one_team_have_each_its_own_reference():
    a = {"team_model": "A", "team": "llm", "team_label": "LLM based"}
    b = {**a, "team_model": "B"}
    found = rows(
        episode("x", **a),
        episode("x", "IRoT", 0, "A", **a),
        failed("x", **b, episode_id="b alone"),
        failed("x", "IRoT", 0, "B", **b),
    )
    assert found == [
        ["LLM based (A)", "No ad hoc", "100.0 (-)", "100.0 (-)"],
        ["LLM based (A)", "IRoT", "100.0 (0.0)", "100.0 (0.0)"],
        ["LLM based (B)", "No ad hoc", "0.0 (-)", "50.0 (-)"],
        ["LLM based (B)", "IRoT", "0.0 (0.0)", "50.0 (0.0)"],
    ]


def test_teams_of_one_label_keep_apart():
    one, two = ({"team": name, "team_label": "H"} for name in ("h1", "h2"))
    found = rows(
        episode("x", **one),
        episode("x", "IRoT", 0, **one),
        failed("x", **two, episode_id="2"),
        failed("x", "IRoT", 0, **two, episode_id="3"),
    )
    assert [row[0] for row in found] == ["H (h1)", "H (h1)", "H (h2)", "H (h2)"]
    assert [row[2] for row in found] == ["100.0 (-)", "100.0 (0.0)", "0.0 (-)", "0.0 (0.0)"]


def test_policies_of_one_label_keep_apart_in_table_and_order():
    records = [
        failed("x"),
        episode("x", "irot", 0, "m", policy_label="IRoT"),
        failed("x", "irot_x", 0, "m", policy_label="IRoT"),
    ]
    assert [row[1] for row in rows(*records)] == ["No ad hoc", "IRoT (m) (irot)", "IRoT (m) (irot_x)"]
    (ordering,) = orderings(families(Results.of(records)))
    assert [(it.policy, it.success.mean) for it in ordering.places] == [
        ("IRoT (m) (irot)", 100.0),
        ("IRoT (m) (irot_x)", 0.0),
    ]


def test_episodes_of_different_settings_are_not_averaged():
    records = [
        episode("x"),
        episode("x", "IRoT", 0),
        episode("y"),
        episode("y", "IRoT", 0, config_hash="other"),
    ]
    with pytest.raises(RecordError, match="different settings"):
        make_report(Results.of(records))


def test_what_differs_between_settings_is_named_if_it_is_known():
    records = [episode("x"), episode("x", "IRoT", 0), episode("y"), episode("y", "IRoT", 0, config_hash="b")]
    settings = {
        "abc": {"world": {"reach": 1.5}, "max_steps": 500},
        "b": {"world": {"reach": 2.0}, "max_steps": 500},
    }
    with pytest.raises(RecordError, match=r"\(world\.reach: 1\.5 in the first, 2\.0 in the other\)"):
        Results.of(records, settings)


def test_rows_of_one_team_share_all_but_the_policy():
    records = [
        episode("x"),
        episode("x", "IRoT", 0, config_hash="b"),
        episode("x", "CoT", 0, config_hash="c"),
    ]
    world = {"world": {"reach": 1.5}}
    settings = {"abc": world, "b": {**world, "policy": {"n": 3}}, "c": {**world, "policy": {"n": 1}}}
    Results.of(records, settings)
    settings["c"] = {"world": {"reach": 2.0}, "policy": {"n": 1}}
    with pytest.raises(RecordError, match=r"'x-CoT-0-None' were run with different settings \(world\.reach"):
        Results.of(records, settings)
    Results.of(records, {"abc": world})


def test_a_newcomer_that_was_measured_against_another_episode_is_refused():
    joined = episode("x", "IRoT", 0, reference_temporal_steps=55)
    with pytest.raises(RecordError, match="a team alone of 55 steps"):
        make_report(Results.of([episode("x", temporal_steps=60), joined]))


def test_one_team_alone_twice_is_refused():
    with pytest.raises(RecordError, match="one team alone in one scenario"):
        make_report(Results.of([episode("x"), episode("x", episode_id="again")]))


def test_what_a_newcomer_costs_beside_each_team():
    llm = {"calls": 1, "prompt_tokens": 1, "completion_tokens": 1}
    records = [
        episode("x", "IRoT", 0, "gpt", team_label=team, episode_id=team, llm={**llm, "cost_usd": cost})
        for team, cost in (("Heuristic based", 1.0), ("LLM based", 9.0))
    ]
    assert {row.contestant: row.use.cost_usd for row in cost_rows(records)} == {
        "IRoT beside Heuristic based (gpt)": 1.0,
        "IRoT beside LLM based (gpt)": 9.0,
    }
