"""Drawing scenarios for a house as the paper does (Benchmark Dataset; appendix, Details of Dataset)."""

from __future__ import annotations

from adhoc.core.errors import ConfigurationError, WorldError
from adhoc.core.streams import derive_seed, stream
from adhoc.evaluation.misplacing import Accepting, Disorder, accept_all, misplace
from adhoc.evaluation.ranges import PAPER_RANGES, Ranges, between
from adhoc.evaluation.referee import PlacementReferee
from adhoc.evaluation.scenario import Member, Scenario, difficulty_of
from adhoc.evaluation.team_drawing import draw_capability, draw_team, poses_apart
from adhoc.houses.house import House
from adhoc.worlds.world import World

NEWCOMER = "newcomer"
"""The ad hoc robot's name; teammates are called `teammate_1`, `teammate_2`, ..."""


def sample_scenario(
    world: World,
    house: House,
    seed: int,
    misplaced: int | None = None,
    teammates: int | None = None,
    ranges: Ranges = PAPER_RANGES,
    name: str | None = None,
    accepting: Accepting = accept_all,
) -> Scenario:
    """Draw one scenario; equal arguments give equal scenarios.

    Every drawn thing has its own random stream, so that asking for another number of teammates leaves the
    misplaced objects as they are.

    Args:
        world: A world to try the placements in; it is reset.
        house: The house.
        seed: Seeds the draws and, later, the episode.
        misplaced: The number of misplaced objects; drawn from `ranges` if None.
        teammates: The number of teammates; drawn from `ranges` if None.
        ranges: What to draw from.
        name: The scenario's id; by default made of the house's id and the seed.
        accepting: See `misplacing.misplace`.

    Raises:
        ConfigurationError: The house has too few objects that can be misplaced, or a number is below 1.
        WorldError: The house has no room for the robots.
    """
    names = ("scenario", house.id)
    if misplaced is None:
        misplaced = between(stream(seed, *names, "misplaced count"), ranges.misplaced)
    if teammates is None:
        teammates = between(stream(seed, *names, "team size"), ranges.teammates)
    if misplaced < 1 or teammates < 1:
        raise ConfigurationError(
            f"a scenario needs at least 1 misplaced object and 1 teammate, not {misplaced} and {teammates}"
        )
    disorder = misplace(world, house, seed, misplaced, ranges, accepting)
    return add_robots(world, disorder, seed, teammates, ranges, name or f"{house.id}-s{seed}")


def add_robots(
    world: World, disorder: Disorder, seed: int, teammates: int, ranges: Ranges, name: str
) -> Scenario:
    """Make a scenario of misplaced objects by drawing the robots and where they begin.

    Args:
        world: As `misplace` left it, or as `prepare` does; it is not changed.
        disorder: The house and what is misplaced in it.
        seed: Seeds the robots alone, so that one disorder can be tried with several teams.
        teammates: The number of teammates, at least 1.
        ranges: What to draw from.
        name: The scenario's id.

    Raises:
        WorldError: The house has no room for the robots.
    """
    house = disorder.house
    names = ("scenario", house.id)
    poses = poses_apart(world, teammates + 1, derive_seed(seed, *names, "poses"), ranges)
    capabilities = draw_team(stream(seed, *names, "team"), teammates, ranges)
    scenario = Scenario(
        id=name,
        house=house,
        misplaced=disorder.misplaced,
        team=tuple(
            Member(f"teammate_{number}", capability, pose)
            for number, (capability, pose) in enumerate(zip(capabilities, poses), start=1)
        ),
        newcomer=Member(NEWCOMER, draw_capability(stream(seed, *names, NEWCOMER), ranges), poses[-1]),
        seed=disorder.seed,
        difficulty=difficulty_of(len(house.rooms)),
    )
    _check_misplaced(world, scenario)
    return scenario


def _check_misplaced(world: World, scenario: Scenario) -> None:
    """A scenario that begins with an object in a right place would be won by doing nothing."""
    in_place = PlacementReferee(world, scenario).replaced()
    if in_place:
        raise WorldError(f"scenario {scenario.id!r}: {', '.join(in_place)} ended in a reasonable place")
