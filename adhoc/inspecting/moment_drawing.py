"""One moment of an episode from above, on matplotlib axes: what figures and films are made of."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from matplotlib.patheffects import withStroke

from adhoc.core.values import Pose
from adhoc.evaluation.palette import MISPLACED, NEWCOMER, OUTLINE, REPLACED, robot_colour
from adhoc.inspecting.field_of_view import RAYS, unit_of
from adhoc.inspecting.recorder import Track
from adhoc.inspecting.watching import Watched

_Value = TypeVar("_Value")

ROBOT = 0.3
"""Metres from the middle of a robot to its tip: half again as large as it is, to be seen."""
VIEW_ALPHA, NEWCOMER_VIEW_ALPHA = 0.22, 0.4
"""How opaque fields of view are."""
TEAM_PATH = "#f6c945"
"""The paper's yellow."""
LINES = ("-", (0, (4, 1.5)), (0, (1, 1.2)), (0, (5, 1.5, 1, 1.5)), (0, (7, 2)), (0, (3, 1, 1, 1, 1, 1)))
"""Of the teammates' paths, which share a colour as in the paper."""


def draw_paths(
    axes: Axes, watched: Watched, first: int, last: int, in_colour: bool, size: float = 1.0
) -> list[Artist]:
    """The ways of all robots between two steps: in their own colours, or yellow in different dashes and white
    for the newcomer."""
    artists: list[Artist] = []
    for position, (name, track) in enumerate(watched.recording.tracks.items()):
        part = track.poses[max(0, first - track.first) : max(0, last - track.first + 1)]
        if len(part) < 2:
            continue
        is_newcomer = name == watched.result.scenario.newcomer.name
        colour = robot_colour(position) if in_colour else TEAM_PATH
        artists += axes.plot(
            [pose.x for pose in part],
            [pose.y for pose in part],
            color=NEWCOMER if is_newcomer else colour,
            linestyle="-" if is_newcomer or in_colour else LINES[position % len(LINES)],
            linewidth=2.0 * size,
            solid_capstyle="round",
            path_effects=[withStroke(linewidth=(3.6 if is_newcomer else 3.0) * size, foreground=OUTLINE)]
            if is_newcomer or not in_colour
            else [],
            zorder=5,
        )
    return artists


def draw_views(axes: Axes, watched: Watched, step: int) -> list[Artist]:
    """The fields of view of all robots at a step."""
    recording = watched.recording
    artists: list[Artist] = []
    for position, (name, track) in enumerate(recording.tracks.items()):
        pose, view = _at(track, step, track.poses), _at(track, step, track.views)
        if pose is None or view is None or view < 0:
            continue
        points = np.frombuffer(recording.views[view], np.int8).reshape(RAYS, 2) * unit_of(recording.reach)
        corners = np.concatenate([[(0.0, 0.0)], points]) + np.array([pose.x, pose.y])
        is_newcomer = name == watched.result.scenario.newcomer.name
        colour = NEWCOMER if is_newcomer else robot_colour(position)
        alpha = NEWCOMER_VIEW_ALPHA if is_newcomer else VIEW_ALPHA
        patch = Polygon(corners, facecolor=colour, alpha=alpha, linewidth=0, zorder=4)
        artists.append(axes.add_patch(patch))
    return artists


def draw_robots(axes: Axes, watched: Watched, step: int, size: float = 1.0) -> list[Artist]:
    """All robots that are there at a step, as darts in their colours with their numbers, a star for the
    newcomer."""
    artists: list[Artist] = []
    for position, (name, track) in enumerate(watched.recording.tracks.items()):
        pose = _at(track, step, track.poses)
        if pose is None:
            continue
        is_newcomer = name == watched.result.scenario.newcomer.name
        dart = Polygon(
            _dart(pose),
            facecolor=NEWCOMER if is_newcomer else robot_colour(position),
            edgecolor=OUTLINE,
            linewidth=(1.8 if is_newcomer else 1.0) * size,
            joinstyle="round",
            zorder=7,
        )
        artists.append(axes.add_patch(dart))
        mark = "★" if is_newcomer else str(position + 1)
        text = axes.text(
            pose.x,
            pose.y,
            mark,
            fontsize=6.5 * size,
            fontweight="bold",
            color=OUTLINE if is_newcomer else "white",
            ha="center",
            va="center",
            path_effects=[] if is_newcomer else [withStroke(linewidth=1.4 * size, foreground=OUTLINE)],
            zorder=7.1,
        )
        artists.append(text)
    return artists


def draw_objects(axes: Axes, watched: Watched, step: int, size: float = 1.0) -> list[Artist]:
    """The misplaced objects at a step, numbered: a red square where they are wrong or held, a green circle in
    place."""
    placed = placed_at(watched, step)
    places = {
        name: truth for name, truth in watched.recording.objects.items() if name in watched.result.watched
    }
    for move in watched.recording.moves:
        if move.step <= step and move.object.id in places:
            places[move.object.id] = move.object
    artists: list[Artist] = []
    for number, name in enumerate(watched.result.watched, start=1):
        truth = places.get(name)
        if truth is None:
            continue
        x, y = truth.position[:2]
        track = watched.recording.tracks.get(truth.holder or "")
        holder = None if track is None else _at(track, step, track.poses)
        if holder is not None:
            x, y = holder.x + ROBOT, holder.y - ROBOT
        artists += axes.plot(
            x,
            y,
            "o" if name in placed else "s",
            color=REPLACED if name in placed else MISPLACED,
            markersize=7.5 * size,
            markeredgecolor="white",
            markeredgewidth=0.8 * size,
            zorder=8,
        )
        artists.append(
            axes.text(
                x,
                y,
                str(number),
                fontsize=5.5 * size,
                fontweight="bold",
                color="white",
                ha="center",
                va="center_baseline",
                zorder=8.1,
            )
        )
    return artists


def placed_at(watched: Watched, step: int) -> set[str]:
    """The misplaced objects that are in a right place after so many steps."""
    placed: set[str] = set()
    for event in watched.result.trace.events:
        if event.step > step or event.object_id is None:
            continue
        if event.kind == "replaced":
            placed.add(event.object_id)
        elif event.kind == "picked up":
            placed.discard(event.object_id)
    return placed


def _at(track: Track, step: int, values: Sequence[_Value]) -> _Value | None:
    position = step - track.first
    return values[position] if 0 <= position < len(values) else None


def _dart(pose: Pose) -> list[tuple[float, float]]:
    cosine, sine = math.cos(pose.yaw), math.sin(pose.yaw)
    shape = ((1.0, 0.0), (-0.75, 0.8), (-0.4, 0.0), (-0.75, -0.8))
    return [
        (pose.x + ROBOT * (cosine * dx - sine * dy), pose.y + ROBOT * (sine * dx + cosine * dy))
        for dx, dy in shape
    ]
