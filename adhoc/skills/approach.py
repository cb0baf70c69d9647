"""Getting near a thing and looking at it: shared by the skills that deal with objects."""

from __future__ import annotations

import math
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from adhoc.core.values import Action, ObjectRecord, Observation
from adhoc.skills.bounded import level_camera
from adhoc.skills.navigator import Travel
from adhoc.skills.skill import SkillView

_IN_VIEW = math.radians(38)
"""Within this angle of the optical axis a thing is safely inside a view of 90 degrees."""

_TOLD_HALF = 0.03
_MARGIN = 0.1
_NEARER = 0.3


class Approached(Enum):
    """How an approach can end."""

    IN_REACH = "in reach and in view"
    GONE = "not there"
    UNREACHABLE = "no way"


class Approach:
    """Brings a known object into view and within reach, from another standing place if one shows nothing.

    Args:
        object_id: The object or receptacle.
        reach: Horizontal metres to its nearest visible point at which the approach ends.
        attempts: Standing places that are tried.
    """

    def __init__(self, object_id: str, reach: float, attempts: int) -> None:
        self.object_id = object_id
        self.reach = reach
        self._attempts = attempts
        self._nearest = reach - _MARGIN
        self._aimed = False
        self._looked = False
        self._left: tuple[float, float] | None = None

    def begin(self, view: SkillView) -> None:
        """Forget the standing places of earlier approaches."""
        view.navigator.forget_set_aside()

    def next_action(self, view: SkillView) -> Action | Approached:
        """The next action, or how the approach ended."""
        observation = view.observation
        here = (observation.pose.x, observation.pose.y)
        if self._left != here and visible_distance(observation, self.object_id) <= self.reach:
            return Approached.IN_REACH
        record = view.objects.get(self.object_id)
        if record is None:
            return Approached.GONE
        for _ in range(self._attempts + 1):
            if not self._aimed and not self._aim(view, record):
                return Approached.GONE if self._looked else Approached.UNREACHABLE
            step = view.navigator.travel(observation)
            if isinstance(step, Action):
                return level_camera(view) or step
            if step is Travel.ARRIVED:
                turn = self._face(view, record)
                if turn is not None:
                    return turn
                self._looked = True
            self.try_elsewhere(view, unreachable=step is Travel.UNREACHABLE)
        return Approached.GONE if self._looked else Approached.UNREACHABLE

    def try_elsewhere(self, view: SkillView, unreachable: bool = False) -> None:
        """Give up this standing place, and one of the attempts; the approach ends at another one."""
        self._left = (view.observation.pose.x, view.observation.pose.y)
        self._attempts = 0 if unreachable else self._attempts - 1
        view.navigator.set_aside(view.observation.pose)
        if math.isfinite(visible_distance(view.observation, self.object_id)):
            self._nearest = max(self._nearest - _NEARER, _NEARER)
        self._aimed = False

    def _aim(self, view: SkillView, record: ObjectRecord) -> bool:
        if self._attempts <= 0:
            return False
        height = float(view.observation.camera.world_from_camera[2, 3])
        self._aimed = view.navigator.aim_at_object(box_of(view, record), record.id, height, self._nearest)
        return self._aimed

    def _face(self, view: SkillView, record: ObjectRecord) -> Action | None:
        observation = view.observation
        box = box_of(view, record)
        pose, height = observation.pose, float(observation.camera.world_from_camera[2, 3])
        x, y = min(max(pose.x, box[0]), box[3]), min(max(pose.y, box[1]), box[4])
        if math.hypot(x - pose.x, y - pose.y) < 0.5:
            x, y = (x + (box[0] + box[3]) / 2) / 2, (y + (box[1] + box[4]) / 2) / 2
        turn = view.navigator.turn_toward(observation, x - pose.x, y - pose.y, _IN_VIEW)
        if turn is not None:
            return turn
        target = min(max((box[2] + box[5]) / 2, box[5] - 0.3), box[5])
        down = math.atan2(height - target, max(math.hypot(x - pose.x, y - pose.y), 0.1))
        return view.navigator.tilt_toward(observation, down, math.radians(20))


def visible_distance(observation: Observation, object_id: str) -> float:
    """Horizontal metres from the robot to the nearest pixel of an object; inf if it is not in view."""
    key = next((key for key, label in observation.labels.items() if label.id == object_id), None)
    if key is None:
        return math.inf
    rows, columns = np.nonzero(observation.instances == key)
    if rows.size == 0:
        return math.inf
    camera = observation.camera
    focal, u0, v0 = camera.intrinsics[0, 0], camera.intrinsics[0, 2], camera.intrinsics[1, 2]
    rays = np.stack([(columns - u0) / focal, (rows - v0) / focal, np.ones(rows.size)])
    points = camera.world_from_camera[:2, :3] @ rays * observation.depth[rows, columns]
    return float(np.sqrt((points**2).sum(0)).min())


def box_of(view: SkillView, record: ObjectRecord) -> NDArray[np.float64]:
    """The box (x0, y0, z0, x1, y1, z1) around what was seen of an object, or around the place told of."""
    extent = view.map.extent_of(record.id)
    if extent is not None:
        return np.array([*extent[0], *extent[1]])
    position = np.array(record.position)
    return np.concatenate([position - _TOLD_HALF, position + _TOLD_HALF])
