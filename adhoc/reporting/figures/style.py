"""How figures look: colours that colour-blind readers tell apart, sizes that a column of a paper bears."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from contextlib import contextmanager

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from adhoc.reporting.contestants import Contestant
from adhoc.reporting.paper_order import POLICIES
from adhoc.statistics.intervals import Interval

COLUMN_WIDTH = 3.45
"""Inches, of a two-column page."""
COLOURS = ("#000000", "#56B4E9", "#E69F00", "#8C6D46", "#009E73", "#CC79A7", "#0072B2", "#D55E00")
"""Those of Okabe and Ito (Color Universal Design, 2008), with a brown in place of their yellow, which white
paper swallows: one for each of `POLICIES`, by which a policy has the same colour in all figures."""
MARKERS = ("s", "o", "^", "D", "v", "<", ">", "P")
ALONE_COLOUR = "#8a8f98"
INK = "#1b1f24"
STEP_COLOURS = ("#2f74b5", "#7fb3dc", "#cfe3f3", "#ecf3fa")
"""Dark to light, so that they differ in grey as well; none so dark that an interval on it is lost."""
CHARACTERS_OF_TITLE = 66
DOTS_PER_INCH = 300


@contextmanager
def paper_style() -> Iterator[None]:
    """Small type, thin lines, and equal files for equal numbers."""
    settings = {
        "font.size": 7.0,
        "axes.titlesize": 7.5,
        "axes.labelsize": 7.5,
        "xtick.labelsize": 7.0,
        "ytick.labelsize": 7.0,
        "legend.fontsize": 6.8,
        "axes.linewidth": 0.6,
        "xtick.major.width": 0.6,
        "ytick.major.width": 0.6,
        "hatch.linewidth": 0.5,
        "svg.hashsalt": "adhoc",
    }
    with rc_context(settings):
        yield


def policy_look(who: Contestant, number: int) -> tuple[str, str]:
    """Colour and marker of a policy; those that the paper does not have take turns by their number."""
    place = POLICIES.index(who.policy) if who.policy in POLICIES else number
    return COLOURS[place % len(COLOURS)], MARKERS[place % len(MARKERS)]


def put_title(figure: Figure, *lines: str) -> None:
    """A title of small type, broken into lines that fit a column; the first line says what is shown."""
    wrapped = [part for line in lines for part in textwrap.wrap(line, CHARACTERS_OF_TITLE)]
    figure.suptitle("\n".join(wrapped), x=0.02, ha="left", fontsize=7.0)


def tidy(axes: Axes) -> None:
    """Faint lines to read values by, no frame."""
    axes.grid(axis="y", color="#e3e6ea", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.tick_params(length=2.5)


UNKNOWN = "?"
"""Stands beside a mean whose interval is not known; see `Interval.tells_spread`."""


def put_unknown(axes: Axes, at: float, interval: Interval, offset: tuple[float, float]) -> None:
    """A question mark beside what has no whisker since nothing is known of how far it can be trusted: a mean
    without either would look certain."""
    if not interval.tells_spread:
        axes.annotate(
            UNKNOWN,
            (at, interval.mean),
            offset,
            textcoords="offset points",
            ha="center",
            va="center",
            fontsize=6.0,
            color=INK,
        )


def whisker(interval: Interval) -> tuple[float, float]:
    """How far the interval reaches below and above its mean; nowhere if the episodes do not tell, where no
    whisker is drawn."""
    if not interval.tells_spread:
        return (0.0, 0.0)
    return (max(0.0, interval.mean - interval.low), max(0.0, interval.high - interval.mean))
