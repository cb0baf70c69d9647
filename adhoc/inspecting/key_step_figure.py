"""Key steps of several episodes of one task, in the style of the paper's qualitative figure."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from adhoc.core.whole_file import write_whole
from adhoc.evaluation.floor_drawing import draw_house
from adhoc.evaluation.floor_shapes import MARGIN
from adhoc.evaluation.palette import MISPLACED, OUTLINE, REPLACED, robot_colour
from adhoc.evaluation.records import writing
from adhoc.houses.house import House
from adhoc.inspecting.key_steps import COUNT, KeyStep, key_steps
from adhoc.inspecting.moment_drawing import draw_objects, draw_paths, draw_robots
from adhoc.inspecting.titles import titles
from adhoc.inspecting.watching import Watched

WIDTH = 14.0
CAPTION, TITLE, TIMELINE, LEGEND, EDGE = 0.5, 0.34, 0.95, 0.1, 0.15
"""Inches: below a panel, above a row, of the time line at the top and the legend below, around all."""
TALLEST = 3.2
DPI = 130
COLUMNS = 34
"""Letters in a line of a caption."""


_LEGEND_TEXT = (
    "Lines: ways since the key step before; the teammates' yellow (1 solid, 2 dashed, 3 dotted, 4 "
    "dash-dotted, ...), the newcomer's white. Numbered red squares: misplaced objects; green circles: the "
    "same in a right place."
)


def draw_key_steps(
    episodes: Sequence[Watched], folder: Path, name: str, count: int = COUNT
) -> tuple[Path, Path]:
    """Draw a row of key steps for each episode into `NAME.png` and `NAME.svg` in a folder.

    A common time line is at the top. Every panel shows the house at one step: the robots, what became of
    the misplaced objects, and the ways since the key step before: those of teammates yellow in different
    dashes, the newcomer's white. The title names the language model. Returns both files; overwrites them.
    """
    house = episodes[0].result.scenario.house
    panel_width = (WIDTH - 2 * EDGE) / count
    panel_height = min(TALLEST, panel_width * _height_over_width(house))
    row = TITLE + panel_height + CAPTION
    height = 2 * EDGE + TIMELINE + row * len(episodes) + LEGEND
    figure = Figure(figsize=(WIDTH, height), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    steps = [key_steps(watched.result, count) for watched in episodes]
    named = titles([watched.record for watched in episodes], "original team")
    _draw_timeline(figure, episodes, named, steps, height)
    for number, (watched, chosen) in enumerate(zip(episodes, steps)):
        top = height - EDGE - TIMELINE - number * row
        _draw_row_title(figure, watched, named[number], top, height)
        before = 0
        for column, key in enumerate(chosen):
            place = (EDGE + column * panel_width, top - TITLE - panel_height, panel_width, panel_height)
            axes = figure.add_axes(
                (place[0] / WIDTH, place[1] / height, 0.97 * place[2] / WIDTH, place[3] / height)
            )
            _draw_panel(axes, watched, key, before)
            _caption(figure, key, place, height)
            before = key.step
    figure.text(EDGE / WIDTH, EDGE / height, _LEGEND_TEXT, fontsize=7, color="#3d4650", va="bottom")
    return _save(figure, folder, name)


def _draw_panel(axes: Axes, watched: Watched, key: KeyStep, before: int) -> None:
    draw_house(axes, watched.result.scenario.house, 0.42, furniture_names=False)
    draw_paths(axes, watched, before, key.step, in_colour=False, size=0.7)
    draw_objects(axes, watched, key.step, 0.8)
    draw_robots(axes, watched, key.step, 0.8)


def _caption(figure: Figure, key: KeyStep, place: tuple[float, float, float, float], height: float) -> None:
    left, low, _, _ = place
    figure.text(
        (left + 0.03) / WIDTH,
        (low - 0.03) / height,
        f"step {key.step}",
        fontsize=8,
        fontweight="bold",
        va="top",
    )
    told = textwrap.shorten("; ".join(key.captions), 2 * COLUMNS, placeholder=" ...")
    figure.text(
        (left + 0.03) / WIDTH,
        (low - 0.18) / height,
        textwrap.fill(told, COLUMNS),
        fontsize=7,
        color="#3d4650",
        va="top",
    )


def _draw_row_title(figure: Figure, watched: Watched, title: str, top: float, height: float) -> None:
    record = watched.record
    joins = "" if record["join_step"] is None else f", joining at step {record['join_step']}"
    y = 1 - (height - top + 0.2) / height
    figure.text(
        EDGE / WIDTH,
        y,
        f"{title}{joins}",
        fontsize=10.5,
        fontweight="bold",
        color=OUTLINE,
        va="center",
    )
    figure.text(
        1 - EDGE / WIDTH,
        y,
        f"{record['ending']} after {record['steps']} steps; {record['replaced']} of {record['misplaced']} "
        "re-placed",
        fontsize=8.5,
        color=REPLACED if record["success"] else MISPLACED,
        ha="right",
        va="center",
    )


def _draw_timeline(
    figure: Figure,
    episodes: Sequence[Watched],
    named: Sequence[str],
    steps: Sequence[Sequence[KeyStep]],
    height: float,
) -> None:
    record = episodes[0].record
    models = dict.fromkeys(str(it.record[name]) for it in episodes for name in ("model", "team_model"))
    asked = ", ".join(model for model in models if model != "None") or "none"
    figure.text(
        EDGE / WIDTH,
        1 - 0.22 / height,
        f"{record['task_id']}, {record['team_label']} team; language model: {asked}",
        fontsize=11,
        fontweight="bold",
        color=OUTLINE,
        va="center",
    )
    axes = figure.add_axes(
        (0.1, 1 - (EDGE + 0.78) / height, 0.88, 0.42 / height), facecolor="none", frameon=False
    )
    last = max(watched.result.steps for watched in episodes)
    axes.set_xlim(-0.01 * last, 1.01 * last + 1)
    axes.set_ylim(-1, len(episodes))
    axes.set_yticks(range(len(episodes)), named[::-1])
    axes.tick_params(labelsize=7, length=2, pad=1)
    for number, (watched, chosen) in enumerate(zip(episodes, steps)):
        y, colour = len(episodes) - 1 - number, robot_colour(number + 1)
        axes.plot([0, watched.result.steps], [y, y], color=colour, linewidth=2, solid_capstyle="butt")
        axes.plot([key.step for key in chosen], [y] * len(chosen), "|", color=OUTLINE, markersize=6)
        if watched.result.joined and watched.result.join_step is not None:
            axes.plot(watched.result.join_step, y, "*", color="white", markeredgecolor=OUTLINE, markersize=8)


def _height_over_width(house: House) -> float:
    xs, ys = zip(*(corner for room in house.rooms for corner in room.polygon))
    return float((max(ys) - min(ys) + 2 * MARGIN) / (max(xs) - min(xs) + 2 * MARGIN))


def _save(figure: Figure, folder: Path, name: str) -> tuple[Path, Path]:
    png, svg = folder / f"{name}.png", folder / f"{name}.svg"
    pixels, lines = BytesIO(), BytesIO()
    with rc_context({"svg.hashsalt": "adhoc", "svg.fonttype": "path"}):
        figure.savefig(pixels, format="png", dpi=DPI)
        figure.savefig(lines, format="svg", metadata={"Date": None})
    for path, content in ((png, pixels), (svg, lines)):
        with writing(path):
            write_whole(path, content.getvalue())
    return png, svg
