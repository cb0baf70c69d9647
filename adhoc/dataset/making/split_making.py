"""Making a split of a dataset: the same bytes from the same seed, whatever the number of processes."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from adhoc.core.errors import ConfigurationError
from adhoc.dataset.files.checked_lines import write_compressed, write_whole
from adhoc.dataset.files.dataset_folder import SPLITS, SplitFiles, writable_folder
from adhoc.dataset.files.line_fields import MOST_SEED
from adhoc.dataset.files.task_file import TaskFileHeader, write_tasks
from adhoc.dataset.generator import ROOM_COUNTS
from adhoc.dataset.making.house_making import Fall, Generate, HousePlan, MadeHouse, make_house
from adhoc.dataset.making.house_tasks import PAPER_GRID, TaskGrid
from adhoc.dataset.making.parallel import Progress, in_processes


def make_split(
    split: str,
    folder: Path,
    dataset_seed: int,
    houses_per_count: int = 10,
    counts: Sequence[int] = ROOM_COUNTS,
    workers: int = 2,
    progress: Progress = lambda done, total, latest: None,
    dataset: str = "paper",
    grid: TaskGrid = PAPER_GRID,
    generate: Generate | None = None,
    fall: Fall | None = None,
) -> None:
    """Make the houses and tasks of one split, and write its files into `folder`.

    Every house has its own seed, made of the dataset seed, the split, the number of rooms and its index, so
    that splits never share one, and so that more houses leave the others as they are.

    Args:
        split: `train`, `val` or `test`.
        folder: Where the files go; made if need be. Files of the same split are replaced.
        dataset_seed: Equal seeds give equal bytes.
        houses_per_count: Houses of each number of rooms.
        counts: The numbers of rooms.
        workers: Processes to use; 1 works in this one.
        progress: Is told after each house.
        dataset: The name that the files carry.
        grid: The tasks of each house.
        generate: Makes houses instead of `generator.generate_house`.
        fall: Checks them instead of `gravity.check_gravity`.

    Raises:
        ConfigurationError: A number or the split is impossible.
        DatasetError: No house that can be used was found for a place.
    """
    _check(split, dataset_seed, houses_per_count, counts, workers)
    writable_folder(folder)
    tools: dict[str, Any] = {"generate": generate, "fall": fall}
    chosen = {name: tool for name, tool in tools.items() if tool is not None}
    plans = [
        HousePlan(split, rooms, index, dataset_seed, grid, **chosen)
        for rooms in sorted(set(counts))
        for index in range(houses_per_count)
    ]
    made = in_processes(
        make_house, plans, workers, lambda plan: plan.rooms, lambda plan: plan.house_id, progress
    )
    _write(SplitFiles(folder, split), dataset, dataset_seed, grid, plans, made)


def _check(split: str, seed: int, houses_per_count: int, counts: Sequence[int], workers: int) -> None:
    if split not in SPLITS:
        raise ConfigurationError(f"split={split}: must be one of {', '.join(SPLITS)}")
    if abs(seed) > MOST_SEED:
        raise ConfigurationError(f"seed={seed}: must be between -{MOST_SEED} and {MOST_SEED}")
    if not 1 <= houses_per_count <= 100:
        raise ConfigurationError(f"houses_per_count={houses_per_count}: must be from 1 to 100")
    if workers < 1:
        raise ConfigurationError(f"workers={workers}: must be at least 1")
    unknown = [rooms for rooms in counts if rooms not in ROOM_COUNTS]
    if unknown or not counts:
        known = ", ".join(str(rooms) for rooms in ROOM_COUNTS)
        raise ConfigurationError(f"rooms={list(counts)}: must be some of {known}")


def _write(
    files: SplitFiles,
    dataset: str,
    seed: int,
    grid: TaskGrid,
    plans: Sequence[HousePlan],
    made: Sequence[MadeHouse],
) -> None:
    """Write all files, the tasks last: where they are, the others are whole."""
    lines = b"".join(house.line + b"\n" for house in made)
    tasks = [task for house in made for task in house.tasks]
    hashes = "".join(f"{house.sha256}  {house.house_id}\n" for house in made)
    files.tasks.unlink(missing_ok=True)
    write_compressed(files.houses, lines)
    write_whole(files.house_hashes, hashes.encode())
    write_whole(files.making, _statistics(dataset, files.split, seed, plans, made))
    header = TaskFileHeader(
        dataset=dataset,
        split=files.split,
        seed=seed,
        house_file=files.houses.name,
        house_sha256=hashlib.sha256(lines).hexdigest(),
        houses=tuple(house.house_id for house in made),
        tasks=len(tasks),
        ranges=grid.ranges,
    )
    write_tasks(files.tasks, header, tasks)


def _statistics(
    dataset: str, split: str, seed: int, plans: Sequence[HousePlan], made: Sequence[MadeHouse]
) -> bytes:
    """How many houses of each number of rooms were drawn, and why they were rejected, as JSON."""
    rooms: dict[str, Any] = {}
    for count in sorted({plan.rooms for plan in plans}):
        own = [house for plan, house in zip(plans, made) if plan.rooms == count]
        rejected = sum((house.rejected for house in own), Counter[str]())
        rooms[str(count)] = {
            "houses": len(own),
            "drawn": len(own) + sum(rejected.values()),
            "rejected": dict(sorted(rejected.items())),
        }
    content = {"format": "adhoc-making", "version": 1, "dataset": dataset, "split": split, "seed": seed}
    return (json.dumps({**content, "rooms": rooms}, indent=2) + "\n").encode()
