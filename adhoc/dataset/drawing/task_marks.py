"""The marks of a task's picture: numbers in circles, arrows, and robots as darts."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, Polygon
from matplotlib.patheffects import withStroke

from adhoc.core.values import Pose
from adhoc.evaluation.scenario import Member

MISPLACED = "#c62828"
ABLE, UNABLE = "#1565c0", "#9aa3ad"
"""Robots that can manipulate, and those that cannot."""
NEWCOMER = "#ffb300"
INK = "#1f2328"
MARK = 0.17
"""Inches: diameter of a number in its circle."""
ROBOT = 0.14
"""Inches: from the middle of a robot to its tip."""


def draw_number(axes: Axes, x: float, y: float, number: str, colour: str) -> None:
    """A number in a circle of diameter `MARK` at a place on the axes."""
    axes.plot(
        x, y, "o", markersize=MARK * 72, color=colour, markeredgecolor="white", markeredgewidth=0.8, zorder=8
    )
    axes.text(
        x,
        y,
        number,
        fontsize=7,
        color="white",
        fontweight="bold",
        ha="center",
        va="center_baseline",
        zorder=8.1,
    )


def draw_arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    """A dashed arrow from the mark where a misplaced object was to the mark where it is."""
    axes.add_patch(
        FancyArrowPatch(
            start,
            end,
            arrowstyle="-|>",
            mutation_scale=9,
            color=MISPLACED,
            linewidth=1.1,
            linestyle=(0, (4, 2)),
            alpha=0.75,
            connectionstyle="arc3,rad=0.12",
            shrinkA=MARK * 36 + 1,
            shrinkB=MARK * 36 + 1,
            zorder=6,
        )
    )


def draw_robot(axes: Axes, member: Member, is_newcomer: bool, pose: Pose, scale: float) -> None:
    """A dart at the pose, in its colour of `ABLE` or `UNABLE`; the newcomer's has a thick rim.

    `scale` is in inches per unit of the axes.
    """
    shape = np.array([(1.0, 0.0), (-0.8, 0.75), (-0.4, 0.0), (-0.8, -0.75)]) * ROBOT / scale
    cosine, sine = math.cos(pose.yaw), math.sin(pose.yaw)
    turned = shape @ np.array([(cosine, sine), (-sine, cosine)]) + (pose.x, pose.y)
    axes.add_patch(
        Polygon(
            turned,
            facecolor=ABLE if member.capability.can_manipulate else UNABLE,
            edgecolor=NEWCOMER if is_newcomer else "white",
            linewidth=2.2 if is_newcomer else 0.8,
            joinstyle="round",
            path_effects=[withStroke(linewidth=3.6, foreground=INK)] if is_newcomer else [],
            zorder=7.5,
        )
    )
