"""What is compared: a team in its scenarios, alone and with each of several newcomers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import overload

from adhoc.evaluation.contender import Conditions, Contender
from adhoc.evaluation.episode_key import EpisodeKey, EpisodeKind
from adhoc.evaluation.episode_result import EpisodeResult
from adhoc.evaluation.records import Record
from adhoc.evaluation.scenario import Scenario
from adhoc.llm.model import LanguageModel
from adhoc.worlds.world import World

Artifact = Callable[[EpisodeKey, EpisodeResult, Record], None]
"""Draws or writes something of a fresh episode; called before its record is stored."""


@dataclass(frozen=True)
class Entrant:
    """A newcomer that joins at a step."""

    newcomer: Contender
    join_step: int
    run: str = ""
    """See `EpisodeKind`."""


@dataclass(frozen=True)
class Comparison:
    """A team in its scenarios: alone, and with each of the entrants.

    The episode of the team alone is run once in a scenario and serves all entrants.
    """

    world: World
    """Is reset for every episode."""
    scenarios: Sequence[Scenario]
    """Lazy ones are loaded one at a time."""
    conditions: Conditions
    entrants: tuple[Entrant, ...] = ()
    artifacts: tuple[Artifact, ...] = ()
    run: str = ""
    """Of the team alone, see `EpisodeKind`."""

    @cached_property
    def kinds(self) -> tuple[EpisodeKind, ...]:
        """Of the episodes of every scenario, in the order in which they are run: the team alone first."""
        joined = (EpisodeKind(self.conditions, it.newcomer, it.join_step, it.run) for it in self.entrants)
        return (EpisodeKind(self.conditions, run=self.run), *joined)


class Comparisons(Sequence[Comparison]):
    """Comparisons that are built when they are asked for, and kept.

    Args:
        makers: One for each; they may share worlds.
    """

    def __init__(self, makers: Sequence[Callable[[], Comparison]]) -> None:
        self._makers = tuple(makers)
        self._built: dict[int, Comparison] = {}

    def __len__(self) -> int:
        return len(self._makers)

    @overload
    def __getitem__(self, index: int) -> Comparison: ...

    @overload
    def __getitem__(self, index: slice) -> Sequence[Comparison]: ...

    def __getitem__(self, index: int | slice) -> Comparison | Sequence[Comparison]:
        places = range(len(self._makers))[index]
        return [self._get(place) for place in places] if isinstance(places, range) else self._get(places)

    def close(self) -> None:
        """Close all worlds."""
        for world in {id(it.world): it.world for it in self._built.values()}.values():
            world.close()

    def _get(self, place: int) -> Comparison:
        if place not in self._built:
            self._built[place] = self._makers[place]()
        return self._built[place]


MakeComparisons = Callable[[LanguageModel], Comparisons]
"""Builds everything that is compared around the given language model; it is pickled and called in every
worker, so it is a function of a module, or a `functools.partial` of one with plain values."""
