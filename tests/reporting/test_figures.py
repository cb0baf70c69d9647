"""The figures: what they show, worked out by hand, and that they are drawn."""

from __future__ import annotations

import re
import struct

import pytest
from matplotlib.container import ErrorbarContainer
from test_report import episode, failed

from adhoc.reporting.contestants import Contestant, Team
from adhoc.reporting.figures.by_group import ABLE, GROUPINGS, UNABLE, success_by_group
from adhoc.reporting.figures.by_step import success_by_step
from adhoc.reporting.figures.drawing import draw_by_group, draw_by_step
from adhoc.reporting.figures.style import COLOURS, MARKERS, STEP_COLOURS, UNKNOWN, policy_look, whisker
from adhoc.reporting.figures.writing import write_figures
from adhoc.reporting.paper_order import POLICIES
from adhoc.reporting.report import make_report
from adhoc.reporting.results import Results
from adhoc.statistics.intervals import Interval

DIFFICULTY, ABILITY = GROUPINGS


def records(policies=("irot", "cot"), steps=(0, 50), told=True):
    """Easy tasks e0 to e3, of which the team does one, and difficult ones d0 and d1, of which it does none.
    With IRoT it does three easy and one difficult if it joins at 0, later as many as alone; with CoT none."""
    found = []
    for task in ("e0", "e1", "e2", "e3", "d0", "d1"):
        here = {"difficulty": "Easy" if task[0] == "e" else "Difficult", "house_id": task}
        found.append((episode if task == "e0" else failed)(task, newcomer=None, **here))
        able = {"newcomer": {"can_manipulate": task in ("e1", "e2", "d0")}} if told else {}
        for policy in policies:
            for step in steps:
                does = {0: ("e0", "e1", "e2", "d0")}.get(step, ("e0",)) if policy == "irot" else ()
                make = episode if task in does else failed
                found.append(make(task, policy, step, "tiny", policy_label=policy.upper(), **here, **able))
    return found


def test_success_by_step_has_every_policy_and_the_team_alone():
    ablation = failed("e0", "irot_no_evaluation", 0, "tiny", house_id="e0", difficulty="Easy")
    (found,) = success_by_step(make_report(Results.of([*records(), ablation]), intervals=True))
    assert (found.team_name, found.steps, found.houses) == ("Heuristic based", (0, 50), (6,))
    assert {it.name: {step: round(at.mean, 1) for step, at in it.points.items()} for it in found.series} == {
        "No ad hoc": {0: 16.7, 50: 16.7},
        "COT": {0: 0.0, 50: 0.0},
        "IROT": {0: 66.7, 50: 16.7},
    }


def test_success_by_difficulty_is_that_of_the_papers_policy():
    (found,) = success_by_group(Results.of(records()), [DIFFICULTY])
    assert found.policy_name == "IROT"
    assert found.groups == ("Easy", "Difficult"), "there are no medium tasks"
    assert {group: it.mean for group, it in found.alone.items()} == {"Easy": 25.0, "Difficult": 0.0}
    easy, difficult = found.points["Easy", 0], found.points["Difficult", 0]
    assert (easy.success.mean, easy.gain.mean, easy.alone, easy.improvement) == (75.0, 50.0, 25.0, 200.0)
    assert (difficult.gain.mean, difficult.improvement, difficult.episodes) == (50.0, None, 2)
    assert found.points["Easy", 50].improvement == 0.0


def test_success_by_ability_compares_each_with_the_team_alone_in_its_own_tasks():
    (found,) = success_by_group(Results.of(records()), [ABILITY])
    assert found.groups == (ABLE, UNABLE)
    assert {group: round(it.mean, 1) for group, it in found.alone.items()} == {ABLE: 0.0, UNABLE: 33.3}
    assert (found.points[ABLE, 0].gain.mean, found.points[UNABLE, 0].gain.mean) == (100.0, 0.0)


def test_records_that_do_not_tell_the_ability_are_left_out():
    assert list(success_by_group(Results.of(records(told=False)), [ABILITY])) == []


def test_without_the_papers_policy_it_is_the_last_in_its_order():
    (found,) = success_by_group(Results.of(records(policies=("cot", "random"))), [DIFFICULTY])
    assert found.policy_name == "COT"


def test_all_figures_are_drawn_name_the_model_and_are_as_wide_as_a_column(tmp_path):
    mine = records()
    report = make_report(Results.of(mine), intervals=True)
    pictures = write_figures(report, Results.of(mine), tmp_path / "figures")
    names = ["joining-step-heuristic-based", "difficulty-heuristic-based", "ability-heuristic-based"]
    assert [it.file for it in pictures] == [str(tmp_path / "figures" / name) for name in names]
    assert all("tiny" in it.title for it in pictures)
    for name in names:
        svg = (tmp_path / "figures" / f"{name}.svg").read_text()
        width = float(re.search(r'width="([\d.]+)pt"', svg)[1]) / 72.0
        assert width == pytest.approx(3.45, abs=0.01)
        head = (tmp_path / "figures" / f"{name}.png").read_bytes()[:24]
        assert head[:4] == b"\x89PNG"
        assert struct.unpack(">I", head[16:20])[0] == 1035, "300 dots an inch"
    again = write_figures(report, Results.of(mine), tmp_path / "again")
    assert [it.svg for it in again] == [it.svg for it in pictures], "equal numbers, equal files"


