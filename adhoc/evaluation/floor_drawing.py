"""A house from above: the backdrop of pictures."""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from adhoc.evaluation.floor_shapes import (
    FURNITURE_EDGE,
    FURNITURE_FACE,
    INK,
    LABELLED_AREA,
    MARGIN,
    OPENINGS,
    OTHER_ROOM,
    ROOM_COLOURS,
    WALL,
    WAY,
    footprint,
    hangs,
    middle_of,
    spaced,
)
from adhoc.houses.house import House


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
        x, y = middle_of(room.polygon)
        axes.text(
            x,
            y,
            spaced(room.room_type).upper(),
            fontsize=9 * size,
            color=INK,
            alpha=0.75,
            ha="center",
            va="center",
            fontweight="bold",
            zorder=2,
        )


def _draw_furniture(axes: Axes, house: House, size: float, named: bool) -> None:
    furniture = [thing for thing in house.objects if not thing.pickupable and not hangs(thing)]
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
                spaced(thing.category).replace(" ", "\n"),
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
