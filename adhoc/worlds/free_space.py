"""The cells of a house where a robot fits, and which of them it can reach from each other."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator

from adhoc.core.errors import WorldError
from adhoc.core.streams import stream
from adhoc.core.values import Pose
from adhoc.worlds.motion import Motion
from adhoc.worlds.scene import Scene

Cell = tuple[int, int]
"""Column and row of the lattice: x and y in multiples of the grid size."""


class FreeSpace:
    """A lattice through the world's origin, one cell a move wide.

    Two neighbouring cells (4-connected) belong together if the move between them is free; only the largest
    connected part is used, and of equally large ones the one with the smallest cell. Robots count as
    obstacles for the pose they stand at, not for what is connected, since they move.
    """

    def __init__(self, scene: Scene, motion: Motion, grid_size: float, rotation: float) -> None:
        self._scene = scene
        self._motion = motion
        self._grid_size = grid_size
        self._turns = max(1, round(2 * math.pi / rotation))
        self._rotation = rotation

    def has_any(self) -> bool:
        """Whether there is a free cell at all."""
        return any(self._motion.misfit(self._pose(cell)) is None for cell in self._cells())

    def draw(self, count: int, seed: int, robots: Collection[int], spacing: float) -> list[Pose]:
        """`count` free poses of the largest part, at least `spacing` metres from each other.

        `robots` are the bodies that do not count for what is connected. Raises WorldError if there are
        fewer.
        """
        part = self.largest_part(robots)
        generator = stream(seed, "free poses")
        poses: list[Pose] = []
        for index in generator.permutation(len(part)):
            if len(poses) == count:
                break
            pose = self._pose(part[index])
            apart = all(math.dist((pose.x, pose.y), (other.x, other.y)) >= spacing for other in poses)
            if apart and self._motion.misfit(pose) is None:
                turn = int(generator.integers(self._turns)) - (self._turns - 1) // 2
                poses.append(Pose(pose.x, pose.y, turn * self._rotation))
        if len(poses) < count:
            raise WorldError(
                f"{count} free poses were asked for, the house has {len(poses)} "
                f"({len(part)} connected cells of {self._grid_size:g} m)"
            )
        return poses

    def largest_part(self, robots: Collection[int]) -> list[Cell]:
        """The cells of the largest connected part, sorted."""
        free = {cell for cell in self._cells() if self._motion.misfit(self._pose(cell), robots) is None}
        parts: list[list[Cell]] = []
        unseen = set(free)
        for cell in sorted(free):
            if cell in unseen:
                parts.append(self._spread(cell, unseen, robots))
        return max(parts, key=len, default=[])

    def _spread(self, start: Cell, unseen: set[Cell], robots: Collection[int]) -> list[Cell]:
        unseen.discard(start)
        part, front = [start], [start]
        while front:
            cell = front.pop()
            for neighbour in _neighbours(cell):
                if neighbour not in unseen:
                    continue
                if self._motion.obstacle(self._pose(cell), self._pose(neighbour), robots) is None:
                    unseen.discard(neighbour)
                    part.append(neighbour)
                    front.append(neighbour)
        return sorted(part)

    def _cells(self) -> Iterator[Cell]:
        corners = [corner for room in self._scene.rooms for corner in room.polygon]
        columns, rows = zip(*corners)
        size = self._grid_size
        for column in range(math.floor(min(columns) / size), math.ceil(max(columns) / size) + 1):
            for row in range(math.floor(min(rows) / size), math.ceil(max(rows) / size) + 1):
                if self._scene.room_at((column * size, row * size)) is not None:
                    yield column, row

    def _pose(self, cell: Cell) -> Pose:
        return Pose(cell[0] * self._grid_size, cell[1] * self._grid_size)


def _neighbours(cell: Cell) -> tuple[Cell, Cell, Cell, Cell]:
    column, row = cell
    return (column + 1, row), (column - 1, row), (column, row + 1), (column, row - 1)
