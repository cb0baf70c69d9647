"""A dataset of two shipped sample houses, and ways to spoil it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from adhoc.dataset.files.checked_lines import read_checked, write_checked
from adhoc.dataset.files.dataset_folder import SplitFiles
from adhoc.dataset.files.task_file import FORMAT, VERSION
from adhoc.dataset.generator import Generated
from adhoc.dataset.making.house_tasks import TaskGrid
from adhoc.dataset.making.split_making import make_split
from adhoc.houses.samples import sample_house

GRID = TaskGrid(misplaced=(1, 2), teammates=(3, 4))
SAMPLES = {1: "one_room", 4: "four_rooms"}


def from_samples(rooms, seed, house_id):
    """Stands in for the generator of houses."""
    return Generated(replace(sample_house(SAMPLES[rooms]), id=house_id), ("rooms: somewhere: too small",))


def nothing_falls(house):
    return []


def make_tiny(folder: Path, counts=(1, 4), workers=1, split="test", seed=5, **options):
    options = {"generate": from_samples, "fall": nothing_falls, "grid": GRID, **options}
    make_split(split, folder, seed, 1, counts, workers, dataset="tiny", **options)
    return folder


def spoil_task(folder: Path, edit, index=0, kind=FORMAT, version=VERSION):
    """Change the task of a line, or with index None the header, and give it the checksum that fits."""
    path = SplitFiles(folder, "test").tasks
    lines = read_checked(path, FORMAT, VERSION)
    rows = [json.loads(json.dumps(lines.row(number).value)) for number in range(len(lines.lines))]
    header = dict(lines.header.value)
    del header["format"], header["version"]
    edit(header if index is None else rows[index])
    write_checked(path, kind, version, header, rows)
