"""Real against generated houses as one figure: distributions of numbers, and frequencies of names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, PercentFormatter

from adhoc.dataset.likeness import likeness_statistics as statistics
from adhoc.dataset.likeness.comparison import Likeness, Row

REAL = "#3c3f45"
GENERATED = "#e07b1f"
GRID = "#dddddd"
DPI = 130
WIDTH = 13.0
HEAD, CURVES, BARS = 0.5, 1.55, 2.5
"""Inches: of the title, and of one row of curves and of bars."""
SHOWN_NAMES = 9
"""Names with a bar; the shares of the others are written."""

NUMBERS: Mapping[str, str] = {
    statistics.AREA: "floor area\n(m²)",
    statistics.CEILING: "ceiling height\n(m)",
    statistics.WINDOWS: "windows\n(number)",
    statistics.FURNITURE: "furniture\n(pieces)",
    statistics.ITEMS: "items\n(number)",
    statistics.HOLDING: "receptacles that\nhold items (number)",
    statistics.COVERED: "floor covered by\nfurniture (share)",
    statistics.FREE: "free space\n(share of the floor)",
}
"""The numbers drawn, with their labels."""
WHOLE_NUMBERS = (statistics.WINDOWS, statistics.FURNITURE, statistics.ITEMS, statistics.HOLDING)
FREQUENCIES: Mapping[str, str] = {
    statistics.FURNITURE_TYPES: "furniture, by type",
    statistics.ITEM_TYPES: "items, by type",
    statistics.HOLDER_TYPES: "items, by their place",
}


def draw_likeness(likeness: Likeness, path: Path) -> None:
    """Draw the main rows into a PNG file: per room type, cumulative distributions and bars of frequencies.

    Each panel says its distance D and, in brackets, the noise floor (or how few the real numbers are).
    Creates the folder, overwrites the file.
    """
    groups = [group for group in likeness.groups() if group != statistics.WHOLE_HOUSE]
    heights = (HEAD, CURVES * len(groups) + 0.5, BARS * len(groups) + 0.4)
    figure = Figure(figsize=(WIDTH, sum(heights)), dpi=DPI, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    head, curves, bars = figure.subfigures(3, 1, height_ratios=heights)
    _draw_head(head, likeness)
    _draw_curves(curves, likeness, groups)
    _draw_bars(bars, likeness, groups)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=DPI)


def _draw_head(figure: SubFigure, likeness: Likeness) -> None:
    figure.text(
        0.01,
        0.5,
        "Generated against real houses: D is the Kolmogorov-Smirnov distance (curves) or total variation "
        "(bars), in brackets that of two halves of the real ones",
        fontsize=8.5,
        va="center",
    )
    handles = [
        Line2D([], [], color=REAL, linewidth=4, label=f"real (houses: {likeness.real_houses})"),
        Line2D(
            [], [], color=GENERATED, linewidth=4, label=f"generated (houses: {likeness.generated_houses})"
        ),
    ]
    figure.legend(handles=handles, loc="center right", ncols=2, fontsize=9, frameon=False)


def _draw_curves(figure: SubFigure, likeness: Likeness, groups: Sequence[str]) -> None:
    shown = [name for name in NUMBERS if any(_row(likeness, name, group) for group in groups)]
    panels = figure.subplots(len(groups), len(shown), sharex="col", sharey=True, squeeze=False)
    for panel_row, group in zip(panels, groups):
        panel_row[0].set_ylabel(f"{group}\nshare of rooms ≤ x", fontsize=8)
        for axes, statistic in zip(panel_row, shown):
            row = _row(likeness, statistic, group)
            if row is None:
                axes.set_axis_off()
                continue
            _draw_distribution(axes, row.real, REAL)
            _draw_distribution(axes, row.generated, GENERATED)
            axes.set_title(_distance_text(row), fontsize=7.5, loc="right", pad=2)
            axes.set_ylim(0, 1.02)
            axes.xaxis.set_major_locator(MaxNLocator(3, integer=statistic in WHOLE_NUMBERS))
            _clean(axes)
    for axes, statistic in zip(panels[-1], shown):
        axes.set_xlabel(NUMBERS[statistic], fontsize=8)


def _draw_distribution(axes: Axes, values: Sequence[float] | Mapping[str, float], colour: str) -> None:
    """The share of values up to x, as steps."""
    ordered = np.sort(np.array(list(values), dtype=float))
    share = np.arange(1, len(ordered) + 1) / len(ordered)
    axes.step(
        np.concatenate([ordered[:1], ordered]),
        np.concatenate([[0.0], share]),
        where="post",
        color=colour,
        lw=1.4,
    )


def _draw_bars(figure: SubFigure, likeness: Likeness, groups: Sequence[str]) -> None:
    panels = figure.subplots(len(groups), len(FREQUENCIES), squeeze=False)
    for panel_row, group in zip(panels, groups):
        for axes, (statistic, label) in zip(panel_row, FREQUENCIES.items()):
            row = _row(likeness, statistic, group)
            if row is None:
                axes.set_axis_off()
                continue
            _draw_frequencies(axes, row)
            axes.set_title(f"{group}: {label}", fontsize=8.5, loc="left", pad=3)
            axes.set_title(_distance_text(row), fontsize=7.5, loc="right", pad=3)
            axes.xaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
            axes.xaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
            _clean(axes)
    for axes, label in zip(panels[-1], ("furniture pieces", "items", "items")):
        axes.set_xlabel(f"share of all {label} of the room type", fontsize=8)


def _draw_frequencies(axes: Axes, row: Row) -> None:
    """A pair of bars for each of the most frequent names of both."""
    assert isinstance(row.real, Mapping)
    assert isinstance(row.generated, Mapping)
    real, generated = row.real, row.generated
    largest = sorted(
        {*real, *generated}, key=lambda name: (-max(real.get(name, 0.0), generated.get(name, 0.0)), name)
    )
    names = sorted(largest[:SHOWN_NAMES], key=lambda name: (-real.get(name, 0.0), name))
    places = np.arange(len(names))
    others = []
    for offset, values, colour in ((-0.2, real, REAL), (0.2, generated, GENERATED)):
        lengths = [values.get(name, 0.0) for name in names]
        others.append(sum(values.values()) - sum(lengths))
        axes.barh(places + offset, lengths, height=0.4, color=colour)
    axes.set_yticks(places, names)
    axes.set_ylim(SHOWN_NAMES + 0.3, -0.6)
    if len(largest) > len(names):
        text = f"{len(largest) - len(names)} others: real {others[0]:.0%}, generated {others[1]:.0%}"
        axes.text(0.99, 0.03, text, transform=axes.transAxes, fontsize=7.5, ha="right", color=REAL)


def _clean(axes: Axes) -> None:
    axes.tick_params(labelsize=7.5, length=2)
    axes.grid(axis="x", color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def _distance_text(row: Row) -> str:
    noise = f"{row.real_count} real" if row.noise is None else f"{row.noise:.2f}"
    return f"D = {row.distance:.2f} ({noise})"


def _row(likeness: Likeness, statistic: str, group: str) -> Row | None:
    try:
        return likeness.row(statistic, group)
    except KeyError:
        return None
