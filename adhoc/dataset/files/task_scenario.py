"""From a stored task and its house to a scenario, and back."""

from __future__ import annotations

from dataclasses import replace

from adhoc.dataset.files.task_file import StoredTask
from adhoc.evaluation.scenario import Displacement, Scenario
from adhoc.houses.anonymous import anonymous
from adhoc.houses.house import FLOOR, House


def scenario_of(task: StoredTask, house: House, source: str = "") -> Scenario:
    """The scenario of a task in `house`, whose ids are those of its file.

    Things get the names that tell nothing, drawn from the task's seed, as `sample_scenario` gives them.
    """
    named = anonymous(house, task.seed)
    names = _renamed(house, named)
    return Scenario(
        id=task.id,
        house=named,
        misplaced=tuple(_with_names(displacement, names) for displacement in task.misplaced),
        team=task.team,
        newcomer=task.newcomer,
        seed=task.seed,
        difficulty=task.difficulty,
        source=source,
    )


def task_of(scenario: Scenario, house: House, house_hash: str) -> StoredTask:
    """The stored form of a scenario that was drawn in `house`: the inverse of `scenario_of`."""
    names = _renamed(scenario.house, house)
    return StoredTask(
        id=scenario.id,
        house_id=house.id,
        house_hash=house_hash,
        difficulty=scenario.difficulty,
        seed=scenario.placement_seed,
        misplaced=tuple(_with_names(displacement, names) for displacement in scenario.misplaced),
        team=scenario.team,
        newcomer=scenario.newcomer,
    )


def _renamed(before: House, after: House) -> dict[str, str]:
    names = {old.id: new.id for old, new in zip(before.objects, after.objects)}
    return {**names, FLOOR: FLOOR}


def _with_names(displacement: Displacement, names: dict[str, str]) -> Displacement:
    return replace(
        displacement,
        object_id=names[displacement.object_id],
        receptacle_id=names[displacement.receptacle_id],
    )
