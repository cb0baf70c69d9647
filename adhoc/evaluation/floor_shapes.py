"""What a house looks like from above, as numbers: colours, outlines and names for whatever draws it."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from adhoc.houses.house import HouseObject

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


def footprint(thing: HouseObject) -> list[tuple[float, float]]:
    """The four corners of an object's outline on the floor plan, in metres."""
    (x, y, _), (length, width, _) = thing.position, thing.size
    cosine, sine = math.cos(thing.yaw), math.sin(thing.yaw)
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    halves = [(across * length / 2, along * width / 2) for across, along in corners]
    return [(x + cosine * dx - sine * dy, y + sine * dx + cosine * dy) for dx, dy in halves]


def hangs(thing: HouseObject) -> bool:
    """Paintings and the like, whose outline says nothing about the floor."""
    return thing.position[2] - thing.size[2] / 2 > 0.9 and thing.category in ("Painting", "Television")


def middle_of(polygon: tuple[tuple[float, float], ...]) -> tuple[float, float]:
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


def spaced(name: str) -> str:
    """`LivingRoom` as `Living Room`, `TVStand` as `TV Stand`."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name)
