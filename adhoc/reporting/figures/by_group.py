"""What the figures of success by difficulty and by the ad hoc robot's ability show."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from adhoc.evaluation.records import Record
from adhoc.evaluation.scenario import Difficulty
from adhoc.reporting.contestants import Contestant, Team
from adhoc.reporting.pairing import Pair
from adhoc.reporting.paper_order import FULL_METHOD, policy_order, team_order
from adhoc.reporting.results import Results
from adhoc.statistics.intervals import Interval, Sample, clustered_intervals

ABLE, UNABLE = "can manipulate", "cannot manipulate"


@dataclass(frozen=True)
class Grouping:
    """A way to part scenarios."""

    key: str
    title: str
    groups: tuple[str, ...]
    """In the order in which they are shown."""
    of: Callable[[Record], str | None]
    """The group of an episode with a newcomer; None if its record does not tell."""


@dataclass(frozen=True)
class GroupPoint:
    """One policy in one group of scenarios, joining at one step; in percent, and points of percent."""

    success: Interval
    gain: Interval
    """Over the team alone in the same scenarios."""
    alone: float
    """What the team alone does in these."""
    episodes: int

    @property
    def improvement(self) -> float | None:
        """What the paper's figure shows as a line: the gain in percent of the team's own; None where that
        is 0."""
        return 100.0 * self.gain.mean / self.alone if self.alone else None


@dataclass(frozen=True)
class SuccessByGroup:
    """One policy beside one team, by group and joining step."""

    grouping: Grouping
    who: Contestant
    team_name: str
    policy_name: str
    groups: tuple[str, ...]
    steps: tuple[int, ...]
    alone: Mapping[str, Interval]
    points: Mapping[tuple[str, int], GroupPoint]
    houses: Mapping[str, int]
    """Those in which the tasks of a group are: as many as its intervals come from at most."""


def _ability(record: Record) -> str | None:
    newcomer = record.get("newcomer")
    return None if newcomer is None else ABLE if newcomer["can_manipulate"] else UNABLE


GROUPINGS = (
    Grouping(
        "difficulty",
        "by difficulty of the task",
        tuple(it.value for it in Difficulty),
        lambda record: str(record["difficulty"]),
    ),
    Grouping("ability", "by the ad hoc robot's ability", (ABLE, UNABLE), _ability),
)


def success_by_group(results: Results, groupings: Sequence[Grouping] = GROUPINGS) -> Iterator[SuccessByGroup]:
    """One for each grouping and team: of the paper's own policy, or of the last in its order where that is
    missing.

    Episodes whose records do not tell their group are left out; nothing comes of a team without others.
    """
    of_team: dict[Team, dict[Contestant, list[Pair]]] = {}
    for pair in results.pairs:
        of_team.setdefault(pair.who.team, {}).setdefault(pair.who, []).append(pair)
    for grouping in groupings:
        for team in sorted(of_team, key=team_order):
            order = sorted(of_team[team], key=policy_order)
            who = next((it for it in order if it.policy == FULL_METHOD), order[-1])
            mine = [pair for pair in of_team[team][who] if grouping.of(pair.joined) is not None]
            if mine:
                yield _grouped(grouping, who, mine, results.teams[team], results.rows[who])


def _grouped(
    grouping: Grouping, who: Contestant, mine: Sequence[Pair], team_name: str, policy_name: str
) -> SuccessByGroup:
    parts: dict[tuple[str, int], list[Pair]] = {}
    for pair in mine:
        parts.setdefault((str(grouping.of(pair.joined)), pair.joined["join_step"]), []).append(pair)
    groups = tuple(it for it in grouping.groups if any(group == it for group, _ in parts))
    alone = {
        group: list(
            {
                id(pair.alone): pair.alone for key, some in parts.items() if key[0] == group for pair in some
            }.values()
        )
        for group in groups
    }
    samples = [
        *(_sample([(it["success"], it["house_id"]) for it in alone[group]]) for group in groups),
        *(_sample([(it.joined["success"], it.joined["house_id"]) for it in some]) for some in parts.values()),
        *(_sample([(_gain(it), it.joined["house_id"]) for it in some]) for some in parts.values()),
    ]
    found = clustered_intervals(samples)
    successes, gains = found[len(groups) : len(groups) + len(parts)], found[len(groups) + len(parts) :]
    return SuccessByGroup(
        grouping,
        who,
        team_name,
        policy_name,
        groups,
        tuple(sorted({step for _, step in parts})),
        dict(zip(groups, found)),
        {
            key: GroupPoint(success, gain, success.mean - gain.mean, len(some))
            for (key, some), success, gain in zip(parts.items(), successes, gains)
        },
        {group: len({it["house_id"] for it in alone[group]}) for group in groups},
    )


def _gain(pair: Pair) -> float:
    return float(pair.joined["success"]) - float(pair.alone["success"])


def _sample(values: Sequence[tuple[float, str]]) -> Sample:
    return Sample.of([100.0 * value for value, _ in values], [house for _, house in values])
