"""One task from above, as a PNG: what is misplaced, where it belongs, and who is there to tidy it up."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from adhoc.core.values import Point, Pose
from adhoc.dataset.drawing.label_places import LabelPlaces
from adhoc.dataset.drawing.task_marks import INK, MARK, MISPLACED, ROBOT, draw_arrow, draw_number, draw_robot
from adhoc.evaluation.floor_drawing import draw_house
from adhoc.evaluation.floor_shapes import MARGIN
from adhoc.evaluation.scenario import Displacement, Member, Scenario
from adhoc.houses import floor_plan
from adhoc.houses.house import FLOOR, House, HouseObject

ORIGIN = "#2e7d32"
"""Where misplaced objects were."""
DPI = 120
PLAN, SIDE, EDGE, TITLE = 8.2, 3.7, 0.2, 0.45
"""Inches: width of the floor plan and of the text beside it, around both, and the title above."""
TALLEST = 8.5
LINE = 0.165
"""Inches between lines of text."""
LETTERS = 7.5
LABEL = 6.8
"""Points: letters beside the plan, and of labels in it."""
COLUMNS = 54
"""Letters in a line of the side panel."""


def draw_task(scenario: Scenario, path: Path, lines: Sequence[str] = ()) -> None:
    """Draw a scenario before its first step into a PNG file.

    Numbered arrows lead from where each misplaced object was (green) to where it lies (red). Robots are darts
    that point where they look, blue if they can manipulate, grey if not; the newcomer has a yellow rim. The
    panel beside the plan says what the objects are and what the robots can do, then `lines` (of any length).
    Objects whose position is not known are only listed. Creates the folder, overwrites the file.
    """
    entries = _entries(scenario, lines)
    width, height = _extents(scenario.house)
    plan_width = min(PLAN, TALLEST * width / height)
    plan_height = plan_width * height / width
    body = max(plan_height, LINE * sum(entry.height for entry in entries))
    figure = Figure(
        figsize=(3 * EDGE + plan_width + SIDE, 2 * EDGE + TITLE + body), dpi=DPI, facecolor="white"
    )
    FigureCanvasAgg(figure)
    axes = _axes(figure, EDGE, EDGE + (body - plan_height) / 2, plan_width, plan_height)
    draw_house(axes, scenario.house, 0.8)
    _draw_things(axes, scenario, plan_width / width)
    side = _axes(figure, 2 * EDGE + plan_width, EDGE, SIDE, body)
    side.set_xlim(0, SIDE)
    side.set_ylim(-body, 0)
    side.set_axis_off()
    _draw_entries(side, entries)
    place = (EDGE / figure.get_figwidth(), 1 - (EDGE + TITLE / 2) / figure.get_figheight())
    figure.text(*place, _title(scenario), fontsize=11, fontweight="bold", color=INK, va="center")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=DPI)


@dataclass(frozen=True)
class _Entry:
    """A line of the side panel, or several: a mark and text."""

    text: str
    number: str = ""
    """In a red circle, before the text."""
    member: Member | None = None
    """A robot, whose dart goes before the text."""
    is_newcomer: bool = False
    bold: bool = False

    @property
    def height(self) -> float:
        """In lines of text."""
        return self.text.count("\n") + 1 + (0.9 if self.number or self.member else 0.45)


def _title(scenario: Scenario) -> str:
    rooms, misplaced = len(scenario.house.rooms), len(scenario.misplaced)
    return (
        f"{scenario.id}   {scenario.difficulty.value}, {rooms} room{'s' * (rooms > 1)}, "
        f"{misplaced} misplaced object{'s' * (misplaced > 1)}, {len(scenario.team)} teammates"
    )


def _entries(scenario: Scenario, lines: Sequence[str]) -> list[_Entry]:
    return [
        _Entry("Misplaced objects (from where they were)", bold=True),
        *(
            _Entry(_told_object(scenario.house, displacement), number=str(number))
            for number, displacement in enumerate(scenario.misplaced, start=1)
        ),
        _Entry("Robots (blue: can manipulate, grey: cannot)", bold=True),
        *(_Entry(_told_robot(member), member=member) for member in scenario.team),
        _Entry(_told_robot(scenario.newcomer), member=scenario.newcomer, is_newcomer=True),
        *([_Entry("", bold=True)] if lines else []),
        *(_Entry(textwrap.fill(line, COLUMNS)) for line in lines),
    ]


def _told_object(house: House, displacement: Displacement) -> str:
    thing = house.object(displacement.object_id)
    before = _told_place(house, thing.parent or FLOOR, thing.position)
    after = _told_place(house, displacement.receptacle_id, displacement.position)
    return f"{thing.id}, {thing.mass:g} kg\n{before} → {after}"


def _told_place(house: House, receptacle: str, position: Point | None) -> str:
    """A receptacle with the type of its room; of the floor, of the room below the position if known."""
    if receptacle != FLOOR:
        room = house.room(house.object(receptacle).room)
    elif position is not None:
        point = position[:2]
        room = min(house.rooms, key=lambda room: floor_plan.distance(room.polygon, point))
    else:
        return FLOOR
    return f"{receptacle} ({room.room_type})"


def _told_robot(member: Member) -> str:
    able = member.capability
    names = dict.fromkeys((_short_name(member), member.name))
    return (
        f"{', '.join(names)}: {'can manipulate' if able.can_manipulate else 'cannot manipulate'}\n"
        f"camera {able.camera_height:g} m, payload {able.payload:g} kg, battery {able.max_steps} steps"
    )


def _short_name(member: Member) -> str:
    """`T1` for `teammate_1`."""
    return member.name.replace("teammate_", "T")


def _draw_entries(axes: Axes, entries: Sequence[_Entry]) -> None:
    down = 0.0
    for entry in entries:
        middle = -(down + 0.5) * LINE
        if entry.number:
            draw_number(axes, 0.12, middle - 0.3 * LINE, entry.number, MISPLACED)
        if entry.member is not None:
            draw_robot(
                axes, entry.member, entry.is_newcomer, Pose(0.12, middle - 0.3 * LINE, math.pi / 2), 1.0
            )
        axes.text(
            0.32 if entry.number or entry.member else 0.0,
            middle + LINE / 2,
            entry.text,
            fontsize=LETTERS + (0.5 if entry.bold else 0),
            fontweight="bold" if entry.bold else "normal",
            color=INK,
            va="top",
            linespacing=1.25,
        )
        down += entry.height


def _draw_things(axes: Axes, scenario: Scenario, scale: float) -> None:
    """Arrows, numbers, darts and their labels; `scale` in inches per metre."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    places = LabelPlaces((left, low, right, high))
    names = list(axes.texts)
    robots = (*scenario.team, scenario.newcomer)
    for member in robots:
        places.take(member.pose.x, member.pose.y, 2 * ROBOT / scale, 2 * ROBOT / scale)
        draw_robot(axes, member, member is scenario.newcomer, member.pose, scale)
    present: list[tuple[HouseObject, tuple[float, float]]] = []
    for number, displacement in enumerate(scenario.misplaced, start=1):
        thing = scenario.house.object(displacement.object_id)
        if displacement.position is not None:
            start = _mark(axes, places, str(number), thing.position[:2], ORIGIN, scale)
            end = _mark(axes, places, str(number), displacement.position[:2], MISPLACED, scale)
            draw_arrow(axes, start, end)
            present.append((thing, end))
    for name in names:
        places.take(*name.get_position(), *_text_size(name.get_text(), float(name.get_fontsize()), scale))
    for thing, end in present:
        _label(axes, places, thing.id, end, MISPLACED, scale, MARK / 2)
    for member in robots:
        _label(axes, places, _short_name(member), (member.pose.x, member.pose.y), INK, scale, ROBOT)


