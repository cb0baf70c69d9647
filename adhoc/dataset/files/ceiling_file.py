"""Files of ceilings: what an oracle can do in each task of a split, one checked line a task."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, asdict
from dataclasses import fields as fields_of
from typing import Any, get_args

from adhoc.core.errors import DatasetError, HouseError
from adhoc.dataset.files.checked_lines import dataset_errors, read_checked, read_compressed, write_checked
from adhoc.dataset.files.dataset_folder import SplitFiles
from adhoc.dataset.files.line_fields import only, whole
from adhoc.dataset.oracle.ceilings import Ceiling, Kind
from adhoc.houses.json_fields import Fields

FORMAT, VERSION = "adhoc-ceilings", 1
_MOST_STEPS = 10**6
_HEADER = ("format", "version", "split", "tasks_sha256", "max_steps", "count")
_DEFAULTS = {field.name: field.default for field in fields_of(Ceiling) if field.default is not MISSING}
_NAMES = tuple(field.name for field in fields_of(Ceiling))


def write_ceilings(files: SplitFiles, ceilings: Iterable[Ceiling], max_steps: int) -> None:
    """Write the ceilings of a split; equal ceilings give equal bytes.

    The header names the content of the task file, so that ceilings of other tasks are refused. Fields at
    their defaults are left out.
    """
    rows = [_line(it) for it in ceilings]
    header = {
        "split": files.split,
        "tasks_sha256": _tasks_sha256(files),
        "max_steps": max_steps,
        "count": len(rows),
    }
    write_checked(files.ceilings, FORMAT, VERSION, header, rows)


def read_ceilings(files: SplitFiles) -> dict[str, Ceiling]:
    """The ceilings of a split by task id, in the order of the file.

    Raises DatasetError, naming file, line and field, if the file is missing, damaged, of another version, or
    made for other tasks.
    """
    lines = read_checked(files.ceilings, FORMAT, VERSION)
    ceilings: dict[str, Ceiling] = {}
    with dataset_errors():
        header = lines.header
        only(header, _HEADER)
        if header.text("tasks_sha256") != _tasks_sha256(files):
            raise header.error("tasks_sha256", f"that of {files.tasks.name}: the ceilings are of other tasks")
        if header.text("split") != files.split:
            raise header.error("split", f"{files.split!r}, as the file's name says")
        whole(header, "max_steps", 1, _MOST_STEPS)
        count = whole(header, "count", 0, 10**6)
        for index in range(len(lines.lines)):
            ceiling = _parse(lines.row(index))
            if ceiling.task_id in ceilings:
                raise DatasetError(f"{lines.where(index)}: task_id {ceiling.task_id!r} is there twice")
            ceilings[ceiling.task_id] = ceiling
    if len(ceilings) != count:
        raise DatasetError(f"{files.ceilings}: the file has {len(ceilings)} ceilings, by its header {count}")
    return ceilings


def _tasks_sha256(files: SplitFiles) -> str:
    return hashlib.sha256(read_compressed(files.tasks)).hexdigest()


def _line(ceiling: Ceiling) -> Mapping[str, Any]:
    values = asdict(ceiling)
    return {
        name: value for name, value in values.items() if name not in _DEFAULTS or value != _DEFAULTS[name]
    }


def _parse(fields: Fields) -> Ceiling:
    only(fields, _NAMES)
    kind = fields.text("kind")
    if kind not in get_args(Kind):
        raise fields.error("kind", f"one of {', '.join(get_args(Kind))}")
    proven = fields.value.get("proven", True)
    if not isinstance(proven, bool):
        raise fields.error("proven", "true or false")
    _check_steps(fields, kind)
    return Ceiling(
        task_id=fields.text("task_id"),
        kind=kind,  # type: ignore[arg-type]
        team_steps=_steps(fields, "team_steps"),
        joint_steps=_steps(fields, "joint_steps"),
        reason=_text(fields, "reason"),
        proven=proven,
        least_steps=_steps(fields, "least_steps"),
        team_reason=_text(fields, "team_reason"),
    )


def _check_steps(fields: Fields, kind: str) -> None:
    """Whether the steps that are given are those of the kind."""
    wanted = {"team_steps": kind == "team", "joint_steps": kind != "none"}
    for name, is_wanted in wanted.items():
        if fields.has(name) != is_wanted and not (kind == "team" and name == "joint_steps"):
            raise fields.error(name, f"{'a number of steps' if is_wanted else 'null'} for the kind {kind!r}")


def _steps(fields: Fields, name: str) -> int | None:
    if name not in fields.value and name not in _DEFAULTS:
        raise HouseError(f"{fields.source}: {name} is missing")
    return whole(fields, name, 0, _MOST_STEPS) if fields.has(name) else None


def _text(fields: Fields, name: str) -> str:
    return fields.text(name) if name in fields.value else ""
