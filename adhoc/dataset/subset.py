"""Which tasks of a split stand for all: a choice by rule, made before anything was run."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from adhoc.dataset.making.house_tasks import task_id

ROOMS = ((1, 2, 3), (4, 5, 6), (7, 8, 10))
"""The paper's numbers of rooms by difficulty: Easy, Medium, Difficult."""
PER_DIFFICULTY = 10


def sample(split: str) -> tuple[str, ...]:
    """The ids of 30 tasks: ten of each difficulty and of each size of team, six of each number of misplaced
    objects, every number of rooms, and no house twice.

    Task i (from 0) of difficulty d (from 0) is in a house with the difficulty's number of rooms number
    i mod 3, the next house of that number each time; it has 1 + (i mod 5) misplaced objects and
    3 + ((i div 3 + i + d) mod 3) teammates, so that no two of the three go together. The tasks of the three
    difficulties take turns, so that the first few are of all kinds.
    """
    return tuple(
        task_id(f"{split}-{rooms[i % 3]:02d}-{i // 3:02d}", 1 + i % 5, 3 + (i // 3 + i + d) % 3)
        for i in range(PER_DIFFICULTY)
        for d, rooms in enumerate(ROOMS)
    )


SUBSETS: Mapping[str, Callable[[str], tuple[str, ...]]] = {"sample": sample}
"""By name: from a split to the ids of its tasks, in order."""
