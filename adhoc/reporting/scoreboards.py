"""Who succeeded in which scenario: what comparisons on the same scenarios are made from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adhoc.reporting.contestants import Contestant, Team
from adhoc.reporting.pairing import Pair
from adhoc.reporting.paper_order import policy_order, team_order
from adhoc.reporting.results import Results
from adhoc.statistics.intervals import FloatArray


@dataclass(frozen=True)
class Scoreboard:
    """One team and one joining step: the success (1 or 0) of all in S scenarios."""

    team: str
    join_step: int
    houses: NDArray[np.str_]
    """(S,) the house of each scenario."""
    alone: FloatArray
    """(S,) of the team alone."""
    policies: Mapping[str, FloatArray]
    """(S,) of each policy, the most successful first; NaN where it has no episode."""


def scoreboards(results: Results) -> list[Scoreboard]:
    """All that the records tell, by joining step and the order of teams of all tables; episodes without their
    team-alone episode are left out."""
    groups: dict[tuple[int, Team], dict[Contestant, dict[int, Pair]]] = {}
    for pair in results.pairs:
        group = groups.setdefault((pair.joined["join_step"], pair.who.team), {})
        # Pairs of one scenario share the episode of the team alone.
        group.setdefault(pair.who, {})[id(pair.alone)] = pair
    return [
        _scoreboard(results.teams[team], join_step, _by_name(groups[join_step, team], results.rows))
        for join_step, team in sorted(groups, key=lambda key: (key[0], team_order(key[1])))
    ]


def _by_name(
    group: Mapping[Contestant, Mapping[int, Pair]], names: Mapping[Contestant, str]
) -> dict[str, Mapping[int, Pair]]:
    """In the order of policies of all tables, which tells equals apart."""
    return {names[who]: group[who] for who in sorted(group, key=policy_order)}


def _scoreboard(team: str, join_step: int, policies: Mapping[str, Mapping[int, Pair]]) -> Scoreboard:
    scenarios = {key: pair.alone for mine in policies.values() for key, pair in mine.items()}
    places = {key: place for place, key in enumerate(scenarios)}
    outcomes = {name: np.full(len(scenarios), np.nan) for name in policies}
    for name, mine in policies.items():
        for key, pair in mine.items():
            outcomes[name][places[key]] = pair.joined["success"]
    order = sorted(outcomes, key=lambda name: -float(np.nanmean(outcomes[name])))
    return Scoreboard(
        team,
        join_step,
        np.array([alone["house_id"] for alone in scenarios.values()]),
        np.array([alone["success"] for alone in scenarios.values()], dtype=np.float64),
        {name: outcomes[name] for name in order},
    )
