"""Drawing all tasks of one house: every number of misplaced objects with every size of team."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

from adhoc.core.errors import DatasetError, WorldError
from adhoc.core.streams import derive_seed
from adhoc.dataset.files.task_checks import check_task
from adhoc.dataset.files.task_scenario import task_of
from adhoc.dataset.making.findable import Findable
from adhoc.evaluation.misplacing import Disorder, misplace
from adhoc.evaluation.ranges import PAPER_RANGES, Ranges
from adhoc.evaluation.sampling import add_robots
from adhoc.evaluation.scenario import Scenario
from adhoc.houses.house import House
from adhoc.worlds.world import World

TEAM_ATTEMPTS = 10
"""How many teams are drawn for one task before its house is given up."""


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

    Equal arguments give equal tasks. The misplaced objects depend on their number and not on the team, so
    that team sizes can be compared; robots and their poses are drawn for each task, the newcomer too, as the
    paper says. A team that finds no room, or whose task would not pass the checks of task files, is drawn
    again, at most `TEAM_ATTEMPTS` times.

    Raises:
        ConfigurationError: The house has too few objects that can be misplaced.
        WorldError: No team was found for one of the tasks.
    """
    tasks = []
    for misplaced in grid.misplaced:
        placement_seed = derive_seed(seed, "placement", house.id, misplaced)
        disorder = misplace(world, house, placement_seed, misplaced, grid.ranges, Findable)
        for teammates in grid.teammates:
            name = task_id(house.id, misplaced, teammates)
            drawn = _draw_teams(world, disorder, seed, teammates, grid.ranges, name)
            task = next((it for it in drawn if _suits(it, house, grid.ranges)), None)
            if task is None:
                raise WorldError(f"task {name!r}: no team of {TEAM_ATTEMPTS} can begin")
            tasks.append(task)
    return tasks


def _draw_teams(
    world: World, disorder: Disorder, seed: int, teammates: int, ranges: Ranges, name: str
) -> Iterator[Scenario]:
    """The task with one team after the other, without those that find no room."""
    for attempt in range(TEAM_ATTEMPTS):
        team_seed = derive_seed(seed, "team", name, attempt)
        with suppress(WorldError):
            yield add_robots(world, disorder, team_seed, teammates, ranges, name)


def _suits(scenario: Scenario, house: House, ranges: Ranges) -> bool:
    """Whether a task file with this task would be accepted."""
    try:
        check_task(task_of(scenario, house, ""), house, ranges, scenario.id)
    except DatasetError:
        return False
    return True
