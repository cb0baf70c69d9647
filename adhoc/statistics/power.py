"""How many tasks it takes to tell two policies apart by success, from a pilot of some."""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from adhoc.core.errors import ConfigurationError
from adhoc.statistics.intervals import Houses, Values
from adhoc.statistics.paired import success_differences

LEVEL = 0.05
"""Probability of telling two equal policies apart."""
POWER = 0.8
"""Probability of telling two apart that differ as assumed."""
_HALVINGS = 40


@dataclass(frozen=True)
class Pilot:
    """What episodes that are there say about episodes to come."""

    pairs: int
    """Tasks that both policies have done."""
    houses: int
    difference: float
    """Of the success rates, between -1 and 1."""
    discordant: float
    """The share of tasks in which one of the two succeeded and the other did not."""
    design_effect: float
    """How many times as many tasks are needed because tasks of one house resemble each other; at least 1,
    infinite where a single house tells nothing of it."""

    def houses_for(self, pairs: float) -> float:
        """Houses for so many tasks, with as many tasks in each as the pilot has."""
        return math.ceil(pairs * self.houses / self.pairs) if math.isfinite(pairs) else math.inf


def pilot(first: Values, second: Values, houses: Houses) -> Pilot:
    """What the success of two policies in the same tasks says.

    Raises:
        ConfigurationError: no tasks, not one entry of each for every task, or an outcome that is no success
            or failure.
    """
    gains = success_differences(first, second, houses)
    return Pilot(
        len(gains),
        len(np.unique(np.asarray(houses))),
        float(gains.mean()),
        float(np.abs(gains).mean()),
        design_effect(gains, houses),
    )


def design_effect(values: Values, houses: Houses) -> float:
    """The variance of the mean with houses as clusters over that with independent episodes, at least 1.

    Below 1 it is chance for all that we know, so it is not believed. 1 where no value differs, and with one
    task in each house, which tells nothing of how tasks of one house resemble each other. Infinite for a
    single house.
    """
    numbers = np.asarray(values, dtype=np.float64)
    names, of = np.unique(np.asarray(houses), return_inverse=True)
    if len(names) == 1:
        return math.inf
    away = numbers - numbers.mean()
    alone = float(away @ away)
    if alone == 0.0:
        return 1.0
    together = np.bincount(of, away)
    corrections = len(names) / (len(names) - 1) * (len(numbers) - 1) / len(numbers)
    return max(1.0, float(together @ together) / alone * corrections)


def episodes_needed(
    difference: float,
    discordant: float,
    level: float = LEVEL,
    power: float = POWER,
    design_effect: float = 1.0,
) -> float:
    """Tasks that both policies must do for an exact test to tell them apart; infinite for no difference.

    Connor's formula for McNemar's test (Biometrics 43, 1987), one divided by the difference more because the
    exact test counts whole tasks, times the design effect.

    Args:
        difference: The true difference of the success rates, from -1 to 1, without 0 to get a finite number.
        discordant: The share of tasks in which just one succeeds, at least the difference.
        level: Probability of telling equal policies apart (two-sided).
        power: Probability of telling these apart.
        design_effect: See `Pilot`.

    Raises:
        ConfigurationError: a share, level, power or design effect that is none, or fewer discordant tasks
            than the difference needs.
    """
    distance = abs(difference)
    for name, value in (("level", level), ("power", power)):
        if not 0.0 < value < 1.0:
            raise ConfigurationError(f"{name}={value}: must be between 0 and 1")
    if not distance <= discordant <= 1.0:
        raise ConfigurationError(
            f"discordant={discordant}: must be between the difference, {distance}, and 1"
        )
    if not design_effect > 0.0:
        raise ConfigurationError(f"design_effect={design_effect}: must be above 0")
    if distance == 0.0 or not math.isfinite(design_effect):
        return math.inf
    normal = NormalDist()
    chance = normal.inv_cdf(1.0 - level / 2.0) * math.sqrt(discordant)
    sure = normal.inv_cdf(power) * math.sqrt(discordant - distance**2)
    return math.ceil((((chance + sure) / distance) ** 2 + 1.0 / distance) * design_effect)


def detectable_difference(
    pairs: int,
    discordant: float,
    level: float = LEVEL,
    power: float = POWER,
    design_effect: float = 1.0,
) -> float | None:
    """The smallest difference that so many tasks tell from nothing; None if they do not for any.

    Where the difference would need more discordant tasks than there are, there are as many as it needs. The
    other arguments and errors are those of `episodes_needed`.
    """

    def enough(difference: float) -> bool:
        share = max(discordant, difference)
        return episodes_needed(difference, share, level, power, design_effect) <= pairs

    if not enough(1.0):
        return None
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if enough(middle) else (middle, high)
    return high


def mcnemar_power(pairs: int, difference: float, discordant: float, level: float = LEVEL) -> float:
    """The probability that McNemar's exact test tells two policies apart in so many independent tasks.

    Counted over every possible table, no approximation: what `episodes_needed` is held against.

    Raises:
        ConfigurationError: fewer discordant tasks than the difference needs.
    """
    if not abs(difference) <= discordant <= 1.0:
        raise ConfigurationError(
            f"discordant={discordant}: must be between the difference, {abs(difference)}, and 1"
        )
    if discordant == 0.0:
        return 0.0
    share = 0.5 + 0.5 * difference / discordant
    total = 0.0
    for count, weight in enumerate(_binomial(pairs, discordant)):
        if weight < 1e-12:
            continue
        tails = 2.0 * np.cumsum(_binomial(count, 0.5)[: count // 2 + 1])
        beyond = int((tails <= level).sum())
        outcomes = _binomial(count, share)
        total += weight * float(outcomes[:beyond].sum() + outcomes[count + 1 - beyond :].sum())
    return total


def _binomial(trials: int, probability: float) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Probabilities (trials + 1,) of 0, 1, ..., all successes."""
    if probability in (0.0, 1.0):
        certain = np.zeros(trials + 1)
        certain[-1 if probability else 0] = 1.0
        return certain
    factorials = np.concatenate([[0.0], np.cumsum(np.log(np.arange(1, trials + 1)))])
    counts = np.arange(trials + 1)
    logs = factorials[-1] - factorials - factorials[::-1]
    logs = logs + counts * math.log(probability) + counts[::-1] * math.log1p(-probability)
    return np.asarray(np.exp(logs))
