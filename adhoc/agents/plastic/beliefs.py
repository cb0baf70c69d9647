"""Beliefs over types of teams, updated as in PLASTIC-Policy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from adhoc.core.errors import ConfigurationError


class Beliefs:
    """How probable each known type of team is, given what its members were seen to do.

    Polynomial weights (Barrett, Rosenfeld, Kraus, Stone: Making Friends on the Fly, 2017, PLASTIC-Policy):
    after every observation, P(type) is multiplied by 1 - eta * loss, with
    loss = 1 - P(observation | type), and all are normalised. A type that predicted badly loses weight by
    and by and never at once: no type fits a stranger exactly.

    Args:
        types: The names of the types; all are equally probable at first.
        eta: How much one observation can change, above 0 and at most 1/2, the range in which polynomial
            weights bound the regret. Barrett et al. use 0.1 with an observation at every step of long
            games; a house has few observations, each telling, hence 1/2.

    Raises:
        ConfigurationError: There is no type, a type is named twice, or `eta` is out of its range.
    """

    def __init__(self, types: Sequence[str], eta: float = 0.5) -> None:
        if not types or len(set(types)) != len(types):
            raise ConfigurationError(f"types={list(types)}: must be one or more different names")
        if not 0.0 < eta <= 0.5:
            raise ConfigurationError(f"eta={eta}: must be above 0 and at most 0.5")
        self.types = tuple(types)
        self._eta = eta
        self._weights = np.zeros(len(self.types))

    def update(self, probabilities: Mapping[str, float]) -> None:
        """Take in one observation: how probable each type's model held it to be, 0 to 1.

        Raises KeyError if a type is missing, and ConfigurationError for a number that is no probability;
        beliefs are then as before.
        """
        for name in self.types:
            if not 0.0 <= probabilities[name] <= 1.0:
                raise ConfigurationError(
                    f"probability {probabilities[name]} by the model of type {name!r}: must be 0 to 1"
                )
        loss = 1.0 - np.array([probabilities[name] for name in self.types])
        self._weights += np.log1p(-self._eta * loss)

    @property
    def probabilities(self) -> Mapping[str, float]:
        """The belief in each type; they sum to 1."""
        weights = np.exp(self._weights - self._weights.max())
        return dict(zip(self.types, (weights / weights.sum()).tolist()))

    @property
    def most_likely(self) -> str:
        """The type believed in most; the earlier one of `types` where two are equal."""
        return self.types[int(self._weights.argmax())]
