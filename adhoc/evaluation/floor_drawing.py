"""A house from above: the backdrop of pictures."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from adhoc.houses.house import House, HouseObject

ROOM_COLOURS: Mapping[str, str] = {
    "Kitchen": "#fbe8d3",
    "LivingRoom": "#dfeedd",
    "Bedroom": "#dde7f5",
    "Bathroom": "#e3f1f3",
    "Corridor": "#efebe4",
}
OTHER_ROOM = "#eeeeee"
WALL = "#3c3f45"
WAY = "#f4f2ee"
OPENINGS: Mapping[str, str] = {"window": "#9cc7de", "door": "#c98f4e"}
"""Holes that no robot can pass, by kind."""
FURNITURE_EDGE = "#a9a397"
FURNITURE_FACE = "#ffffff"
INK = "#55524c"
MARGIN = 0.35
"""Metres around the house."""
LABELLED_AREA = 0.35
"""Furniture with a smaller footprint, in square metres, gets no name."""


def draw_house(axes: Axes, house: House, size: float = 1.0, furniture_names: bool = True) -> None:
    """Draw rooms with their types, walls with their openings, and the outlines of all furniture.

    Sets equal scales and the limits of the axes; the frame is the world's, in metres. `size` multiplies the
    thickness of lines and the size of letters; without `furniture_names`, only rooms are named.
    """
    _draw_rooms(axes, house, size)
    _draw_furniture(axes, house, size, furniture_names)
    _draw_walls(axes, house, size)
    xs = [x for room in house.rooms for x, _ in room.polygon]
    ys = [y for room in house.rooms for _, y in room.polygon]
    axes.set_xlim(min(xs) - MARGIN, max(xs) + MARGIN)
    axes.set_ylim(min(ys) - MARGIN, max(ys) + MARGIN)
    axes.set_aspect("equal")
    axes.set_axis_off()


def draw_floor_plan(house: House, path: Path) -> None:
    """Draw a house alone into a PNG file."""
    figure = Figure(figsize=(8, 8), dpi=110, facecolor="white")
    FigureCanvasAgg(figure)
    draw_house(figure.add_axes((0.02, 0.02, 0.96, 0.96)), house)
    figure.savefig(path, dpi=110)


def _draw_rooms(axes: Axes, house: House, size: float) -> None:
    polygons = [room.polygon for room in house.rooms]
    colours = [ROOM_COLOURS.get(room.room_type, OTHER_ROOM) for room in house.rooms]
    axes.add_collection(PolyCollection(polygons, facecolors=colours, edgecolors="none", zorder=0))
    for room in house.rooms:
        x, y = _middle(room.polygon)
        axes.text(
            x,
            y,
            _spaced(room.room_type).upper(),
            fontsize=9 * size,
            color=INK,
            alpha=0.75,
            ha="center",
            va="center",
            fontweight="bold",
            zorder=2,
        )


def _draw_furniture(axes: Axes, house: House, size: float, named: bool) -> None:
    furniture = [thing for thing in house.objects if not thing.pickupable and not _hangs(thing)]
    axes.add_collection(
        PolyCollection(
            [footprint(thing) for thing in furniture],
            facecolors=FURNITURE_FACE,
            edgecolors=FURNITURE_EDGE,
            linewidths=0.8 * size,
            alpha=0.8,
            zorder=1,
        )
    )
    for thing in furniture:
        if named and thing.size[0] * thing.size[1] >= LABELLED_AREA:
            axes.text(
                *thing.position[:2],
                _spaced(thing.category).replace(" ", "\n"),
                fontsize=5 * size,
                color="#8b867b",
                ha="center",
                va="center",
                zorder=1.5,
            )


def _draw_walls(axes: Axes, house: House, size: float) -> None:
    walls = [(wall.start, wall.end) for wall in house.walls]
    axes.add_collection(
        LineCollection(walls, colors=WALL, linewidths=3.2 * size, capstyle="projecting", zorder=3)
    )
    for kind, colour in OPENINGS.items():
        holes = [(hole.start, hole.end) for hole in house.openings if hole.kind == kind and not hole.passable]
        axes.add_collection(LineCollection(holes, colors=colour, linewidths=2.2 * size, zorder=3.1))
    ways = [(hole.start, hole.end) for hole in house.openings if hole.passable]
    axes.add_collection(LineCollection(ways, colors=WAY, linewidths=3.8 * size, capstyle="butt", zorder=3.2))


def footprint(thing: HouseObject) -> list[tuple[float, float]]:
    """The four corners of an object's outline on the floor plan, in metres."""
    (x, y, _), (length, width, _) = thing.position, thing.size
    cosine, sine = math.cos(thing.yaw), math.sin(thing.yaw)
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    halves = [(across * length / 2, along * width / 2) for across, along in corners]
    return [(x + cosine * dx - sine * dy, y + sine * dx + cosine * dy) for dx, dy in halves]


def _hangs(thing: HouseObject) -> bool:
    """Paintings and the like, whose outline says nothing about the floor."""
    return thing.position[2] - thing.size[2] / 2 > 0.9 and thing.category in ("Painting", "Television")


def _middle(polygon: tuple[tuple[float, float], ...]) -> tuple[float, float]:
    """The centre of area of a polygon; of its corners if it has no area."""
    doubled, x_sum, y_sum = 0.0, 0.0, 0.0
    for (ax, ay), (bx, by) in zip(polygon, (*polygon[1:], polygon[0])):
        cross = ax * by - bx * ay
        doubled += cross
        x_sum += (ax + bx) * cross
        y_sum += (ay + by) * cross
    if abs(doubled) < 1e-9:
        return sum(x for x, _ in polygon) / len(polygon), sum(y for _, y in polygon) / len(polygon)
    return x_sum / (3 * doubled), y_sum / (3 * doubled)


def _spaced(name: str) -> str:
    """`LivingRoom` as `Living Room`, `TVStand` as `TV Stand`."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name)
