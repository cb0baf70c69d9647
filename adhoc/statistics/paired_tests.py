"""Is one policy more successful than another on the same tasks, or is it chance? Two exact tests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.intervals import Houses, Values
from adhoc.statistics.paired import success_differences


@dataclass(frozen=True)
class PairedTest:
    """Two policies on the same tasks, counted and tested. All p-values are exact and two-sided."""

    pairs: int
    """Tasks that both have done."""
    houses: int
    wins: int
    """Tasks in which the first succeeded and the second did not."""
    losses: int
    """Tasks in which the second succeeded and the first did not."""
    p_episodes: float
    """McNemar's test: discordant tasks are independent of each other."""
    p_houses: float
    """Houses are independent of each other, tasks in one house need not be."""

    @property
    def difference(self) -> float:
        """Of the success rates, between -1 and 1."""
        return (self.wins - self.losses) / self.pairs


def paired_test(first: Values, second: Values, houses: Houses) -> PairedTest:
    """Count and test two policies by their success in the same tasks.

    Args:
        first: The success of one policy in each task, 1 or 0.
        second: That of the other, in the same order.
        houses: The house of each task.

    Raises:
        ConfigurationError: no tasks, not one entry of each for every task, or an outcome that is no success
            or failure.
    """
    gains = success_differences(first, second, houses)
    names, of = np.unique(np.asarray(houses), return_inverse=True)
    by_house = np.rint(np.bincount(of, gains)).astype(np.int64)
    wins, losses = int((gains > 0).sum()), int((gains < 0).sum())
    return PairedTest(
        len(gains), len(names), wins, losses, mcnemar(wins, losses), sign_flip_test(by_house.tolist())
    )


def mcnemar(wins: int, losses: int) -> float:
    """McNemar's exact test: how likely discordant tasks fall at least as unevenly if each is a fair coin.

    Twice the smaller tail of the binomial distribution of `wins` among `wins + losses`, at most 1, in place
    of McNemar's approximation (Psychometrika 12, 1947). Concordant tasks do not matter.

    Raises:
        ConfigurationError: a negative count.
    """
    if min(wins, losses) < 0:
        raise ConfigurationError(f"wins={wins}, losses={losses}: counts are at least 0")
    discordant, ways, tail = wins + losses, 1, 0
    for number in range(min(wins, losses) + 1):
        tail += ways
        ways = ways * (discordant - number) // (number + 1)
    return min(1.0, 2 * tail / (1 << discordant))


def sign_flip_test(by_house: Sequence[int]) -> float:
    """How likely the sum over houses is at least as far from 0 if each house's sign is a fair coin.

    `by_house` are a house's wins less its losses. Whatever joins the tasks of one house is kept: only whole
    houses change sides, as in Fisher's randomisation test, by whole numbers, so that the distribution of the
    sum is counted and not drawn. With at most one discordant task in each house it is McNemar's test.
    """
    steps = [abs(int(it)) for it in by_house if it]
    reach = sum(steps)
    shares: NDArray[np.float64] = np.zeros(reach + 1)
    shares[0] = 1.0
    for step in steps:
        flipped = shares.copy()
        flipped[step:] += shares[:-step]
        shares = 0.5 * flipped
    away = abs(sum(int(it) for it in by_house))
    return min(1.0, 2.0 * float(shares[: (reach - away) // 2 + 1].sum()))
