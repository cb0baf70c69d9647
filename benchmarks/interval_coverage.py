"""How well the statistics keep what they promise, over simulated benchmarks whose truth is known.

Three tables in Markdown, those of docs/statistics.md: how often 95% intervals hold the true value, how often
two equal policies are told apart, and how often two that differ are told apart in as many tasks as were said
to be needed. Takes about a quarter of a minute.

    python benchmarks/interval_coverage.py [BENCHMARKS]
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from rich.console import Console

from adhoc.core.streams import stream
from adhoc.statistics.coverage import coverage
from adhoc.statistics.paired_tests import mcnemar, sign_flip_test
from adhoc.statistics.power import LEVEL, design_effect, episodes_needed
from adhoc.statistics.simulated import Effects, SimulatedBenchmarks, simulate

BENCHMARKS = 1_000
SIZES = ((90, 15), (30, 15), (30, 3), (30, 1), (15, 2), (10, 15), (5, 15))
"""Houses, and tasks in each: the paper's benchmark and the 30 tasks of `sample` among them."""
RATES = {"10-25%": (0.10, 0.25), "30-60%": (0.30, 0.60), "75-85%": (0.75, 0.85)}
"""Every benchmark has a rate of its own out of such a range: with few tasks coverage depends on the last
digit of a rate, since shares of few tasks are few numbers."""
GAP = 0.10
"""The second policy is up to so much better."""
STRENGTHS = {"usual": Effects(), "strong": Effects(house=1.0, own=0.6)}

Gains = NDArray[np.int64]
"""(B, C, T): 1 where only the second policy succeeded, -1 where only the first did, else 0."""


def main() -> None:
    """Print the tables."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else BENCHMARKS
    console = Console(soft_wrap=True, markup=False, highlight=False)
    for lines in (coverage_rows(count), level_rows(count), power_rows(count)):
        for number, cells in enumerate(lines):
            console.print("| " + " | ".join(cells) + " |")
            if number == 0:
                console.print("|" + "---:|" * len(cells))
        console.print()


def coverage_rows(count: int) -> Iterator[Sequence[str]]:
    """How often intervals hold the truth."""
    yield (
        "houses x tasks",
        "true success",
        "houses differ",
        "success: houses forgotten",
        "success: plain percentile",
        "success: used",
        "difference: plain percentile",
        "difference: used",
    )
    for houses, tasks in SIZES:
        for name, span in RATES.items():
            for strength, effects in STRENGTHS.items():
                if tasks > 1 or strength == "usual":
                    drawn = _benchmarks(count, houses, tasks, span, effects)
                    plain, used = (coverage(drawn, expanded=expanded) for expanded in (False, True))
                    shares = (
                        forgetting(drawn),
                        plain.success,
                        used.success,
                        plain.difference,
                        used.difference,
                    )
                    yield (f"{houses} x {tasks}", name, strength, *(f"{100.0 * it:.1f}" for it in shares))


def forgetting(drawn: SimulatedBenchmarks) -> float:
    """The same for the success of the first policy and the textbook's interval for independent episodes."""
    outcomes = drawn.successes[..., 0]
    rates = outcomes.mean(axis=(1, 2))
    half = 1.96 * np.sqrt(rates * (1.0 - rates) / outcomes[0].size)
    return float((np.abs(rates - drawn.rates[:, 0]) <= half).mean())


def level_rows(count: int) -> Iterator[Sequence[str]]:
    """How often two equal policies are told apart."""
    yield ("houses x tasks", "policies suit houses", "McNemar", "by houses")
    for houses, tasks in SIZES:
        for own in (0.0, 0.3, 0.6):
            draws = stream(0, "level", houses, tasks, str(own))
            gains = _gains(simulate(draws, count, houses, tasks, (0.4, 0.4), Effects(own=own)))
            yield (f"{houses} x {tasks}", f"{own:g}", *(f"{100.0 * it:.1f}" for it in told_apart(gains)))


def power_rows(count: int) -> Iterator[Sequence[str]]:
    """How often policies are told apart in as many tasks as are said to be needed for 80%."""
    yield ("tasks in a house", "true success", "policies suit houses", "deff", "tasks (houses)", "told apart")
    for tasks in (15, 3, 1):
        for rates in ((0.15, 0.20), (0.35, 0.45), (0.20, 0.40)):
            for own in (0.3, 0.6):
                draws = stream(0, "power", tasks, *map(str, rates), str(own))
                effects = Effects(own=own)
                known = _gains(simulate(draws, 1, 20_000, tasks, rates, effects))[0]
                effect = design_effect(known.ravel(), np.repeat(np.arange(len(known)).astype(str), tasks))
                share = float(np.abs(known).mean())
                needed = episodes_needed(rates[1] - rates[0], share, design_effect=effect)
                houses = -int(-needed // tasks)
                _, told = told_apart(_gains(simulate(draws, count, houses, tasks, rates, effects)))
                size = (f"{effect:.2f}", f"{needed:,.0f} ({houses:,})")
                yield (
                    str(tasks),
                    f"{rates[0]:.0%}, {rates[1]:.0%}",
                    f"{own:g}",
                    *size,
                    f"{100.0 * told:.1f}",
                )


def told_apart(gains: Gains) -> tuple[float, float]:
    """The shares of benchmarks in which McNemar's test and that by houses find a difference."""
    wins, losses = (gains > 0).sum(axis=(1, 2)).tolist(), (gains < 0).sum(axis=(1, 2)).tolist()
    episodes = sum(mcnemar(*counts) <= LEVEL for counts in zip(wins, losses))
    houses = sum(sign_flip_test(it) <= LEVEL for it in gains.sum(axis=2).tolist())
    return episodes / len(gains), houses / len(gains)


def _benchmarks(
    count: int, houses: int, tasks: int, span: tuple[float, float], effects: Effects
) -> SimulatedBenchmarks:
    draws = stream(0, "coverage", houses, tasks, str(span), str(effects))
    first = draws.uniform(*span, size=count)
    rates = np.stack([first, first + draws.uniform(0.0, GAP, size=count)], axis=1)
    return simulate(draws, count, houses, tasks, rates, effects)


def _gains(drawn: SimulatedBenchmarks) -> Gains:
    outcomes = drawn.successes.astype(np.int64)
    return np.asarray(outcomes[..., 1] - outcomes[..., 0])


if __name__ == "__main__":
    main()
