"""Drawing the figures; each is as wide as a column."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from adhoc.reporting.figures.by_group import GroupPoint, SuccessByGroup
from adhoc.reporting.figures.by_step import Series, SuccessByStep
from adhoc.reporting.figures.style import (
    ALONE_COLOUR,
    COLUMN_WIDTH,
    INK,
    STEP_COLOURS,
    UNKNOWN,
    policy_look,
    put_title,
    put_unknown,
    tidy,
    whisker,
)
from adhoc.statistics.intervals import LEAST_HOUSES, LEVEL, Interval

ROOM = 0.86
"""The share of the room of a joining step or a group that is drawn in."""
LEAST_POINTS = 10.0
"""So far the axis of gains reaches at least; without that, noise fills it where nothing differs."""


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
        f"{' or '.join(map(str, found.houses))} {'house' if found.houses == (1,) else 'houses'}",
        *_unknown(it for series in policies for it in series.points.values()),
    )
    return figure


def draw_by_group(found: SuccessByGroup, model: str) -> Figure:
    """Above, success of the team alone and with the newcomer; below, how many points that is more and, as
    numbers with a percent sign, how much of the team's own."""
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
    lower.set_ylim(*_around_zero([it.gain for it in found.points.values()]))
    for axes in (upper, lower):
        tidy(axes)
    figure.align_ylabels()
    houses = ", ".join(f"{group}: {number}" for group, number in found.houses.items())
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
        f"lines: {LEVEL:.0%} over houses ({houses})",
        "numbers with %: of the team's own success",
        *_unknown(
            [*found.alone.values(), *(one for it in found.points.values() for one in (it.success, it.gain))]
        ),
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
    axes.plot(
        [at for at, _ in shown],
        [it.mean for _, it in shown],
        marker=marker,
        markersize=3.6,
        label=series.name,
        color=colour,
        linestyle="none",
    )
    for at, interval in shown:
        _draw_whisker(axes, at, interval, colour)
        put_unknown(axes, at, interval, (0.0, 6.0))


def _draw_bar(
    axes: Axes, at: float, interval: Interval, width: float, colour: str, place: int, name: str
) -> None:
    axes.bar(at, interval.mean, 0.92 * width, color=colour, label=name if place == 0 else None)
    _draw_whisker(axes, at, interval, INK, capsize=1.6)
    put_unknown(axes, at, interval, (0.0, 5.0))


def _draw_gain(axes: Axes, at: float, point: GroupPoint, colour: str, raised: bool) -> None:
    """The numbers stand above all whiskers, every other one higher (`raised`), since a column has no room
    for two side by side."""
    _draw_whisker(axes, at, point.gain, "#3c434b")
    axes.plot(
        at,
        point.gain.mean,
        color=colour,
        marker="o",
        markersize=3.8,
        markeredgecolor=INK,
        markeredgewidth=0.4,
    )
    put_unknown(axes, at, point.gain, (0.0, -7.0))
    told = "n/a" if point.improvement is None else f"{point.improvement:+.0f}%"
    place = (at, 0.94 if raised else 0.82)
    axes.annotate(told, place, xycoords=axes.get_xaxis_transform(), ha="center", fontsize=6.0)


def _draw_whisker(axes: Axes, at: float, interval: Interval, colour: str, capsize: float = 0.0) -> None:
    if interval.tells_spread:
        below, above = whisker(interval)
        axes.errorbar(
            at,
            interval.mean,
            yerr=([below], [above]),
            fmt="none",
            ecolor=colour,
            elinewidth=0.8,
            capsize=capsize,
        )


def _unknown(intervals: Iterable[Interval]) -> Iterator[str]:
    if not all(it.tells_spread for it in intervals):
        yield f"{UNKNOWN}: interval not known: fewer than {LEAST_HOUSES} houses, or all alike"


def _episodes(found: SuccessByGroup, group: str) -> str:
    numbers = sorted({it.episodes for (name, _), it in found.points.items() if name == group})
    return " or ".join(map(str, numbers))


def _top(intervals: Iterable[Interval]) -> float:
    shown = list(intervals)
    highest = max(it.mean + whisker(it)[1] for it in shown)
    room = 1.08 if all(it.tells_spread for it in shown) else 1.16
    return max(10.0, min(100.0 * room - 4.0, room * highest))


def _around_zero(gains: Sequence[Interval]) -> tuple[float, float]:
    """Limits that hold all gains with their numbers, and never less than `LEAST_POINTS` up and down."""
    reaches = [(it, *whisker(it)) for it in gains]
    low = min(-LEAST_POINTS, *(it.mean - below for it, below, _ in reaches))
    high = max(LEAST_POINTS, *(it.mean + above for it, _, above in reaches))
    return low - 0.2 * (high - low), high + 0.42 * (high - low)
