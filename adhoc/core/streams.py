"""Independent random streams.

Every agent, every scenario and every model draws from its own stream, derived from the seed and its
own name, so that adding a robot to a team disturbs nobody else's draws.
"""

from __future__ import annotations

import hashlib

import numpy as np


def derive_seed(seed: int, *names: str | int) -> int:
    """A 63-bit seed that depends on `seed` and on every name, equal on every machine."""
    digest = hashlib.sha256(repr((int(seed), *names)).encode()).digest()
    return int.from_bytes(digest[:8], "big") >> 1


def stream(seed: int, *names: str | int) -> np.random.Generator:
    """The random stream of `names` under `seed`, e.g. `stream(0, "agent", "teammate_1")`."""
    return np.random.default_rng(derive_seed(seed, *names))