def _mark(
    axes: Axes, places: LabelPlaces, number: str, point: tuple[float, float], colour: str, scale: float
) -> tuple[float, float]:
    """A numbered circle at the point or, where marks lie already, beside it with a line to it."""
    size = MARK / scale
    x, y = point
    if places.is_free(x, y, size, size):
        places.take(x, y, size, size)
    else:
        x, y = places.beside(x, y, size, size)
        axes.plot([point[0], x], [point[1], y], color=colour, linewidth=1.0, zorder=7)
        axes.plot(*point, "o", color=colour, markersize=3, zorder=7)
    draw_number(axes, x, y, number, colour)
    return x, y


def _label(
    axes: Axes,
    places: LabelPlaces,
    text: str,
    point: tuple[float, float],
    colour: str,
    scale: float,
    away: float,
) -> None:
    x, y = places.beside(*point, *_text_size(text, LABEL, scale), (away + 0.015) / scale)
    axes.text(
        x,
        y,
        text,
        fontsize=LABEL,
        color=colour,
        fontweight="bold",
        ha="center",
        va="center",
        path_effects=[withStroke(linewidth=2.2, foreground="white")],
        zorder=9,
    )


def _text_size(text: str, points: float, scale: float) -> tuple[float, float]:
    """About how wide and high bold text of a size in points is, in metres of the floor plan."""
    lines = text.split("\n")
    return max(map(len, lines)) * 0.68 * points / 72 / scale, len(lines) * 1.3 * points / 72 / scale


def _extents(house: House) -> tuple[float, float]:
    """Metres of the drawn floor plan from left to right and from top to bottom."""
    xs = [x for room in house.rooms for x, _ in room.polygon]
    ys = [y for room in house.rooms for _, y in room.polygon]
    return max(xs) - min(xs) + 2 * MARGIN, max(ys) - min(ys) + 2 * MARGIN


def _axes(figure: Figure, left: float, low: float, width: float, height: float) -> Axes:
    """Axes at a place in inches from the lower left."""
    across, along = figure.get_figwidth(), figure.get_figheight()
    return figure.add_axes((left / across, low / along, width / across, height / along))
