"""A situation as a row of numbers of fixed size."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from adhoc.agents.learned.situation import Detection, Other, OwnState, Situation, Spot
from adhoc.core.geometry import planar_distance
from adhoc.houses.facts import ROOM_TYPES

OWN_SIZE = 16 + len(ROOM_TYPES)
DETECTION_SLOTS, DETECTION_SIZE = 5, 11
"""The nearest detections; the paper's tasks have at most five misplaced objects."""
OTHER_SLOTS, OTHER_SIZE = 5, 14
"""The nearest others: the paper's teams have at most five members, and one may join."""
FEATURE_SIZE = OWN_SIZE + DETECTION_SLOTS * DETECTION_SIZE + OTHER_SLOTS * OTHER_SIZE

_FAR, _HEAVY, _STEPS, _ROOMS = 10.0, 20.0, 500.0, 10.0
_MOST = 3.0
"""No feature is larger: foreign messages may tell of anything."""


def encode(situation: Situation) -> NDArray[np.float32]:
    """(`FEATURE_SIZE`,) numbers: own state, then detections and others, each nearest first.

    Empty slots are zero; the first number of a slot says whether it is filled. Lengths are in units of 10 m,
    directions in the robot's own frame, masses in units of 20 kg, steps in units of 500.
    """
    own = situation.own
    detections = sorted(situation.detections, key=lambda it: (_away(own, it.position), it.id))
    others = sorted(situation.others, key=lambda it: (_away(own, it.position), it.name))
    nearest = next((it for it in detections if _is_open(own, it)), None)
    row = np.concatenate(
        [
            np.array(_own_numbers(own, detections, others), np.float32),
            _slots([_of_detection(own, it, others) for it in detections], DETECTION_SLOTS, DETECTION_SIZE),
            _slots([_of_other(own, it, nearest) for it in others], OTHER_SLOTS, OTHER_SIZE),
        ]
    )
    return np.clip(row, -_MOST, _MOST)


def _own_numbers(own: OwnState, detections: Sequence[Detection], others: Sequence[Other]) -> list[float]:
    able = own.capability.can_manipulate
    return [
        able,
        own.capability.camera_height / 2.0,
        own.capability.payload / _HEAVY if able else 0.0,
        own.steps_left / _STEPS,
        own.step / _STEPS,
        own.holding,
        own.place_known,
        own.idle,
        own.frontiers > 0,
        own.frontiers / 10.0,
        own.rooms_known / _ROOMS,
        own.rooms_explored / max(1, own.rooms_known),
        any(_is_open(own, it) for it in detections),
        any(it.given_up for it in detections),
        all(it.stopped or (it.idle and not it.busy) for it in others),
        len(others) / OTHER_SLOTS,
        *(own.room_types.get(name, 0.0) for name in ROOM_TYPES),
    ]


def _of_detection(own: OwnState, detection: Detection, others: Iterable[Other]) -> list[float]:
    rivals = sum(_is_rival(it, detection, _away(own, detection.position)) for it in others)
    return [
        1.0,
        *_bearing(own, detection.position),
        _away(own, detection.position) / _FAR,
        detection.mass / _HEAVY,
        _can_lift(own, detection),
        detection.handled,
        detection.given_up,
        rivals / OTHER_SLOTS,
        (own.step - detection.last_seen) / 100.0,
        detection.certainty,
    ]


def _of_other(own: OwnState, other: Other, nearest: Detection | None) -> list[float]:
    to_nearest = 0.0
    if nearest is not None and other.position is not None:
        to_nearest = planar_distance(other.position, nearest.position)
    able = other.capability.can_manipulate
    return [
        1.0,
        *_bearing(own, other.position),
        min(_away(own, other.position), _MOST * _FAR) / _FAR,
        other.position is not None,
        able,
        other.capability.payload / _HEAVY if able else 0.0,
        other.busy,
        other.idle,
        other.stopped,
        to_nearest / _FAR,
        nearest is not None and _is_rival(other, nearest, _away(own, nearest.position)),
        nearest is not None and nearest.id in other.unable,
        other.name < own.name,
    ]


def _is_open(own: OwnState, detection: Detection) -> bool:
    """Whether the robot could take it, as far as it knows."""
    return _can_lift(own, detection) and not detection.handled and not detection.given_up


def _can_lift(own: OwnState, detection: Detection) -> bool:
    return own.capability.can_manipulate and detection.mass <= own.capability.payload


def _is_rival(other: Other, detection: Detection, away: float) -> bool:
    """Whether another robot could take the object, is free for it, and is nearer to it."""
    if other.stopped or other.busy or detection.id in other.unable or other.position is None:
        return False
    able = other.capability.can_manipulate and detection.mass <= other.capability.payload
    return able and planar_distance(other.position, detection.position) < away


def _away(own: OwnState, position: Spot | None) -> float:
    return math.inf if position is None else planar_distance(own.position, position)


def _bearing(own: OwnState, position: Spot | None) -> tuple[float, float]:
    """Ahead and to the left, in units of 10 m."""
    if position is None:
        return (0.0, 0.0)
    dx, dy = position[0] - own.pose.x, position[1] - own.pose.y
    cos_yaw, sin_yaw = math.cos(own.pose.yaw), math.sin(own.pose.yaw)
    return ((dx * cos_yaw + dy * sin_yaw) / _FAR, (dy * cos_yaw - dx * sin_yaw) / _FAR)


def _slots(rows: Sequence[Sequence[float]], slots: int, size: int) -> NDArray[np.float32]:
    filled = np.zeros((slots, size), np.float32)
    for position, row in enumerate(rows[:slots]):
        filled[position] = row
    return filled.reshape(-1)