def texts(figure):
    shown = [text.get_text() for axes in figure.axes for text in axes.texts]
    return [figure.get_suptitle(), *shown]


def test_figures_say_what_they_show():
    report = make_report(Results.of(records()), intervals=True)
    (steps,) = success_by_step(report)
    figure = draw_by_step(steps, "tiny")
    assert texts(figure)[0].splitlines() == [
        "Success by joining step; team: Heuristic based",
        "model: tiny",
        "N = 6; bars: 95% by bootstrap over 6 houses",
        "?: interval not known: fewer than 5 houses, or all alike",
    ]
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert legend == ["No ad hoc", "COT", "IROT"]
    (groups,) = success_by_group(Results.of(records()), [DIFFICULTY])
    title, *shown = texts(draw_by_group(groups, "tiny"))
    assert "IROT by difficulty of the task" in title
    assert "lines: 95% over houses (Easy: 4, Difficult: 2)" in title.splitlines(), (
        "not those of the whole run"
    )
    assert [it for it in shown if it != "?"] == ["+200%", "+0%", "n/a", "n/a"]


def many(success, houses=6, of_newcomer=None):
    """One easy task in each house; what the team does alone, and what it does with IRoT."""
    found = []
    for number in range(houses):
        here = {"difficulty": "Easy", "house_id": f"h{number}"}
        found.append((episode if success(number) else failed)(f"t{number}", newcomer=None, **here))
        make = episode if (of_newcomer or success)(number) else failed
        found.append(make(f"t{number}", "irot", 0, "tiny", policy_label="IROT", **here))
    return found


def drawn(mine):
    """The figures, and of each axes how many question marks and whiskers it has."""
    (steps,) = success_by_step(make_report(Results.of(mine), intervals=True))
    (groups,) = success_by_group(Results.of(mine), [DIFFICULTY])
    figures = draw_by_step(steps, "tiny"), draw_by_group(groups, "tiny")
    counts = [
        (
            sum(text.get_text() == UNKNOWN for text in axes.texts),
            sum(isinstance(it, ErrorbarContainer) for it in axes.containers),
        )
        for figure in figures
        for axes in figure.axes
    ]
    return figures, counts


def test_a_mean_of_which_nothing_is_known_has_a_question_mark_and_no_whisker():
    """By step: IRoT; above: the team alone and IRoT; below: the gain. Each is one or the other."""
    _, of_one_house = drawn(many(lambda number: True, houses=1))
    assert of_one_house == [(1, 0), (2, 0), (1, 0)]
    _, of_four = drawn(many(lambda number: number < 2, houses=4, of_newcomer=lambda number: number < 3))
    assert of_four == [(1, 0), (2, 0), (1, 0)], "too few"
    _, all_alike = drawn(many(lambda number: False, of_newcomer=lambda number: True))
    assert all_alike == [(1, 0), (2, 0), (1, 0)]
    (steps, groups), known = drawn(many(lambda number: number < 2, of_newcomer=lambda number: number < 4))
    assert known == [(0, 1), (0, 2), (0, 1)]
    assert "?" not in steps.get_suptitle() + groups.get_suptitle()


@pytest.mark.parametrize(
    ("done", "least"), [((2, 2), (-10.0, 10.0)), ((0, 6), (-10.0, 100.0)), ((6, 0), (-100.0, 10.0))]
)
def test_the_axis_of_gains_reaches_at_least_ten_points_and_around_all_that_is_shown(done, least):
    alone, joined = done
    (_, groups), _ = drawn(many(lambda number: number < alone, of_newcomer=lambda number: number < joined))
    low, high = groups.axes[1].get_ylim()
    assert low < least[0]
    assert least[1] < high
    assert high - low < 2.0 * (least[1] - least[0])


def test_intervals_that_say_nothing_are_not_drawn():
    assert whisker(Interval(50.0, 40.0, 70.0)) == (10.0, 20.0)
    assert whisker(Interval(50.0, float("-inf"), float("inf"))) == (0.0, 0.0)
    assert whisker(Interval(50.0, 50.0, 50.0)) == (0.0, 0.0)
    assert whisker(Interval(50.0, 40.0, 70.0, 4)) == (0.0, 0.0)


def test_a_policy_looks_the_same_in_all_figures_and_like_no_other():
    team = Team("t", "T", None)
    looks = {policy_look(Contestant(team, policy, "", None), 3) for policy in POLICIES}
    assert len(looks) == len(POLICIES) == len(COLOURS) == len(MARKERS)


def _seen(colour: str) -> tuple[float, float, float]:
    """What a person without the receptors for long waves sees of it (Viénot, Brettel and Mollon, 1999)."""
    red, green, blue = (int(colour[at : at + 2], 16) / 255.0 for at in (1, 3, 5))
    linear = [value**2.2 for value in (red, green, blue)]
    both = 0.11238 * linear[0] + 0.88762 * linear[1]
    return (both, both, 0.00401 * linear[0] - 0.00401 * linear[1] + linear[2])


@pytest.mark.parametrize("palette", [COLOURS, STEP_COLOURS])
def test_colours_differ_for_colour_blind_readers(palette):
    seen = [_seen(it) for it in palette]
    distances = [
        sum((a - b) ** 2 for a, b in zip(one, other)) ** 0.5
        for number, one in enumerate(seen)
        for other in seen[:number]
    ]
    assert min(distances) > 0.04
