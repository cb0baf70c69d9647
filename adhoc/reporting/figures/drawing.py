"""Drawing the figures; each is as wide as a column."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from adhoc.reporting.figures.by_group import GroupPoint, SuccessByGroup
from adhoc.reporting.figures.by_step import Series, SuccessByStep
from adhoc.reporting.figures.style import (
    ALONE_COLOUR,
    COLUMN_WIDTH,
    STEP_COLOURS,
    policy_look,
    put_title,
    tidy,
    whisker,
)
from adhoc.statistics.intervals import LEVEL, Interval

ROOM = 0.86
"""The share of the room of a joining step or a group that is drawn in."""
SHORT = 3
"""Characters of a number that has room beside others."""


def draw_by_step(found: SuccessByStep, model: str) -> Figure:
    """Success of all policies by joining step, side by side, each with its interval."""
    figure = _figure(2.75)
    axes = figure.subplots()
    alone = [it for it in found.series if it.who is None]
    for series in alone:
        means = [series.points[step].mean if step in series.points else float("nan") for step in found.steps]
        edges = [-0.5, *(number + 0.5 for number in range(len(found.steps)))]
        axes.stairs(
            means, edges, baseline=None, color=ALONE_COLOUR, linestyle="--", linewidth=1.0, label=series.name
        )
    policies = [it for it in found.series if it.who is not None]
    for number, series in enumerate(policies):
        shift = ROOM * ((number + 0.5) / len(policies) - 0.5)
        _draw_policy(axes, series, found.steps, shift, number)
    axes.set_xticks(range(len(found.steps)), [str(step) for step in found.steps])
    axes.set_xlim(-0.5, len(found.steps) - 0.5)
    axes.set_ylim(0.0, _top(it for series in found.series for it in series.points.values()))
    axes.set_xlabel("step at which the ad hoc robot joins")
    axes.set_ylabel("%Suc")
    tidy(axes)
    figure.legend(loc="outside lower center", ncols=4, frameon=False, handletextpad=0.3, columnspacing=0.9)
    put_title(
        figure,
        f"Success by joining step; team: {found.team_name}",
        f"model: {model}",
        f"N = {' or '.join(map(str, found.episodes))}; bars: {LEVEL:.0%} by bootstrap over "
        f"{found.houses} houses",
    )
    return figure


def draw_by_group(found: SuccessByGroup, model: str) -> Figure:
    """Above, success of the team alone and with the newcomer; below, how many points that is more and, as
    numbers, percent of the team's own."""
    figure = _figure(3.35)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.25, 1.0))
    width = ROOM / (1 + len(found.steps))
    for place, group in enumerate(found.groups):
        _draw_bar(
            upper,
            place - 0.5 * ROOM + 0.5 * width,
            found.alone[group],
            width,
            ALONE_COLOUR,
            place,
            "team alone",
        )
        for number, step in enumerate(found.steps):
            point = found.points.get((group, step))
            if point is not None:
                at = place - 0.5 * ROOM + (number + 1.5) * width
                colour = STEP_COLOURS[number % len(STEP_COLOURS)]
                _draw_bar(upper, at, point.success, width, colour, place, f"joins at {step}")
                _draw_gain(lower, at, point, colour, raised=number % 2 == 1)
    lower.axhline(0.0, color=ALONE_COLOUR, linewidth=0.8, linestyle="--", zorder=1)
    numbers = [f"{group}\nN = {_episodes(found, group)}" for group in found.groups]
    lower.set_xticks(range(len(found.groups)), numbers)
    lower.set_xlim(-0.55, len(found.groups) - 0.45)
    upper.set_ylabel("%Suc")
    lower.set_ylabel("points over\nthe team alone")
    upper.set_ylim(0.0, _top([*found.alone.values(), *(it.success for it in found.points.values())]))
    lower.margins(y=0.24)
    for axes in (upper, lower):
        tidy(axes)
    figure.align_ylabels()
    handles, names = upper.get_legend_handles_labels()
    shown = dict(zip(names, handles))
    figure.legend(
        shown.values(), shown.keys(), loc="outside lower center", ncols=4, frameon=False, handlelength=1.0,
        handletextpad=0.4, columnspacing=1.0,
    )  # fmt: skip
    put_title(
        figure,
        f"{found.policy_name} {found.grouping.title}; team: {found.team_name}",
        f"model: {model}",
        f"lines: {LEVEL:.0%} over {found.houses} houses; numbers: percent of the team's own",
    )
    return figure


def _figure(height: float) -> Figure:
    figure = Figure(figsize=(COLUMN_WIDTH, height), facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def _draw_policy(axes: Axes, series: Series, steps: Sequence[int], shift: float, number: int) -> None:
    assert series.who is not None
    colour, marker = policy_look(series.who, number)
    shown = [
        (place + shift, series.points[step]) for place, step in enumerate(steps) if step in series.points
    ]
    below, above = zip(*(whisker(it) for _, it in shown))
    axes.errorbar(
        [at for at, _ in shown],
        [it.mean for _, it in shown],
        yerr=(below, above),
        color=colour,
        marker=marker,
        markersize=3.6,
        linestyle="none",
        elinewidth=0.8,
        label=series.name,
    )


def _draw_bar(
    axes: Axes, at: float, interval: Interval, width: float, colour: str, place: int, name: str
) -> None:
    below, above = whisker(interval)
    axes.bar(at, interval.mean, 0.92 * width, color=colour, label=name if place == 0 else None)
    axes.errorbar(at, interval.mean, yerr=([below], [above]), color="#1b1f24", elinewidth=0.8, capsize=1.6)


def _draw_gain(axes: Axes, at: float, point: GroupPoint, colour: str, raised: bool) -> None:
    """A long number beside a long one stands higher, if `raised`, since a column has no room for both."""
    below, above = whisker(point.gain)
    axes.errorbar(
        at,
        point.gain.mean,
        yerr=([below], [above]),
        color=colour,
        ecolor="#3c434b",
        elinewidth=1.0,
        marker="o",
        markersize=3.8,
        markeredgecolor="#1b1f24",
        markeredgewidth=0.4,
    )
    told = "n/a" if point.improvement is None else f"{point.improvement:+.0f}"
    offset = (0.0, 8.0 if raised and len(told) > SHORT else 1.5)
    place = (at, point.gain.mean + above)
    axes.annotate(told, place, offset, textcoords="offset points", ha="center", va="bottom", fontsize=6.0)


def _episodes(found: SuccessByGroup, group: str) -> str:
    numbers = sorted({it.episodes for (name, _), it in found.points.items() if name == group})
    return " or ".join(map(str, numbers))


def _top(intervals: Iterable[Interval]) -> float:
    highest = max(it.mean + whisker(it)[1] for it in intervals)
    return max(10.0, min(104.0, 1.08 * highest))
