"""Rooms, objects and receptacles as rows of a prompt: what matters most, nearest first."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from adhoc.core.plans import Context
from adhoc.core.values import ObjectRecord, Pose, RoomRecord
from adhoc.prompting.clean import name
from adhoc.prompting.limits import Limits

Row = tuple[Any, ...]

_ATTENTION = {True: "yes", False: "no", None: "undecided"}


def room_row(room: RoomRecord, pose: Pose) -> Row:
    """One room."""
    explored = f"by {_who(room.explored_by)}" if room.explored else "no"
    return name(room.id), _type(room), explored, _distance(room.position, pose)


def object_rows(context: Context, limits: Limits) -> tuple[list[Row], list[Row], int]:
    """Rows of the objects of interest in view and of those seen before, and how many were left out.

    What needs attention comes first, then what is undecided, each by distance.
    """
    pose = context.pose
    known = [
        (_urgency(it, context.holding), math.hypot(it.position[0] - pose.x, it.position[1] - pose.y), it)
        for it in context.objects
        if it.id == context.holding or not it.is_receptacle or it.is_pickupable
    ]
    known.sort(key=lambda entry: (entry[0], entry[1], entry[2].id))
    now: list[Row] = []
    before: list[Row] = []
    for _, distance, record in known[: limits.objects]:
        in_view = record.last_seen == context.step and record.source == "me"
        (now if in_view else before).append(_object(record, distance, context.holding, in_view))
    return now, before, max(0, len(known) - limits.objects)


def _urgency(record: ObjectRecord, holding: str | None) -> int:
    if record.id == holding:
        return 0
    return {True: 1, None: 2, False: 3}[record.misplaced]


def _object(record: ObjectRecord, distance: float, holding: str | None, in_view: bool) -> Row:
    place = name(record.receptacle) if record.receptacle else "unknown"
    if record.receptacle_category and record.receptacle_category != record.receptacle:
        place = f"{place} ({name(record.receptacle_category)})"
    x, y, z = record.position
    return (
        name(record.id),
        name(record.category),
        _ATTENTION[record.misplaced],
        record.id == holding,
        name(record.room) if record.room else "unknown",
        place,
        f"({x:.1f}, {y:.1f}, {z:.1f})",
        f"{distance:.1f}",
        f"{record.mass:.2g}" if record.mass else "",
        "" if in_view else f"seen: step {record.last_seen} by {_who(record.source)}",
    )


def receptacle_rows(context: Context, rooms: Mapping[str, RoomRecord], limits: Limits) -> list[Row]:
    """Per room, the nearest few receptacles of every type."""
    pose = context.pose
    found: dict[str, dict[str, list[tuple[float, str]]]] = {}
    for it in context.objects:
        if it.is_receptacle and not it.is_pickupable:
            by_type = found.setdefault(it.room or "", {})
            distance = math.hypot(it.position[0] - pose.x, it.position[1] - pose.y)
            by_type.setdefault(it.category, []).append((distance, it.id))
    rows = []
    for room_id in sorted(found):
        room_type = _type(rooms[room_id]) if room_id in rooms else "unknown"
        shown = [
            f"{name(receptacle)} [{name(category)}, {distance:.1f} m]"
            for category in sorted(found[room_id])
            for distance, receptacle in sorted(found[room_id][category])[: limits.receptacles_per_type]
        ]
        rows.append((name(room_id) if room_id else "room unknown", room_type, "; ".join(shown)))
    return rows


def _type(room: RoomRecord) -> str:
    return name(room.room_type) if room.room_type else "unknown"


def _who(source: str | None) -> str:
    return "you" if source in ("me", None) else name(str(source))


def _distance(point: tuple[float, float], pose: Pose) -> str:
    return f"{math.hypot(point[0] - pose.x, point[1] - pose.y):.1f}"
