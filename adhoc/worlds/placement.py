"""Where an object can be set down: candidate places, room for its bulk, and a physical check."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.houses.solids import Surface
from adhoc.worlds.rigid_shape import Placement
from adhoc.worlds.scene import Scene, Thing

Places = NDArray[np.float64]
"""Candidate places, (N, 4): the x, y, z of an object's centre in metres, and its yaw in radians."""

_GAP = 0.001
"""An object is let go this far above the surface, in metres."""

_DECIMALS = 9

_EXACT_FIT = 1e-9
"""A footprint as large as its surface fits, whatever the rounding, in metres."""


@dataclass(frozen=True)
class PlacementRules:
    """When a place is good enough; metres, radians, seconds. All are choices of this library."""

    spacing: float = 0.05
    """Distance between the candidate places of a surface."""
    fall_seconds: float = 0.5
    """How long gravity may act before the object's position is looked at."""
    most_moved: float = 0.02
    """An object that moves further than this while it settles does not lie safely."""
    most_tilted: float = math.radians(10.0)
    """Nor does one that tilts further than this."""
    most_falls: int = 10
    """How many candidate places are tried physically before giving up."""


class Placer:
    """Finds places for things that are out of the scene, and puts them there."""

    def __init__(self, scene: Scene, rules: PlacementRules) -> None:
        self._scene = scene
        self._rules = rules

    def put(self, thing: Thing, candidates: Iterable[Placement], receptacle: str) -> bool:
        """Put the thing at the first candidate where it fits and stays; False if there is none.

        The thing comes to rest where physics lets it settle, upright.
        """
        falls = 0
        for candidate in candidates:
            if not self._fits(thing, candidate):
                continue
            if falls == self._rules.most_falls:
                break
            falls += 1
            settled = self._settled(thing, candidate)
            if settled is not None:
                self._scene.put(thing, settled, receptacle)
                return True
        return False

    def on_surfaces(self, thing: Thing, surfaces: Sequence[Surface]) -> Places:
        """Candidate places on surfaces: the footprint inside the surface, the height within the clearance.

        The object lies along the surface; it is turned by 90 degrees where it only fits so.
        """
        half_x, half_y, half_z = thing.shape.half
        places: list[NDArray[np.float64]] = [np.zeros((0, 4))]
        for surface in surfaces:
            if 2 * half_z + _GAP > surface.clearance:
                continue
            for turn, across, along in ((0.0, half_x, half_y), (math.pi / 2, half_y, half_x)):
                points = _grid(surface.half[0] - across, surface.half[1] - along, self._rules.spacing)
                if len(points):
                    places.append(_on_plane(surface, points, half_z + _GAP, surface.yaw + turn))
                    break
        return np.concatenate(places)

    def _fits(self, thing: Thing, candidate: Placement) -> bool:
        (body,) = thing.bodies
        self._scene.bullet.place(body, candidate)
        touched = self._scene.bullet.touched_by(body)
        self._scene.bullet.put_aside(body)
        return touched is None

    def _settled(self, thing: Thing, candidate: Placement) -> Placement | None:
        rules = self._rules
        settled, tilt = self._scene.bullet.fall(thing.shape, candidate, thing.mass, rules.fall_seconds)
        if tilt > rules.most_tilted or math.dist(settled.center, candidate.center) > rules.most_moved:
            return None
        return settled


def nearest_first(places: Places, point: tuple[float, float]) -> Iterator[Placement]:
    """The places by horizontal distance to `point`; equally near ones in their given order."""
    distances = np.round(distances_to(places, point), _DECIMALS)
    return _placements(places, np.argsort(distances, kind="stable"))


def shuffled(places: Places, generator: np.random.Generator) -> Iterator[Placement]:
    """The places in random order."""
    return _placements(places, generator.permutation(len(places)))


def distances_to(places: Places, point: tuple[float, float]) -> NDArray[np.float64]:
    """Horizontal distance (N,) of places to a point, in metres."""
    distances: NDArray[np.float64] = np.hypot(places[:, 0] - point[0], places[:, 1] - point[1])
    return distances


def _placements(places: Places, order: NDArray[np.int64]) -> Iterator[Placement]:
    for index in order:
        x, y, z, yaw = places[index].tolist()
        yield Placement((x, y, z), yaw)


def _grid(reach_x: float, reach_y: float, spacing: float) -> NDArray[np.float64]:
    """Points (N, 2) on a grid around the origin, within the reach in x and y; none if one is negative."""
    if min(reach_x, reach_y) < -_EXACT_FIT:
        return np.zeros((0, 2))
    steps_x, steps_y = (math.floor(max(0.0, reach) / spacing) for reach in (reach_x, reach_y))
    x, y = np.meshgrid(
        spacing * np.arange(-steps_x, steps_x + 1), spacing * np.arange(-steps_y, steps_y + 1), indexing="ij"
    )
    return np.stack([x.ravel(), y.ravel()], axis=1)


def _on_plane(surface: Surface, points: NDArray[np.float64], lift: float, yaw: float) -> Places:
    cosine, sine = math.cos(surface.yaw), math.sin(surface.yaw)
    turned = points @ np.array([[cosine, sine], [-sine, cosine]])
    x, y, z = surface.center
    heights = np.full((len(points), 2), (z + lift, yaw))
    return np.concatenate([turned + np.array([x, y]), heights], axis=1)
