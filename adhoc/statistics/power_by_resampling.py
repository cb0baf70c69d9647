"""How often a test would tell two policies apart in so many houses like those of a pilot."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from adhoc.core.errors import ConfigurationError
from adhoc.core.streams import stream
from adhoc.statistics.paired_tests import sign_flip_test
from adhoc.statistics.power import LEVEL

RUNS = 500


def resampled_power(
    by_house: Sequence[int], houses: int, level: float = LEVEL, runs: int = RUNS, seed: int = 0
) -> float:
    """The share of runs in which the test by houses tells the two apart.

    In each run so many houses are drawn with replacement from the pilot's, each with the outcomes that it
    had. Nothing is assumed of how tasks of a house hang together; instead, the pilot's houses are taken for
    all that there are, and its difference for the true one, which a small pilot does not know well.

    Args:
        by_house: (C,) wins less losses of the first policy in each house of the pilot, zeros too.
        houses: In each run.
        level: Of the test.
        runs: How many. With 500 the share is known to 2 points (one standard error).
        seed: Of the draws.

    Raises:
        ConfigurationError: no houses, or no runs.
    """
    if not len(by_house) or houses < 1 or runs < 1:
        raise ConfigurationError(
            f"{len(by_house)} houses in the pilot, houses={houses}, runs={runs}: must be at least 1"
        )
    drawn = stream(seed, "power").choice(np.asarray(by_house, dtype=np.int64), size=(runs, houses))
    return sum(sign_flip_test(run.tolist()) <= level for run in drawn) / runs
