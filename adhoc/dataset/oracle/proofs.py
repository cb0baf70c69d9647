"""Proofs that a task cannot be done by anybody, however the robots cooperate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from adhoc.dataset.checks.free_cells import FreeCells
from adhoc.dataset.oracle.knowledge import HouseKnowledge, Rules
from adhoc.dataset.oracle.reach import within_reach
from adhoc.dataset.oracle.stances import AIMS, pose_of
from adhoc.evaluation.scenario import Member
from adhoc.houses.solids import Solid, SolidKind
from adhoc.worlds.sensor.box_sensor import BoxSensor
from adhoc.worlds.sensor.box_table import BoxTable, Layer
from adhoc.worlds.sensor.visibility import survey
from adhoc.worlds.world import ObjectTruth

_THINNER = 0.195
"""Metres. A little thinner than robots, so that no cell is missed where the simulator rounds off edges."""


def too_heavy(
    house: HouseKnowledge, objects: Sequence[str], robots: Sequence[Member], rules: Rules
) -> str | None:
    """An object that none of the robots can carry; None if there is none.

    Hand-overs do not help: whoever brings it anywhere has to pick it up first.
    """
    return next((name for name in objects if not _carriers(house, name, robots, rules)), None)


def out_of_sight(
    house: HouseKnowledge,
    truth: Mapping[str, ObjectTruth],
    objects: Sequence[str],
    robots: Sequence[Member],
    rules: Rules,
) -> str | None:
    """An object that no robot which can carry it can ever see within reach; None if there is none.

    Every cell near the object, every aim and every camera height of those robots is tried with the world's
    sensor, in the house without any other thing that could be carried away. Somebody has to see the object
    to pick it up for the first time, so hand-overs do not help.
    """
    for name in objects:
        heights = {robot.capability.camera_height for robot in _carriers(house, name, robots, rules)}
        if not any(_is_ever_seen(house, truth[name], height, rules) for height in sorted(heights)):
            return name
    return None


def _carriers(house: HouseKnowledge, object_id: str, robots: Sequence[Member], rules: Rules) -> list[Member]:
    mass = house.mass(object_id) * rules.mass_scale
    able = (robot for robot in robots if robot.capability.can_manipulate)
    return [robot for robot in able if mass <= robot.capability.payload]


def _is_ever_seen(house: HouseKnowledge, truth: ObjectTruth, height: float, rules: Rules) -> bool:
    target = house.moved(house.solid(truth.id), truth)
    fixed = [solid for solid in house.solids if solid.kind is not SolidKind.ITEM]
    cells = FreeCells(house.rooms, fixed, radius=_THINNER)
    points = (np.argwhere(cells.free) + np.array(cells.origin)) * cells.grid_size
    near = points[within_reach(target.boxes, points, rules.reach)]
    sensor, instances = _camera([target, *_around(target, fixed, rules.reach)], rules)
    for x, y in near.tolist():
        for aim in range(AIMS):
            _, nearest = survey(sensor.look(pose_of((x, y), aim), height, -1), instances)
            if nearest[0] <= rules.reach:
                return True
    return False


def _around(target: Solid, solids: Sequence[Solid], reach: float) -> list[Solid]:
    """Those solids that could come between a robot and a target within reach."""
    corners = np.array([box.center[:2] for box in target.boxes])
    size = max(max(box.half[:2]) for box in target.boxes) * 2**0.5
    low, high = corners.min(axis=0) - size - reach, corners.max(axis=0) + size + reach
    middle, radius = (low + high) / 2, float(np.hypot(*(high - low)) / 2)
    return [solid for solid in solids if within_reach(solid.boxes, middle[None], radius)[0]]


def _camera(solids: Sequence[Solid], rules: Rules) -> tuple[BoxSensor, int]:
    table = BoxTable()
    table.add([solid.boxes for solid in solids], Layer.STATIC)
    return BoxSensor(table, rules.image_size, np.pi / 2, 0), table.instance_count
