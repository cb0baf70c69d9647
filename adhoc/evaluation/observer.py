"""Looking on while an episode is run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from adhoc.agents.policy import Policy, Turn
from adhoc.core.values import Observation
from adhoc.worlds.world import World


class EpisodeObserver(Protocol):
    """Is shown an episode while it is run, for pictures and inspectors. It changes nothing: the history of an
    episode is the same with every observer."""

    def look(
        self,
        step: int,
        world: World,
        policies: Mapping[str, Policy],
        observations: Mapping[str, Observation],
        turns: Mapping[str, Turn],
    ) -> None:
        """The moment after `step` steps, when all robots have decided and none has acted yet; and the end of
        the episode, when nobody decides (`turns` is empty).

        Args:
            step: Steps that were run.
            world: As it is now; to be looked at, not changed.
            policies: By robot, as they think: with their faults, if they have any.
            observations: What each robot present sees now.
            turns: What each robot that still acts is about to do, and why.
        """


class _Blind:
    def look(
        self,
        step: int,
        world: World,
        policies: Mapping[str, Policy],
        observations: Mapping[str, Observation],
        turns: Mapping[str, Turn],
    ) -> None:
        """See `EpisodeObserver`: looks away."""


BLIND: EpisodeObserver = _Blind()
"""Nobody looks on."""
