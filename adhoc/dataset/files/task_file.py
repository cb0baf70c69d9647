"""Task files: fixed tasks of one split of a dataset, one checked line each (docs/dataset-format.md)."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from dataclasses import fields as fields_of
from pathlib import Path
from typing import Any

from adhoc.core.errors import DatasetError, HouseError
from adhoc.core.values import Capability, Pose
from adhoc.dataset.files.checked_lines import CheckedLines, dataset_errors, read_checked, write_checked
from adhoc.dataset.files.line_fields import (
    MOST_SEED,
    between,
    name_of,
    numbers,
    only,
    pair,
    point,
    texts,
    whole,
    whole_pair,
)
from adhoc.evaluation.ranges import Ranges
from adhoc.evaluation.scenario import Difficulty, Displacement, Member
from adhoc.houses.json_fields import LARGEST, Fields

FORMAT, VERSION = "adhoc-tasks", 1
HASH_DIGITS = 16
"""Of a house's SHA-256 in a task line."""
_DECIMALS = 5
_ID = re.compile(rb'\{"id":"([^"\\]+)"')
_RANGES = tuple(field.name for field in fields_of(Ranges))
_HEADER = ("format", "version", "dataset", "split", "seed", "house_file", "house_sha256", "houses", "tasks")
_TASK = ("id", "house", "house_hash", "difficulty", "seed", "misplaced", "team", "newcomer")
_MISPLACED = ("object", "receptacle", "position")
_MEMBER = ("name", "manipulate", "height", "payload", "steps", "x", "y", "yaw")


@dataclass(frozen=True)
class TaskFileHeader:
    """What all tasks of a file have in common."""

    dataset: str
    split: str
    seed: int
    """The dataset seed."""
    house_file: str
    """Name of the file of the houses, in the same folder."""
    house_sha256: str
    """SHA-256 of its uncompressed content."""
    houses: tuple[str, ...]
    """Their ids, in the order of its lines."""
    tasks: int
    ranges: Ranges
    """What the tasks were drawn from."""


@dataclass(frozen=True)
class StoredTask:
    """One task as its line says it. Objects have the ids of the house file, not those that robots see."""

    id: str
    house_id: str
    house_hash: str
    """The first 16 digits of the SHA-256 of the house's line."""
    difficulty: Difficulty
    seed: int
    """Of where misplaced objects lie, and of the names of things."""
    misplaced: tuple[Displacement, ...]
    team: tuple[Member, ...]
    newcomer: Member


class TaskFile:
    """A task file, read whole; its tasks are decoded when they are asked for.

    Raises DatasetError, naming file, line and field, if it is missing, damaged, foreign or of another
    version, or if a task is there twice.
    """

    def __init__(self, path: Path) -> None:
        self._lines = read_checked(path, FORMAT, VERSION)
        with dataset_errors():
            self.header = _parse_header(self._lines.header)
        self._place = _places(self._lines)
        if len(self._place) != self.header.tasks:
            raise DatasetError(
                f"{path}: the file has {len(self._place)} tasks; by its header it should have "
                f"{self.header.tasks}: it is cut off or was edited"
            )

    @property
    def ids(self) -> tuple[str, ...]:
        """The ids of all tasks, in order."""
        return tuple(self._place)

    def where(self, task_id: str) -> str:
        """File and line of a task, for error texts. Raises DatasetError for an unknown task."""
        return self._lines.where(self._index(task_id))

    def task(self, task_id: str) -> StoredTask:
        """One task, its fields checked as far as they can be without the house.

        Raises DatasetError, naming file, line and field.
        """
        with dataset_errors():
            return _parse_task(self._lines.row(self._index(task_id)), self.header)

    def _index(self, task_id: str) -> int:
        if task_id not in self._place:
            raise DatasetError(
                f"{self._lines.path}: there is no task {task_id!r}; ids are like "
                f"{next(iter(self._place), '')!r}"
            )
        return self._place[task_id]


def write_tasks(path: Path, header: TaskFileHeader, tasks: Iterable[StoredTask]) -> None:
    """Write a task file; equal tasks give equal bytes."""
    content = {
        "dataset": header.dataset,
        "split": header.split,
        "seed": header.seed,
        "house_file": header.house_file,
        "house_sha256": header.house_sha256,
        "houses": list(header.houses),
        "tasks": header.tasks,
        "ranges": asdict(header.ranges),
    }
    write_checked(path, FORMAT, VERSION, content, (_task_line(task) for task in tasks))


def _task_line(task: StoredTask) -> Mapping[str, Any]:
    return {
        "id": task.id,
        "house": task.house_id,
        "house_hash": task.house_hash,
        "difficulty": task.difficulty.value,
        "seed": task.seed,
        "misplaced": [
            {"object": it.object_id, "receptacle": it.receptacle_id, "position": list(it.position or ())}
            for it in task.misplaced
        ],
        "team": [_member_line(member) for member in task.team],
        "newcomer": _member_line(task.newcomer),
    }


