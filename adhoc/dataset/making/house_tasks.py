"""Drawing all tasks of one house: every number of misplaced objects with every size of team."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from adhoc.core.errors import DatasetError, WorldError
from adhoc.core.streams import derive_seed
from adhoc.dataset.files.task_checks import check_task
from adhoc.dataset.files.task_scenario import task_of
from adhoc.dataset.making.findable import Findable
from adhoc.evaluation.sampling import Accept, Ranges, sample_scenario
from adhoc.evaluation.scenario import Scenario
from adhoc.houses.house import House
from adhoc.worlds.world import World

TEAM_ATTEMPTS = 10
"""How many teams are drawn for one task before its house is given up."""

PAPER_RANGES = Ranges()
"""What the paper draws from."""

Suits = Callable[[Scenario], bool]
"""Whether a drawn scenario may be a task."""


@dataclass(frozen=True)
class TaskGrid:
    """The tasks of each house: the paper's five scenarios, with one to five misplaced objects, each with
    three, four and five teammates (section Benchmark Dataset)."""

    misplaced: tuple[int, ...] = (1, 2, 3, 4, 5)
    teammates: tuple[int, ...] = (3, 4, 5)
    ranges: Ranges = PAPER_RANGES

    def sizes(self) -> Iterator[tuple[int, int]]:
        """(misplaced objects, teammates) of each task, in order."""
        return ((k, size) for k in self.misplaced for size in self.teammates)


PAPER_GRID = TaskGrid()


def task_id(house_id: str, misplaced: int, teammates: int) -> str:
    """The id of one task, e.g. `test-04-07-k3-t5`."""
    return f"{house_id}-k{misplaced}-t{teammates}"


def draw_tasks(world: World, house: House, seed: int, grid: TaskGrid = PAPER_GRID) -> list[Scenario]:
    """All tasks of a house, in which every misplaced object can be found and every robot can begin.

    Raises what `draw_task` raises.
    """
    accept = Findable()

    def suits(scenario: Scenario) -> bool:
        try:
            check_task(task_of(scenario, house, ""), house, grid.ranges, scenario.id)
        except DatasetError:
            return False
        return True

    return [draw_task(world, house, seed, *sizes, grid.ranges, accept, suits) for sizes in grid.sizes()]


def draw_task(
    world: World,
    house: House,
    seed: int,
    misplaced: int,
    teammates: int,
    ranges: Ranges = PAPER_RANGES,
    accept: Accept | None = None,
    suits: Suits = lambda scenario: True,
) -> Scenario:
    """One task of a house; equal arguments give equal tasks.

    The misplaced objects depend on their number and not on the team, so that team sizes can be compared;
    robots and their poses are drawn for each task, the newcomer too, as the paper says. A team that finds no
    room, or that makes a scenario which does not suit, is drawn again, at most `TEAM_ATTEMPTS` times.

    Raises:
        ConfigurationError: The house has too few objects that can be misplaced.
        WorldError: No team was found.
    """
    name = task_id(house.id, misplaced, teammates)
    placement_seed = derive_seed(seed, "placement", house.id, misplaced)
    refusal: WorldError | None = None
    for attempt in range(TEAM_ATTEMPTS):
        team_seed = derive_seed(seed, "team", name, attempt)
        try:
            scenario = sample_scenario(
                world, house, placement_seed, misplaced, teammates, ranges, name, team_seed, accept
            )
        except WorldError as error:
            refusal = error
            continue
        if suits(scenario):
            return scenario
    raise WorldError(f"task {name!r}: no team of {TEAM_ATTEMPTS} can begin") from refusal
