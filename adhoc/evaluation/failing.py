"""Robots that break down or are taken away in mid-episode."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from adhoc.evaluation.imperfections import Imperfections
from adhoc.evaluation.scenario import Scenario
from adhoc.worlds.world import AgentTruth, World


class Failing:
    """Takes teammates out of an episode as its imperfections say.

    Args:
        imperfections: Who breaks down or leaves, and when.
        scenario: Names the team.
        world: Robots that leave are removed from it.
    """

    def __init__(self, imperfections: Imperfections, scenario: Scenario, world: World) -> None:
        self._imperfections, self._scenario, self._world = imperfections, scenario, world
        self.broke_down: dict[str, int] = {}
        """The robots that broke down, and before which step."""
        self.left: dict[str, int] = {}
        """Those that were taken away, likewise."""
        self._last_seen: dict[str, AgentTruth] = {}

    def at(self, step: int) -> Iterator[tuple[AgentTruth, str]]:
        """What fails before that step, one after the other: the robot as it was, and the name of the event.

        A robot that both breaks down and leaves does so in this order; one that has left fails no more.
        """
        for seat, member in enumerate(self._scenario.team):
            if member.name in self.left:
                continue
            if self._imperfections.breaks_down.get(seat) == step:
                self.broke_down[member.name] = step
                yield self._world.agents()[member.name], "broke down"
            if self._imperfections.leaves.get(seat) == step:
                self.left[member.name] = step
                truth = self._world.agents()[member.name]
                self._last_seen[member.name] = replace(truth, held=None)
                self._world.remove_agent(member.name)
                yield truth, "left"

    def whole_truth(self) -> Mapping[str, AgentTruth]:
        """Where all robots are, and where those that left were last, with empty hands."""
        return {**self._world.agents(), **self._last_seen}
