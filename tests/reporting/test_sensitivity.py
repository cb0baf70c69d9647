"""Success against error rates: which runs there are, and what is made of them."""

from __future__ import annotations

import matplotlib.image
import pytest
from test_ordering import alone, joined

from adhoc.core.errors import RecordError
from adhoc.reporting.sensitivity import MISTAKES, Setting, sensitivity, sensitivity_markdown, settings
from adhoc.reporting.sensitivity_drawing import draw_sensitivity

MODEL = {"model": "offline (not a language model)"}


def runs():
    """IRoT loses one scenario with every 0.1, CoT two."""
    return {
        setting: [
            *alone(),
            *joined("IRoT", set(range(8 - round(10 * setting.rate))), **MODEL),
            *joined("CoT", set(range(8 - round(20 * setting.rate))), **MODEL),
        ]
        for setting in settings((0.0, 0.3, 0.1))
    }


def test_every_rate_of_every_kind_is_one_run_and_no_mistakes_at_all_another():
    found = settings((0.1, 0.0, 0.3, 0.1))
    assert [it.folder for it in found[:3]] == [
        "no_mistakes",
        "forget_capability-0.1",
        "forget_capability-0.3",
    ]
    assert len(found) == 1 + 2 * len(MISTAKES)
    assert Setting("ignore_reply", 0.25).overrides == [
        "llm=offline",
        "llm.forget_capability=0",
        "llm.ignore_teammate=0",
        "llm.ignore_reply=0.25",
    ]


def test_every_kind_begins_at_the_run_without_mistakes():
    found = sensitivity(runs())
    assert found.rates == (0.0, 0.1, 0.3)
    assert found.policies == ("CoT", "IRoT"), "equals stand in the order of all tables"
    assert found.alone == 0.0
    for kind in MISTAKES:
        means = [round(found.places[kind, rate, "CoT"].success.mean * 12 / 100) for rate in found.rates]
        assert means == [8, 6, 2]


def test_one_house_tells_no_interval(tmp_path):
    found = sensitivity({it: [{**record, "house_id": "h"} for record in made] for it, made in runs().items()})
    assert "| CoT | 66.7 [?] | 50.0 [?] | 16.7 [?] |" in sensitivity_markdown(found)
    draw_sensitivity(found, tmp_path / "one.png")
    assert matplotlib.image.imread(tmp_path / "one.png").std() > 0.0


def test_the_page_names_the_model():
    text = sensitivity_markdown(sensitivity(runs()))
    assert "offline (not a language model)" in text.splitlines()[0]
    assert text.count("| IRoT | 66.7 [") == len(MISTAKES)


def test_the_figure_has_a_panel_for_each_kind(tmp_path):
    draw_sensitivity(sensitivity(runs()), tmp_path / "new" / "figure.png")
    draw_sensitivity(sensitivity(runs()), tmp_path / "figure.svg")
    assert matplotlib.image.imread(tmp_path / "new" / "figure.png").shape[1] > 1000
    text = (tmp_path / "figure.svg").read_text(encoding="utf-8")
    assert "<svg" in text


@pytest.mark.parametrize(
    "extra",
    [
        [*alone(team="Learned"), *joined("IRoT", {1}, team="Learned", **MODEL)],
        joined("Naive", {1}, model="another"),
        joined("Naive", {1}, join_step=0, **MODEL),
    ],
)
def test_what_cannot_be_compared_is_an_error(extra):
    mixed = runs()
    mixed[Setting()] += extra
    with pytest.raises(RecordError, match="one team, joining step and model"):
        sensitivity(mixed)


def test_a_team_that_asks_the_model_is_no_measure():
    team = {"team": "LLM based", "model": "m"}
    with pytest.raises(RecordError, match="the team asks the model as well"):
        sensitivity({Setting(): [*alone(**team), *joined("IRoT", {1}, **team)]})


def test_runs_without_newcomers_are_an_error():
    with pytest.raises(RecordError):
        sensitivity({Setting(): alone()})
