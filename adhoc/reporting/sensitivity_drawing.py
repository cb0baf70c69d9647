"""The figure of success against error rates."""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from adhoc.core.counting import counted
from adhoc.reporting.few_houses import few_houses
from adhoc.reporting.figures.style import whisker
from adhoc.reporting.sensitivity import MISTAKES, Sensitivity

COLOURS = ("#2a78b5", "#d1242f", "#3c9d6b", "#8f5aa8", "#e09f1f", "#7a4a2b", "#14181f", "#c4589a")
MARKERS = "os^Dv<>p"
ASIDE = 0.012
"""Policies stand this share of the axis apart, so that no marker hides another."""
LEAST = 5.0
"""Points up and down that are shown at least, so that nothing looks large that is not."""
DPI = 120


def draw_sensitivity(found: Sensitivity, path: Path) -> None:
    """Draw one panel for each kind of mistake: for each policy, how many points of success it is over the
    team alone, and the interval of that.

    PNG, SVG or PDF, by the name. Creates the folder. Overwrites the file.
    """
    figure = Figure(figsize=(11.5, 4.9), dpi=DPI, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, len(MISTAKES), sharey=True)
    for axes, kind in zip(panels, MISTAKES):
        _draw_panel(axes, found, kind)
    panels[0].set_ylabel("%Suc over the team alone, in points", fontsize=9)
    handles, names = panels[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=5, fontsize=8, frameon=False)
    few = "".join(f"\n{it}" for it in few_houses([found.houses]))
    figure.suptitle(
        f"Success by how often the offline reasoner errs · model: {found.model}\n"
        f"{found.team} team, joined at step {found.join_step}; alone it does {found.alone:.1f}%; "
        f"{counted(found.scenarios, 'paired scenario')}; bars: 95% by bootstrap over "
        f"{counted(found.houses, 'house')}{few}",
        fontsize=10,
        x=0.01,
        ha="left",
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=DPI)


def _draw_panel(axes: Axes, found: Sensitivity, kind: str) -> None:
    axes.axhline(0.0, color="#8a8f98", linewidth=1.0, linestyle="--", label="the team alone", zorder=1)
    width = max(found.rates) or 1.0
    for number, policy in enumerate(found.policies):
        shift = width * ASIDE * (number - (len(found.policies) - 1) / 2)
        shown = [
            (rate + shift, it.over_alone)
            for rate in found.rates
            if (it := found.places.get((kind, rate, policy))) is not None
        ]
        means = [gain.mean for _, gain in shown]
        axes.errorbar(
            [rate for rate, _ in shown],
            means,
            yerr=tuple(zip(*(whisker(gain) for _, gain in shown))),
            color=COLOURS[number % len(COLOURS)],
            marker=MARKERS[number % len(MARKERS)],
            markersize=4.5,
            linewidth=1.4,
            elinewidth=0.7,
            label=policy,
        )
    axes.set_title(kind.replace("_", " "), fontsize=9, loc="left")
    axes.set_xlabel("probability per call", fontsize=8)
    axes.set_xticks(list(found.rates), [f"{rate:g}" for rate in found.rates])
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, -LEAST), max(high, LEAST))
    axes.grid(axis="y", color="#e6e8eb", linewidth=0.8)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(labelsize=8)