def _member_line(member: Member) -> Mapping[str, Any]:
    return {
        "name": member.name,
        "manipulate": member.capability.can_manipulate,
        "height": member.capability.camera_height,
        "payload": member.capability.payload,
        "steps": member.capability.max_steps,
        "x": round(member.pose.x, _DECIMALS) + 0.0,
        "y": round(member.pose.y, _DECIMALS) + 0.0,
        "yaw": round(math.degrees(member.pose.yaw)),
    }


def _places(lines: CheckedLines) -> dict[str, int]:
    """Where each task is. The line begins with the id, so that nothing else need be decoded."""
    places: dict[str, int] = {}
    for index, line in enumerate(lines.lines):
        found = _ID.match(line)
        if found is None:
            raise DatasetError(f"{lines.where(index)}: id is missing; a task should begin with it")
        task_id = found[1].decode()
        if places.setdefault(task_id, index) != index:
            first = lines.where(places[task_id])
            raise DatasetError(f"{lines.where(index)}: id {task_id!r} is there twice, first in {first}")
    return places


def _parse_header(header: Fields) -> TaskFileHeader:
    only(header, (*_HEADER, "ranges"))
    digest = header.text("house_sha256")
    if not re.fullmatch("[0-9a-f]{64}", digest):
        raise header.error("house_sha256", "64 hexadecimal digits")
    file = header.text("house_file")
    if Path(file).name != file:
        raise header.error("house_file", "the name of a file in the same folder")
    return TaskFileHeader(
        dataset=header.text("dataset"),
        split=header.text("split"),
        seed=whole(header, "seed", -MOST_SEED, MOST_SEED),
        house_file=file,
        house_sha256=digest,
        houses=texts(header, "houses"),
        tasks=whole(header, "tasks", 0, 10**6),
        ranges=_parse_ranges(header.fields("ranges")),
    )


def _parse_ranges(ranges: Fields) -> Ranges:
    only(ranges, _RANGES)
    return Ranges(
        misplaced=whole_pair(ranges, "misplaced"),
        teammates=whole_pair(ranges, "teammates"),
        heights=numbers(ranges, "heights"),
        payload=pair(ranges, "payload"),
        max_steps=whole_pair(ranges, "max_steps"),
        can_manipulate=between(ranges, "can_manipulate", (0.0, 1.0)),
        floor=between(ranges, "floor", (0.0, 1.0)),
        apart=between(ranges, "apart", (0.0, LARGEST)),
        crowded=between(ranges, "crowded", (0.0, LARGEST)),
    )


def _parse_task(fields: Fields, header: TaskFileHeader) -> StoredTask:
    only(fields, _TASK)
    ranges = header.ranges
    task = StoredTask(
        id=name_of(fields, "id"),
        house_id=_one_of(fields, "house", header.houses),
        house_hash=fields.text("house_hash"),
        difficulty=Difficulty(_one_of(fields, "difficulty", [it.value for it in Difficulty])),
        seed=whole(fields, "seed", 0, MOST_SEED),
        misplaced=tuple(_parse_displacement(it) for it in fields.items("misplaced")),
        team=tuple(_parse_member(it, ranges) for it in fields.items("team")),
        newcomer=_parse_member(fields.fields("newcomer"), ranges),
    )
    _check_count(fields, "misplaced", len(task.misplaced), ranges.misplaced)
    _check_count(fields, "team", len(task.team), ranges.teammates)
    names = [member.name for member in (*task.team, task.newcomer)]
    if len(set(names)) != len(names):
        raise HouseError(f"{fields.source}: team: two robots have one name; names are {', '.join(names)}")
    if not any(member.capability.can_manipulate for member in task.team):
        raise HouseError(f"{fields.source}: team: no robot can manipulate; at least one should")
    return task


def _parse_displacement(fields: Fields) -> Displacement:
    only(fields, _MISPLACED)
    return Displacement(fields.text("object"), fields.text("receptacle"), point(fields, "position"))


def _parse_member(fields: Fields, ranges: Ranges) -> Member:
    only(fields, _MEMBER)
    height = fields.number("height")
    if height not in ranges.heights:
        raise fields.error("height", f"one of {', '.join(f'{it:g}' for it in ranges.heights)}")
    if "manipulate" not in fields.value:
        raise fields.error("manipulate", "true or false")
    capability = Capability(
        can_navigate=True,
        can_manipulate=fields.flag("manipulate"),
        camera_height=height,
        payload=between(fields, "payload", ranges.payload),
        max_steps=whole(fields, "steps", *ranges.max_steps),
    )
    yaw = whole(fields, "yaw", -180, 180)
    if yaw % 90:
        raise fields.error("yaw", "a multiple of 90 degrees")
    pose = Pose(fields.number("x"), fields.number("y"), math.radians(yaw))
    return Member(name_of(fields, "name"), capability, pose)


def _one_of(fields: Fields, name: str, known: Iterable[str]) -> str:
    text, names = fields.text(name), list(known)
    if text not in names:
        shown = ", ".join(names) if len(names) < 6 else f"one of {len(names)}, e.g. {names[0]}"
        raise fields.error(name, f"a known one: {shown}")
    return text


def _check_count(fields: Fields, name: str, count: int, bounds: tuple[int, int]) -> None:
    if not bounds[0] <= count <= bounds[1]:
        raise fields.error(name, f"a list of {bounds[0]} to {bounds[1]}")
