"""Whether a stored task is possible in its house: known objects, free and connected poses, robots apart."""

from __future__ import annotations

import math
from collections.abc import Sequence

from adhoc.core.errors import DatasetError
from adhoc.core.geometry import planar_distance
from adhoc.core.values import Pose
from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.dataset.files.task_file import StoredTask
from adhoc.evaluation.ranges import Ranges
from adhoc.evaluation.scenario import Displacement, difficulty_of
from adhoc.houses.build import build_solids
from adhoc.houses.house import FLOOR, House

_NEARLY = 1e-6
_HIGHEST = 10.0
"""Metres: nothing in a house lies higher."""


def check_task(task: StoredTask, house: House, ranges: Ranges, where: str) -> None:
    """Raise DatasetError, naming the place `where` and the field, if the task is impossible in the house.

    Where robots stand is judged without the misplaced objects, since only a world knows how these lie; a
    robot at the very place of one is refused. `evaluation.scenario.prepare` tries the rest.
    """
    difficulty = difficulty_of(len(house.rooms))
    if task.difficulty is not difficulty:
        raise DatasetError(
            f"{where}: difficulty is {task.difficulty.value!r}; a house of {len(house.rooms)} rooms is "
            f"{difficulty.value!r}"
        )
    _check_misplaced(task.misplaced, house, where)
    _check_poses(task, house, ranges, where)


def _check_misplaced(misplaced: Sequence[Displacement], house: House, where: str) -> None:
    objects = {thing.id: thing for thing in house.objects}
    corners = [corner for room in house.rooms for corner in room.polygon]
    low, high = [min(axis) for axis in zip(*corners)], [max(axis) for axis in zip(*corners)]
    seen: set[str] = set()
    for index, displacement in enumerate(misplaced):
        field = f"{where}: misplaced[{index}]"
        thing, receptacle = (objects.get(it) for it in (displacement.object_id, displacement.receptacle_id))
        if thing is None or not thing.pickupable:
            raise DatasetError(
                f"{field}.object is {displacement.object_id!r}; it should be an object of house {house.id!r} "
                "that can be picked up"
            )
        if thing.id in seen:
            raise DatasetError(f"{field}.object is {thing.id!r}; that object is misplaced already")
        seen.add(thing.id)
        is_fixed_receptacle = (
            receptacle is not None and receptacle.is_receptacle and not receptacle.pickupable
        )
        if displacement.receptacle_id != FLOOR and not is_fixed_receptacle:
            raise DatasetError(
                f"{field}.receptacle is {displacement.receptacle_id!r}; it should be {FLOOR!r} or a "
                f"receptacle of house {house.id!r}"
            )
        x, y, z = displacement.position or (math.nan, math.nan, math.nan)
        if not (low[0] <= x <= high[0] and low[1] <= y <= high[1] and 0.0 <= z <= _HIGHEST):
            raise DatasetError(f"{field}.position is ({x:g}, {y:g}, {z:g}); it should be inside the house")


def _check_poses(task: StoredTask, house: House, ranges: Ranges, where: str) -> None:
    moved = {displacement.object_id for displacement in task.misplaced}
    cells = FreeCells(house.rooms, [solid for solid in build_solids(house) if solid.id not in moved])
    robots = [(f"team[{index}]", member.pose) for index, member in enumerate(task.team)]
    robots.append(("newcomer", task.newcomer.pose))
    least = min(ranges.apart, ranges.crowded)
    for index, (field, pose) in enumerate(robots):
        refusal = _refusal(pose, cells) or _on_an_object(pose, task, house, cells)
        if refusal is not None:
            raise DatasetError(f"{where}: {field} stands at x {pose.x:g}, y {pose.y:g}; {refusal}")
        for other_field, other in robots[:index]:
            distance = planar_distance(pose, other)
            if distance < max(least, 2 * cells.radius) - _NEARLY:
                raise DatasetError(
                    f"{where}: {field} stands at x {pose.x:g}, y {pose.y:g}, {distance:.2f} m from "
                    f"{other_field}; robots begin at least {least:g} m apart"
                )


def _refusal(pose: Pose, cells: FreeCells) -> str | None:
    """Why a robot cannot begin at the pose; None if it can."""
    column, row = cells.index(pose.x, pose.y)
    columns, rows = cells.free.shape
    inside = 0 <= column < columns and 0 <= row < rows
    if not inside or cells.room[column, row] < 0:
        return "that is outside the house"
    x, y = cells.point(column, row)
    if math.hypot(pose.x - x, pose.y - y) > _NEARLY:
        return f"robots begin at multiples of {cells.grid_size:g} m"
    if not cells.fits(pose.x, pose.y):
        return "a wall or a piece of furniture is in the way there"
    if not cells.connected[column, row]:
        return "the rest of the house cannot be reached from there"
    return None


def _on_an_object(pose: Pose, task: StoredTask, house: House, cells: FreeCells) -> str | None:
    for displacement in task.misplaced:
        if displacement.receptacle_id == FLOOR and displacement.position is not None:
            size = house.object(displacement.object_id).size
            if planar_distance((pose.x, pose.y), displacement.position) < cells.radius + min(size[:2]) / 2:
                return f"{displacement.object_id!r} lies there"
    return None
