"""Where a newcomer enters when somebody stands, or something lies, where it was to join."""

from __future__ import annotations

from collections import deque
from dataclasses import replace

from adhoc.core.errors import WorldError
from adhoc.core.geometry import planar_distance
from adhoc.core.values import Pose
from adhoc.worlds.world import World

GRID = 0.25
"""Metres between the poses that are tried: the step of the robots, so that a newcomer stays on their grid."""
OBSTRUCTION = 0.75
"""Metres around the planned pose within which an occupied cell is taken for a robot to walk around."""
MAX_CELLS = 4_000


def joining_pose(world: World, planned: Pose) -> Pose:
    """The planned pose if it is free now, else the nearest free one, facing the same way.

    Nearest is counted in steps of the robots' grid over free floor from the planned pose (which was free
    when the scenario was drawn), so the newcomer stays in the same connected region; ties go to a fixed
    order of directions. The paper is silent: its joining locations are free. Raises WorldError if there
    is none.
    """
    waiting = deque([(0, 0)])
    tried = {(0, 0)}
    while waiting and len(tried) < MAX_CELLS:
        column, row = waiting.popleft()
        pose = replace(planned, x=planned.x + column * GRID, y=planned.y + row * GRID)
        if world.is_free(pose):
            return pose
        if planar_distance(pose, planned) > OBSTRUCTION:
            continue
        for cell in ((column + 1, row), (column, row + 1), (column - 1, row), (column, row - 1)):
            if cell not in tried:
                tried.add(cell)
                waiting.append(cell)
    raise WorldError(
        f"no free place for the newcomer within {OBSTRUCTION + GRID:g} m of ({planned.x:g}, {planned.y:g})"
    )
