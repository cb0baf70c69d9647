"""Simulated benchmarks whose true success rates are known: what the methods here are held against."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from adhoc.core.errors import ConfigurationError


@dataclass(frozen=True)
class Effects:
    """What the outcome of an episode hangs on besides the policy's own rate: standard deviations on the scale
    of the latent score, whose noise of the episode itself has 1.

    With the defaults two episodes of one policy in one house are correlated by about 0.1, which is what makes
    an interval that forgets the houses hold the truth in 8 of 10 cases instead of 95 of 100.
    """

    house: float = 0.5
    """How much easier some houses are, for every policy."""
    task: float = 0.7
    """How much easier some tasks of a house are, for every policy: what pairing takes out."""
    own: float = 0.3
    """How much better some houses suit one policy than others: what pairing leaves in."""


@dataclass(frozen=True)
class SimulatedBenchmarks:
    """Outcomes of every policy in every task of many benchmarks, each of other houses from one population."""

    successes: NDArray[np.bool_]
    """(B, C, T, P): benchmarks, houses, tasks in a house, policies."""
    rates: NDArray[np.float64]
    """(B, P) the true success rates in the population that the houses are drawn from."""


def simulate(
    draws: np.random.Generator,
    benchmarks: int,
    houses: int,
    tasks: int,
    rates: Sequence[float] | NDArray[np.float64],
    effects: Effects = Effects(),
) -> SimulatedBenchmarks:
    """Draw benchmarks: an episode succeeds if its policy's level and the effects and the noise add up to more
    than nothing, all normal, so that the true rates are exactly those asked for.

    Args:
        draws: Where from.
        benchmarks: How many, B.
        houses: In each, C.
        tasks: In each house, T.
        rates: (P,) of the policies, or (B, P).
        effects: What episodes have in common.

    Raises:
        ConfigurationError: a rate that is not between 0 and 1.
    """
    asked = np.asarray(rates, dtype=np.float64)
    if not ((asked > 0.0) & (asked < 1.0)).all():
        raise ConfigurationError(f"rates={asked.tolist()}: must be between 0 and 1")
    policies = asked.shape[-1]
    scale = math.sqrt(1.0 + effects.house**2 + effects.task**2 + effects.own**2)
    levels = scale * np.vectorize(NormalDist().inv_cdf)(asked)
    score = draws.standard_normal((benchmarks, houses, tasks, policies))
    score += effects.house * draws.standard_normal((benchmarks, houses, 1, 1))
    score += effects.task * draws.standard_normal((benchmarks, houses, tasks, 1))
    score += effects.own * draws.standard_normal((benchmarks, houses, 1, policies))
    score += levels.reshape(-1, 1, 1, policies)
    return SimulatedBenchmarks(score > 0.0, np.broadcast_to(asked, (benchmarks, policies)))
