"""Checking a made dataset as a whole: its files, its houses, and every task in a world."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from adhoc.core.errors import AssetError, DatasetError, HouseError, WorldError
from adhoc.dataset.checks.gravity import check_gravity
from adhoc.dataset.checks.house_checks import Violation, check_house
from adhoc.dataset.files.ceiling_file import read_ceilings
from adhoc.dataset.files.checked_lines import dataset_errors
from adhoc.dataset.files.dataset_folder import DatasetSplit, HouseFile, SplitFiles
from adhoc.dataset.files.line_fields import whole
from adhoc.dataset.making.parallel import Progress, in_processes
from adhoc.evaluation.referee import PlacementReferee
from adhoc.evaluation.scenario import Scenario, prepare
from adhoc.houses.house import House
from adhoc.houses.house_files import Document, decode
from adhoc.houses.json_fields import Fields
from adhoc.worlds.pybullet_world import PyBulletWorld
from adhoc.worlds.world import World

Inspect = Callable[[House], Sequence[Violation]]


@dataclass(frozen=True)
class CheckPlan:
    """What one process checks at a time: a house, and some of its tasks."""

    folder: Path
    split: str
    house_id: str
    tasks: tuple[str, ...]
    inspections: tuple[Inspect, ...] = (check_house, check_gravity)


@dataclass(frozen=True)
class CheckReport:
    """What was checked, and what is wrong."""

    houses: int
    tasks: int
    violations: tuple[Violation, ...]
    making: Mapping[str, Any]
    """The statistics of the making by number of rooms; empty if they are not there."""


def check_split(
    folder: Path,
    split: str,
    houses: int | None = None,
    tasks: int | None = None,
    workers: int = 2,
    progress: Progress = lambda done, total, latest: None,
    inspections: tuple[Inspect, ...] = (check_house, check_gravity),
) -> CheckReport:
    """Check one split of a dataset.

    Args:
        folder: The dataset.
        split: `train`, `val` or `test`.
        houses: Check only so many houses, spread over the split, and their tasks; all if None.
        tasks: Check only so many tasks of each of these houses; all if None.
        workers: Processes to use; 1 works in this one.
        progress: Is told after each house.
        inspections: What is looked for in each house.

    Raises:
        DatasetError: The files cannot be read at all.
    """
    data = DatasetSplit(folder, split)
    by_house: dict[str, list[str]] = {house_id: [] for house_id in data.header.houses}
    violations: list[Violation] = []
    for task_id in data.ids:
        try:
            by_house[data.task(task_id).house_id].append(task_id)
        except DatasetError as error:
            violations.append(Violation("task file", task_id, str(error)))
    violations += [*_check_hashes(data.house_file, data.files), *_check_ceilings(data)]
    chosen = _spread(list(by_house), houses)
    plans = [
        CheckPlan(folder, split, house_id, tuple(by_house[house_id][:tasks]), inspections)
        for house_id in chosen
    ]
    found = in_processes(
        check_plan, plans, workers, lambda plan: _rooms(plan.house_id), lambda plan: plan.house_id, progress
    )
    violations += [violation for group in found for violation in group]
    checked = sum(len(plan.tasks) for plan in plans)
    return CheckReport(len(plans), checked, tuple(violations), _read_making(data.files))


def check_plan(plan: CheckPlan) -> list[Violation]:
    """Everything that is wrong with one house and some of its tasks."""
    data = DatasetSplit(plan.folder, plan.split)
    try:
        house = data.house_file.house(plan.house_id)
    except (HouseError, AssetError) as error:
        return [Violation("schema", plan.house_id, str(error))]
    violations = [
        Violation(violation.check, f"{plan.house_id} {violation.subject}", violation.detail)
        for inspect in plan.inspections
        for violation in inspect(house)
    ]
    world = PyBulletWorld(image_size=2)
    try:
        for task_id in plan.tasks:
            violations += _check_task(world, data, task_id)
    finally:
        world.close()
    return violations


def _check_task(world: World, data: DatasetSplit, task_id: str) -> Iterator[Violation]:
    try:
        scenario = data.scenario(task_id)
    except (DatasetError, HouseError, AssetError) as error:
        yield Violation("task file", task_id, str(error))
        return
    try:
        prepare(world, scenario)
    except (WorldError, HouseError) as error:
        yield Violation("set-up", task_id, str(error))
        return
    yield from _check_start(world, scenario)


def _check_start(world: World, scenario: Scenario) -> Iterator[Violation]:
    in_place = PlacementReferee(world, scenario).replaced()
    if in_place:
        yield Violation("misplaced", scenario.id, f"{', '.join(in_place)} lies in a reasonable place")
    pose = scenario.newcomer.pose
    if not world.is_free(pose):
        yield Violation("newcomer", scenario.id, f"the newcomer cannot stand at x {pose.x:g}, y {pose.y:g}")


def _check_hashes(houses: HouseFile, files: SplitFiles) -> Iterator[Violation]:
    """Whether the list of hashes is that of the houses."""
    wanted = "".join(f"{hashlib.sha256(houses.line(name)).hexdigest()}  {name}\n" for name in houses.ids)
    try:
        found = files.house_hashes.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        yield Violation("hashes", files.house_hashes.name, f"cannot be read: {error}")
        return
    lines = found.splitlines()
    for number, line in enumerate(wanted.splitlines()):
        if number >= len(lines) or lines[number] != line:
            yield Violation("hashes", f"{files.house_hashes.name} line {number + 1}", f"should be {line!r}")
    if len(lines) > len(wanted.splitlines()):
        yield Violation("hashes", files.house_hashes.name, "lists houses that are not there")


def _check_ceilings(data: DatasetSplit) -> Iterator[Violation]:
    """Whether the ceilings, where there are any, are those of the tasks."""
    files = data.files
    if not files.ceilings.exists():
        return
    try:
        ceilings = read_ceilings(files)
    except DatasetError as error:
        yield Violation("ceilings", files.ceilings.name, str(error))
        return
    for task_id in data.ids:
        if task_id not in ceilings:
            yield Violation("ceilings", task_id, "the task has no ceiling")
    for task_id in sorted(ceilings.keys() - set(data.ids)):
        yield Violation("ceilings", task_id, "there is no such task")


def _read_making(files: SplitFiles) -> Mapping[str, Any]:
    """By number of rooms: houses, drawn, and rejected by reason; empty if they are not there."""
    if not files.making.exists():
        return {}
    with dataset_errors():
        document = decode(Document("", str(files.making), files.making.read_text("utf-8", "replace")))
        rooms = Fields.of(document, str(files.making)).fields("rooms")
        for name in rooms.value:
            counts = rooms.fields(name)
            houses = whole(counts, "houses", 1, 10**6)
            whole(counts, "drawn", houses, 10**6)
            rejected = counts.fields("rejected")
            for reason in rejected.value:
                whole(rejected, reason, 1, 10**6)
    return rooms.value


def _spread(names: Sequence[str], count: int | None) -> Sequence[str]:
    """`count` names at equal distances; all if there are no more."""
    if count is None or count >= len(names):
        return names
    return [names[place * len(names) // count] for place in range(count)]


def _rooms(house_id: str) -> int:
    """The number of rooms that an id tells, as a guess at the effort."""
    part = house_id.rsplit("-", 2)[1:2]
    return int(part[0]) if part and part[0].isdigit() else 0
