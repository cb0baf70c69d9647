"""What is compared, as one value that a process can build for itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from adhoc.evaluation.contender import Conditions, Contender
from adhoc.evaluation.scenario import Scenario
from adhoc.experiments.folder import EpisodeStore
from adhoc.experiments.run import Artifact, Progress, RunSummary, run_comparison
from adhoc.llm.model import LanguageModel
from adhoc.worlds.world import World


@dataclass(frozen=True)
class Comparison:
    """The arguments of `run_comparison` that do not depend on where records go."""

    world: World
    scenarios: Sequence[Scenario]
    conditions: Conditions
    newcomer: Contender | None
    join_step: int
    artifacts: Sequence[Artifact] = ()

    @property
    def episodes(self) -> int:
        """How many episodes there are of each scenario."""
        return 1 if self.newcomer is None else 2

    def run(self, folder: EpisodeStore, progress: Progress, only: int | None = None) -> RunSummary:
        """See `run_comparison`; `only` is the position of the one scenario to run, None runs all."""
        return run_comparison(
            self.world,
            self.scenarios if only is None else self.scenarios[only : only + 1],
            self.conditions,
            self.newcomer,
            self.join_step,
            folder,
            progress,
            self.artifacts,
        )


MakeComparison = Callable[[LanguageModel], Comparison]
"""Builds everything that is compared around the given language model; it is pickled and called in every
worker, so it is a function of a module, or a `functools.partial` of one with plain values."""
