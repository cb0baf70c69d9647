"""Scenarios that are made when they are needed, so that a long list of them needs little memory."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from typing import overload

from adhoc.core.errors import ConfigurationError
from adhoc.evaluation.scenario import Scenario

KEPT = 4
"""Scenarios that are kept at a time, by default."""


class LazyScenarios(Sequence[Scenario]):
    """A sequence of scenarios whose ids are known and whose contents are loaded on access.

    A slice is lazy, too, and shares nothing but `load` with the whole.

    Args:
        ids: of all scenarios, in order.
        load: makes the scenario of a position in `ids`; equal positions must give equal scenarios.
        kept: how many of the latest loaded scenarios are kept.
    """

    def __init__(self, ids: Sequence[str], load: Callable[[int], Scenario], kept: int = KEPT) -> None:
        self._ids = tuple(ids)
        self._load = load
        self._kept = kept
        self._loaded: OrderedDict[int, Scenario] = OrderedDict()

    @property
    def ids(self) -> tuple[str, ...]:
        """The ids of all scenarios, in order; nothing is loaded for them."""
        return self._ids

    def __len__(self) -> int:
        return len(self._ids)

    @overload
    def __getitem__(self, index: int) -> Scenario: ...

    @overload
    def __getitem__(self, index: slice) -> LazyScenarios: ...

    def __getitem__(self, index: int | slice) -> Scenario | LazyScenarios:
        if isinstance(index, slice):
            positions = range(len(self._ids))[index]
            chosen = [self._ids[position] for position in positions]
            return LazyScenarios(chosen, lambda place: self._load(positions[place]), self._kept)
        return self._get(range(len(self._ids))[index])

    def _get(self, position: int) -> Scenario:
        if position in self._loaded:
            self._loaded.move_to_end(position)
            return self._loaded[position]
        scenario = self._load(position)
        if scenario.id != self._ids[position]:
            raise ConfigurationError(
                f"scenario {position} was announced as {self._ids[position]!r}, but is {scenario.id!r}"
            )
        self._loaded[position] = scenario
        while len(self._loaded) > self._kept:
            self._loaded.popitem(last=False)
        return scenario


def scenario_ids(scenarios: Sequence[Scenario]) -> Sequence[str]:
    """The ids of scenarios; lazy ones are not loaded for them."""
    if isinstance(scenarios, LazyScenarios):
        return scenarios.ids
    return [scenario.id for scenario in scenarios]
