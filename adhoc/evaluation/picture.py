"""One episode from above, as a PNG: where the robots went, and what became of the misplaced objects."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from adhoc.core.geometry import planar_distance
from adhoc.core.whole_file import write_whole
from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.floor_drawing import draw_house
from adhoc.evaluation.floor_shapes import MARGIN
from adhoc.evaluation.palette import MISPLACED, NEWCOMER, OUTLINE, REPLACED, REPLACED_FACE, robot_colour
from adhoc.evaluation.records import Record, writing
from adhoc.evaluation.trace import Trace, TraceEvent

SPREAD = 0.035
"""Metres between paths along the same cells, so that none hides another."""
CROWDED = 1.2
"""Metres between objects whose names would overlap."""
DPI = 110
WIDTH, TITLE, LEGEND = 9.0, 0.75, 0.72
"""Inches: of the picture, of the title above the floor plan, and of the legend below it."""


def draw_episode(result: EpisodeResult, record: Record, path: Path) -> None:
    """Draw one episode into `path`: rooms, furniture, the robots' paths (the newcomer's white with a dark
    outline, as in the paper), starts, the joining point, and misplaced objects with what became of them.

    Creates the folder. Overwrites the file.
    """
    house = result.scenario.house
    plan_height = WIDTH * _height_over_width(result)
    height = TITLE + plan_height + LEGEND
    figure = Figure(figsize=(WIDTH, height), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.02, LEGEND / height, 0.96, plan_height / height))
    draw_house(axes, house)
    for position, name in enumerate(result.trace.agents):
        _draw_path(axes, result, name, position)
    labelled: list[tuple[float, float]] = []
    for displacement in result.scenario.misplaced:
        _draw_object(axes, result, displacement.object_id, labelled)
    _draw_titles(figure, record, height)
    figure.legend(
        handles=_legend(result),
        loc="lower center",
        ncols=4,
        fontsize=8,
        frameon=False,
        handlelength=2.4,
        columnspacing=1.6,
    )
    content = BytesIO()
    figure.savefig(content, format="png", dpi=DPI)
    with writing(path):
        write_whole(path, content.getvalue())


def _height_over_width(result: EpisodeResult) -> float:
    corners = [corner for room in result.scenario.house.rooms for corner in room.polygon]
    width = max(x for x, _ in corners) - min(x for x, _ in corners)
    height = max(y for _, y in corners) - min(y for _, y in corners)
    return min(1.4, max(0.3, (height + 2 * MARGIN) / (width + 2 * MARGIN)))


def _draw_path(axes: Axes, result: EpisodeResult, name: str, position: int) -> None:
    is_newcomer = name == result.scenario.newcomer.name
    shift = SPREAD * (position - (len(result.trace.agents) - 1) / 2)
    places = [
        (step.poses[name].x + shift, step.poses[name].y + shift)
        for step in result.trace.steps
        if name in step.poses
    ]
    if is_newcomer and result.joined_at is not None:
        places.insert(0, (result.joined_at.x + shift, result.joined_at.y + shift))
    if not places:
        return
    xs, ys = zip(*places)
    colour = _colour(result, name)
    outline = [withStroke(linewidth=4.4, foreground=OUTLINE)] if is_newcomer else []
    width, order = (2.4, 6.0) if is_newcomer else (1.7, 5.0)
    axes.plot(
        xs,
        ys,
        color=colour,
        linewidth=width,
        solid_joinstyle="round",
        solid_capstyle="round",
        alpha=1.0 if is_newcomer else 0.9,
        path_effects=outline,
        zorder=order,
    )
    marker, size = ("*", 17) if is_newcomer else ("o", 8)
    axes.plot(xs[0], ys[0], marker, color=colour, markersize=size, markeredgecolor=OUTLINE, zorder=8)
    axes.plot(xs[-1], ys[-1], "s", color=colour, markersize=5.5, markeredgecolor=OUTLINE, zorder=8)
    if is_newcomer:
        _label(axes, f"joins at step {result.join_step}", (xs[0], ys[0]), OUTLINE)


def _draw_object(
    axes: Axes, result: EpisodeResult, object_id: str, labelled: list[tuple[float, float]]
) -> None:
    """A cross where the object was misplaced, an arrow to where it is, a ring there if it is in place.

    Its name goes below the cross where names of objects nearby (`labelled`) are above theirs.
    """
    trace = result.trace
    start, end = trace.objects_before[object_id].position[:2], trace.objects_after[object_id].position[:2]
    is_replaced = object_id in result.replaced
    axes.plot(*start, "x", color=MISPLACED, markersize=9, markeredgewidth=2.6, zorder=9)
    text = trace.objects_before[object_id].category
    if start != end:
        colour = REPLACED if is_replaced else MISPLACED
        axes.annotate(
            "",
            end,
            start,
            arrowprops={
                "arrowstyle": "-|>",
                "color": colour,
                "linestyle": (0, (3, 2)),
                "linewidth": 1.2,
                "connectionstyle": "arc3,rad=0.15",
                "shrinkA": 5,
                "shrinkB": 5,
            },
            zorder=8.5,
        )
    if is_replaced:
        axes.plot(
            *end,
            "o",
            markerfacecolor=REPLACED_FACE,
            markeredgecolor=REPLACED,
            markersize=12,
            markeredgewidth=1.8,
            zorder=9,
        )
        axes.plot(*end, marker="$✓$", color=REPLACED, markersize=7, zorder=9.1)
        event = _last_replacement(trace, object_id)
        text += f" (step {event.step})" if event else ""
    near = sum(planar_distance(start, other) < CROWDED for other in labelled)
    labelled.append(start)
    _label(axes, text, start, MISPLACED, 7 if near == 0 else 4 - 12 * near)


def _last_replacement(trace: Trace, object_id: str) -> TraceEvent | None:
    found = [event for event in trace.events if event.kind == "replaced" and event.object_id == object_id]
    return found[-1] if found else None


def _label(axes: Axes, text: str, place: tuple[float, float], colour: str, rise: float = 7) -> None:
    """Text beside a place, on the side where there is room for it."""
    left, right = axes.get_xlim()
    on_left = place[0] > left + 0.8 * (right - left)
    axes.annotate(
        text,
        place,
        xytext=(-8 if on_left else 8, rise),
        textcoords="offset points",
        ha="right" if on_left else "left",
        fontsize=7.5,
        color=colour,
        fontweight="bold",
        path_effects=[withStroke(linewidth=2.6, foreground="white")],
        zorder=10,
    )


def _draw_titles(figure: Figure, record: Record, height: float) -> None:
    joins = "" if record["join_step"] is None else f", joining at step {record['join_step']}"
    outcome = "success" if record["success"] else record["ending"]
    model = record["model"] or "none"
    figure.text(
        0.02,
        1 - 0.36 / height,
        f"{record['task_id']}: {record['team_label']} team, {record['policy_label']}{joins}",
        fontsize=12,
        fontweight="bold",
        color="#1f2328",
    )
    figure.text(
        0.02,
        1 - 0.6 / height,
        f"{outcome} after {record['steps']} steps, {record['replaced']} of {record['misplaced']} objects "
        f"re-placed; language model: {model}",
        fontsize=9,
        color=REPLACED if record["success"] else MISPLACED,
    )


def _legend(result: EpisodeResult) -> list[Line2D]:
    return [
        *(_path_handle(result, name) for name in result.trace.agents),
        _mark_handle("o", "#cccccc", OUTLINE, "start"),
        _mark_handle("s", "#cccccc", OUTLINE, "end"),
        _mark_handle("x", MISPLACED, MISPLACED, "misplaced object"),
        _mark_handle("o", REPLACED_FACE, REPLACED, "re-placed"),
    ]


def _path_handle(result: EpisodeResult, name: str) -> Line2D:
    handle = Line2D([], [], color=_colour(result, name), linewidth=2.4, label=_who(result, name))
    if name == result.scenario.newcomer.name:
        handle.set_path_effects([withStroke(linewidth=4.4, foreground=OUTLINE)])
    return handle


def _mark_handle(marker: str, colour: str, edge: str, label: str) -> Line2D:
    return Line2D(
        [],
        [],
        marker=marker,
        color=colour,
        markeredgecolor=edge,
        markeredgewidth=1.6,
        markersize=8,
        linestyle="none",
        label=label,
    )


def _who(result: EpisodeResult, name: str) -> str:
    members = {member.name: member for member in (*result.scenario.team, result.scenario.newcomer)}
    able = "manipulates" if members[name].capability.can_manipulate else "no hand"
    return f"{name.replace('_', ' ')} ({able})"


def _colour(result: EpisodeResult, name: str) -> str:
    if name == result.scenario.newcomer.name:
        return NEWCOMER
    return robot_colour(result.trace.agents.index(name))
