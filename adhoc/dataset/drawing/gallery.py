"""The dataset figure: the floor plans of several houses beside each other, on one scale."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.floor_drawing import draw_house
from adhoc.evaluation.floor_shapes import (
    FURNITURE_EDGE,
    FURNITURE_FACE,
    MARGIN,
    OPENINGS,
    OTHER_ROOM,
    ROOM_COLOURS,
    WALL,
)
from adhoc.houses import floor_plan
from adhoc.houses.house import House, Room

WIDTH = 12.0
"""Inches of the figure; a page is at most `TALLEST` times as high."""
TALLEST = 1.2
TITLE, LEGEND, EDGE = 0.42, 0.75, 0.15
"""Inches: above each floor plan for its title, for the legend, and around everything."""
DPI = 150
LETTERS = 0.62
"""Size of letters and lines, relative to a floor plan that has a picture of its own."""
BAR = 5.0
"""Metres of the scale bar."""
NARROWEST = 4.8
"""Metres of the page, at least, that a floor plan gets for its title."""
LETTER_WIDTH = 0.72
"""Of the bold capitals of room names, relative to their size."""


@dataclass(frozen=True)
class _Panel:
    house: House
    width: float
    """Metres of the floor plan with its margins."""
    height: float

    @property
    def space(self) -> float:
        """Metres that it takes up in its row."""
        return max(self.width, NARROWEST)


def draw_gallery(houses: Sequence[House], path: Path) -> None:
    """Draw floor plans into a PNG file, fewest rooms first, all on one scale, as large as the page allows.

    Each is titled with its number of rooms, floor area and number of items; below are a legend of room types
    and a scale bar. Creates the folder, overwrites the file. Raises ConfigurationError without any house.
    """
    if not houses:
        raise ConfigurationError("a gallery needs at least one house")
    panels = [_panel(house) for house in sorted(houses, key=lambda house: len(house.rooms))]
    rows = _rows(panels)
    scale = _scale(rows)
    height = _page_height(rows, scale)
    figure = Figure(figsize=(WIDTH, height), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    top = height - EDGE
    for row in rows:
        tallest = max(panel.height for panel in row) * scale
        gap = (WIDTH - 2 * EDGE - sum(panel.space for panel in row) * scale) / (len(row) + 1)
        left = EDGE + gap
        for panel in row:
            size = panel.width * scale, panel.height * scale
            indent = (panel.space * scale - size[0]) / 2
            _draw_panel(figure, panel, (left + indent, top - TITLE - size[1]), size)
            left += panel.space * scale + gap
        top -= TITLE + tallest
    _draw_legend(figure, houses, scale)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=DPI)


def _panel(house: House) -> _Panel:
    xs = [x for room in house.rooms for x, _ in room.polygon]
    ys = [y for room in house.rooms for _, y in room.polygon]
    return _Panel(house, max(xs) - min(xs) + 2 * MARGIN, max(ys) - min(ys) + 2 * MARGIN)


def _rows(panels: Sequence[_Panel]) -> list[list[_Panel]]:
    """Rows of panels in their order, as narrow (so on as large a scale) as the page's height allows."""
    widths = sorted(
        {
            sum(panel.space for panel in panels[start:end])
            for start in range(len(panels))
            for end in range(start + 1, len(panels) + 1)
        }
    )
    widest = max(panel.space for panel in panels)
    for width in widths:
        if width >= widest:
            rows = _filled(panels, width)
            if _page_height(rows, _scale(rows)) <= TALLEST * WIDTH:
                return rows
    return [list(panels)]


def _filled(panels: Sequence[_Panel], width: float) -> list[list[_Panel]]:
    rows: list[list[_Panel]] = []
    free = 0.0
    for panel in panels:
        if panel.space > free + 1e-9:
            rows.append([])
            free = width
        rows[-1].append(panel)
        free -= panel.space
    return rows


def _scale(rows: Sequence[Sequence[_Panel]]) -> float:
    """Inches per metre that make the widest row as wide as the page."""
    return (WIDTH - 2 * EDGE) / max(sum(panel.space for panel in row) for row in rows)


def _page_height(rows: Sequence[Sequence[_Panel]], scale: float) -> float:
    plans = sum(max(panel.height for panel in row) for row in rows) * scale
    return plans + len(rows) * TITLE + LEGEND + 2 * EDGE


def _draw_panel(
    figure: Figure, panel: _Panel, corner: tuple[float, float], size: tuple[float, float]
) -> None:
    axes = _axes(figure, corner, size)
    draw_house(axes, panel.house, LETTERS, furniture_names=False)
    for name, room in zip(axes.texts, panel.house.rooms):
        _fit_name(name, room, size[0] / panel.width)
    axes.set_title(_title(panel.house), fontsize=8.5, pad=1, color=WALL, linespacing=1.1)


def _fit_name(name: Text, room: Room, scale: float) -> None:
    """Turn the name of a room that is too narrow for it upright, or leave it out; the colour tells it too."""
    xs, ys = zip(*room.polygon)
    length = len(name.get_text()) * LETTER_WIDTH * float(name.get_fontsize()) / 72 / scale
    if length > max(xs) - min(xs):
        name.set_rotation(90)
        name.set_visible(length <= max(ys) - min(ys))


def _title(house: House) -> str:
    rooms = "1 room" if len(house.rooms) == 1 else f"{len(house.rooms)} rooms"
    area = sum(floor_plan.area(room.polygon) for room in house.rooms)
    items = sum(thing.pickupable for thing in house.objects)
    return f"{rooms}\n{area:.0f} m², {items} items"


def _draw_legend(figure: Figure, houses: Sequence[House], scale: float) -> None:
    present = {room.room_type for house in houses for room in house.rooms}
    faces = {
        name: ROOM_COLOURS.get(name, OTHER_ROOM)
        for name in sorted(present, key=lambda name: (*ROOM_COLOURS, name).index(name))
    }
    faces["furniture"] = FURNITURE_FACE
    patches: list[Patch | Line2D] = [
        Patch(facecolor=colour, edgecolor=FURNITURE_EDGE, linewidth=0.6, label=name)
        for name, colour in faces.items()
    ]
    patches.append(Line2D([], [], color=OPENINGS["window"], linewidth=2.2, label="window"))
    patches.append(Line2D([], [], color=OPENINGS["door"], linewidth=2.2, label="closed exterior door"))
    height = figure.get_figheight()
    figure.legend(
        handles=patches,
        loc="center right",
        bbox_to_anchor=(1 - EDGE / WIDTH, (EDGE + LEGEND / 2) / height),
        ncols=len(patches),
        fontsize=8.5,
        frameon=False,
        columnspacing=1.4,
        handlelength=1.6,
    )
    axes = _axes(figure, (2 * EDGE, EDGE + LEGEND / 2 - 0.1), (BAR * scale, 0.2))
    axes.set_axis_off()
    axes.set_xlim(0, BAR)
    axes.set_ylim(-1, 1)
    axes.plot([0, BAR], [-0.6, -0.6], color=WALL, linewidth=2, solid_capstyle="butt", clip_on=False)
    axes.text(BAR / 2, 0.0, f"{BAR:g} m", ha="center", va="bottom", fontsize=8.5, color=WALL)


def _axes(figure: Figure, corner: tuple[float, float], size: tuple[float, float]) -> Axes:
    """Axes at a place in inches from the lower left."""
    height = figure.get_figheight()
    return figure.add_axes((corner[0] / WIDTH, corner[1] / height, size[0] / WIDTH, size[1] / height))
