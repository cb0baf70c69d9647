"""Why the intervals are what they are: five kinds of them over the same simulated benchmarks.

One table in Markdown, that of docs/statistics.md: how often 95% intervals of each kind hold the true success
of a policy, and the true difference of two. Takes a quarter of a minute.

    python benchmarks/other_intervals.py [BENCHMARKS]
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from statistics import NormalDist

import numpy as np
from rich.console import Console

from adhoc.core.streams import stream
from adhoc.statistics.intervals import FloatArray, expanded_tail
from adhoc.statistics.simulated import simulate
from adhoc.statistics.student import student_quantile

BENCHMARKS = 2_000
RESAMPLES = 2_000
SIZES = ((90, 15), (30, 1), (10, 15), (10, 3))
RATES = ((0.15, 0.20), (0.37, 0.43), (0.80, 0.85))

Bounds = tuple[FloatArray, FloatArray]


class Resampled:
    """Benchmarks of B x C houses with equally many tasks, and R means of each from drawn houses."""

    def __init__(self, houses: FloatArray) -> None:
        """`houses` (B, C) are the means of houses."""
        count = houses.shape[1]
        times = stream(0, "other intervals", count).multinomial(
            count, np.full(count, 1.0 / count), size=RESAMPLES
        )
        shares = times.T / count
        self.count = count
        self.houses = houses
        self.mean = houses.mean(axis=1)
        self.means = houses @ shares
        self.error = houses.std(axis=1, ddof=1) / np.sqrt(count)
        spread = np.maximum(houses**2 @ shares - self.means**2, 0.0)
        self.errors = np.sqrt(spread / (count - 1))


def plain(drawn: Resampled) -> Bounds:
    """Between the 2.5% and the 97.5% quantile of the resampled means."""
    low, high = np.quantile(drawn.means, [0.025, 0.975], axis=1)
    return low, high


def expanded(drawn: Resampled) -> Bounds:
    """Between quantiles further out: the one that is used."""
    tail = expanded_tail(0.95, drawn.count)
    low, high = np.quantile(drawn.means, [tail, 1.0 - tail], axis=1)
    return low, high


def student(drawn: Resampled) -> Bounds:
    """Student's quantiles around the mean, with the standard error over houses; no bootstrap."""
    away = student_quantile(0.975, drawn.count - 1) * drawn.error
    return drawn.mean - away, drawn.mean + away


def bootstrap_t(drawn: Resampled) -> Bounds:
    """The same with quantiles of resampled t-values; nothing is drawn where a resample has no spread."""
    with np.errstate(divide="ignore", invalid="ignore"):
        values = np.where(drawn.errors > 0.0, (drawn.means - drawn.mean[:, None]) / drawn.errors, 0.0)
    low, high = np.quantile(values, [0.025, 0.975], axis=1)
    return drawn.mean - high * drawn.error, drawn.mean - low * drawn.error


def bca(drawn: Resampled) -> Bounds:
    """Bias-corrected and accelerated quantiles, the acceleration by leaving out one house after the other."""
    normal = NormalDist()
    below = (drawn.means < drawn.mean[:, None]).mean(axis=1)
    below += 0.5 * (drawn.means == drawn.mean[:, None]).mean(axis=1)
    bias = _each(normal.inv_cdf, np.clip(below, 1.0 / RESAMPLES, 1.0 - 1.0 / RESAMPLES))
    away = drawn.houses - drawn.mean[:, None]
    squares = (away**2).sum(axis=1)
    bent = (away**3).sum(axis=1) / (6.0 * np.where(squares > 0.0, squares, 1.0) ** 1.5)
    ordered = np.sort(drawn.means, axis=1)
    bounds = []
    for tail in (0.025, 0.975):
        moved = bias + normal.inv_cdf(tail)
        share = _each(normal.cdf, bias + moved / (1.0 - bent * moved))
        place = np.clip(np.rint(share * (RESAMPLES - 1)).astype(int), 0, RESAMPLES - 1)
        bounds.append(ordered[np.arange(len(ordered)), place])
    return bounds[0], bounds[1]


KINDS: Mapping[str, Callable[[Resampled], Bounds]] = {
    "plain percentile": plain,
    "expanded percentile": expanded,
    "Student": student,
    "bootstrap-t": bootstrap_t,
    "BCa": bca,
}


def main() -> None:
    """Print the table."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else BENCHMARKS
    console = Console(soft_wrap=True, markup=False, highlight=False)
    console.print("| houses x tasks | true success | of | " + " | ".join(KINDS) + " |")
    console.print("|---:|---:|---|" + "---:|" * len(KINDS))
    for houses, tasks in SIZES:
        for rates in RATES:
            draws = stream(0, "other intervals", houses, tasks, *map(str, rates))
            outcomes = simulate(draws, count, houses, tasks, rates).successes.mean(axis=2)
            for name, values, truth in (
                ("success", outcomes[..., 0], rates[0]),
                ("difference", outcomes[..., 1] - outcomes[..., 0], rates[1] - rates[0]),
            ):
                drawn = Resampled(values)
                shares = (held(kind(drawn), truth) for kind in KINDS.values())
                told = " | ".join(f"{100.0 * share:.1f}" for share in shares)
                console.print(f"| {houses} x {tasks} | {rates[0]:.0%} and {rates[1]:.0%} | {name} | {told} |")


def held(bounds: Bounds, truth: float) -> float:
    """The share of benchmarks whose interval holds the truth."""
    low, high = bounds
    return float(((low - 1e-9 <= truth) & (truth <= high + 1e-9)).mean())


def _each(function: Callable[[float], float], values: FloatArray) -> FloatArray:
    return np.array([function(float(it)) for it in values])


if __name__ == "__main__":
    main()
