"""A planning context as the plain rows that the templates lay out.

Rows are tuples of strings, in the order in which the templates unpack them. Everything that another robot
or a world has named goes through `prompting.clean`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from adhoc.core.calls import Call, CallSpec, ParameterKind, TaskBrief
from adhoc.core.messages import Message, TeammateView
from adhoc.core.plans import Assessment, Candidate, Context
from adhoc.core.values import ObjectRecord, Pose, RoomRecord
from adhoc.prompting.clean import name, one_line, quoted
from adhoc.prompting.stage import StageInput

Row = tuple[Any, ...]

_ARGUMENT_WORDS = {
    ParameterKind.OBJECT: "object id",
    ParameterKind.RECEPTACLE: "receptacle id",
    ParameterKind.ROOM: "room id",
    ParameterKind.RECEPTACLE_TYPE: "receptacle type",
    ParameterKind.ROOM_TYPE: "room type",
    ParameterKind.NUMBER: "number",
}
_ATTENTION = {True: "yes", False: "no", None: "undecided"}


@dataclass(frozen=True)
class Limits:
    """How much of each list a prompt carries; see `PromptLibrary`."""

    messages: int = 40
    history: int = 12
    message_characters: int = 1000
    reply_characters: int = 4000
    objects: int = 15
    receptacles_per_type: int = 3


def describe(context: Context, stage: StageInput, limits: Limits) -> dict[str, Any]:
    """Every variable that a template may use.

    A subject that the stage does not have (`chosen`, `current`) is left undefined, so that a template that
    needs it fails instead of saying nothing.
    """
    rooms = {room.id: room for room in context.rooms}
    now, before, left_out = _objects(context, limits)
    subjects = {"chosen": _chosen(stage.chosen, limits), "current": _current(stage.sub_task, context.task)}
    return {
        "task": _task(context.task),
        "examples": dict(context.task.examples),
        "me": _me(context),
        "last": _last(stage.last, limits),
        "rooms": [_room(room, context.pose) for room in context.rooms],
        "objects_now": now,
        "objects_before": before,
        "objects_left_out": left_out,
        "receptacles": _receptacles(context, rooms, limits),
        "teammates": [_teammate(view) for view in context.teammates],
        "messages": [
            _message(message, context.me, limits.message_characters)
            for message in _latest(_unlisted(context.messages, stage.replies), limits.messages)
        ],
        "history": [
            (event.step, one_line(event.text, limits.message_characters))
            for event in _latest(context.history, limits.history)
        ],
        "count": stage.count,
        "candidates": [_candidate(*entry, limits) for entry in enumerate(stage.candidates)],
        "replies": [_message(message, context.me, limits.reply_characters) for message in stage.replies],
        "predictions": [
            (name(it.teammate), _call(it.sub_task, "unknown"), _call(it.sub_skill, "unknown"))
            for it in stage.predictions
        ],
        **{name: value for name, value in subjects.items() if value is not None},
    }


def _unlisted(messages: Sequence[Message], replies: Sequence[Message]) -> Sequence[Message]:
    """The messages without the replies, which have a section of their own."""
    replied = {_identity(reply) for reply in replies}
    return [message for message in messages if _identity(message) not in replied]


def _identity(message: Message) -> tuple[str, int, str, str]:
    return message.sender, message.step, message.kind.value, message.text


def _latest(items: Sequence[Any], count: int) -> Sequence[Any]:
    return items[-count:] if count > 0 else ()


def _task(brief: TaskBrief) -> dict[str, Any]:
    alone = {
        spec.steps[0]: spec.name for spec in brief.sub_tasks if not spec.parameters and len(spec.steps) == 1
    }
    return {
        "name": brief.name,
        "description": brief.description,
        "sub_tasks": [_spec(spec, "") for spec in brief.sub_tasks],
        "sub_skills": [_spec(spec, alone.get(spec.name, "")) for spec in brief.sub_skills],
    }


def _spec(spec: CallSpec, whole_of: str) -> dict[str, Any]:
    return {
        "signature": spec.signature,
        "needs_manipulation": spec.needs_manipulation,
        "description": spec.description,
        "arguments": "; ".join(f"{it.name}: {_ARGUMENT_WORDS[it.kind]}" for it in spec.parameters),
        "steps": "; ".join(spec.steps),
        "whole_of": whole_of,
    }


def _me(context: Context) -> dict[str, Any]:
    pose, capability = context.pose, context.capability
    return {
        "step": context.step,
        "name": name(context.me),
        "position": f"({pose.x:.1f}, {pose.y:.1f})",
        "heading": f"{math.degrees(pose.yaw):.0f}",
        "room": name(context.room) if context.room else "unknown",
        "holding": name(context.holding) if context.holding else "nothing",
        "sub_task": _call(context.sub_task, "none"),
        "done": ", ".join(map(_call, context.done)) or "none",
        "navigation": _yes(capability.can_navigate),
        "manipulation": _yes(capability.can_manipulate),
        "payload": f"{capability.payload:g}",
        "camera_height": f"{capability.camera_height:g}",
        "steps_left": context.steps_left,
        "max_steps": capability.max_steps,
    }


def _room(room: RoomRecord, pose: Pose) -> Row:
    explored = f"by {_who(room.explored_by)}" if room.explored else "no"
    return name(room.id), _type(room), explored, _distance(room.position, pose)


def _objects(context: Context, limits: Limits) -> tuple[list[Row], list[Row], int]:
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


def _receptacles(context: Context, rooms: Mapping[str, RoomRecord], limits: Limits) -> list[Row]:
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


def _teammate(view: TeammateView) -> Row:
    return (
        name(view.name),
        "; ".join(_ability(view)),
        "unknown" if view.position is None else f"({view.position[0]:.1f}, {view.position[1]:.1f})",
        name(view.room) if view.room else "unknown",
        name(view.holding) if view.holding else "nothing",
        _call(view.sub_task, "unknown"),
        _call(view.sub_skill, "unknown"),
        ", ".join(map(name, view.explored_rooms)) or "none",
        f"step {view.last_heard}" if view.last_heard >= 0 else "never",
        view.stopped,
    )


def _ability(view: TeammateView) -> Iterator[str]:
    """What a teammate can do; of its battery what is left, else what a full one holds."""
    capability = view.capability
    if capability is None:
        yield "capability: unknown"
    else:
        yield f"manipulation: {_yes(capability.can_manipulate)}"
        yield f"payload: {capability.payload:g} kg"
        yield f"camera height: {capability.camera_height:g} m"
    if view.steps_left is not None:
        yield f"battery: {view.steps_left} steps left"
    elif capability is not None:
        yield f"full battery: {capability.max_steps} steps"


def _message(message: Message, me: str, characters: int) -> Row:
    """One message, of the robot's own or another's; without words, its payload stands for them."""
    text = message.text or json.dumps(dict(message.payload), ensure_ascii=False, default=str)
    recipient = _party(message.recipient, me) if message.recipient else "all"
    sender = _party(message.sender, me) or "unknown"
    return message.step, sender, recipient, message.kind.value, quoted(text, characters)


def _party(robot: str, me: str) -> str:
    return "you" if robot == me else name(robot)


def _candidate(index: int, candidate: Candidate, limits: Limits) -> Row:
    return index, _call(candidate.sub_task), one_line(candidate.rationale, limits.message_characters)


def _chosen(candidate: Candidate | None, limits: Limits) -> dict[str, str] | None:
    if candidate is None:
        return None
    _, sub_task, rationale = _candidate(0, candidate, limits)
    return {"sub_task": sub_task, "rationale": rationale}


def _current(sub_task: Call | None, brief: TaskBrief) -> dict[str, str] | None:
    if sub_task is None:
        return None
    spec = next((it for it in brief.sub_tasks if it.name == sub_task.name), CallSpec(sub_task.name, (), ""))
    return {
        "sub_task": _call(sub_task),
        "description": spec.description,
        "arguments": "; ".join(
            f"{parameter.name} ({_ARGUMENT_WORDS[parameter.kind]}) = {name(str(argument))}"
            for parameter, argument in zip(spec.parameters, sub_task.args)
        ),
        "steps": "; ".join(spec.steps),
    }


def _last(last: Assessment | None, limits: Limits) -> str:
    if last is None:
        return ""
    parts: Iterable[str] = (
        "ok" if last.ok else "failed",
        last.reason,
        f"found {', '.join(last.found)}" if last.found else "",
    )
    return one_line(": ".join(part for part in parts if part), limits.message_characters)


def _call(call: Call | None, nothing: str = "none") -> str:
    return nothing if call is None else name(str(call))


def _type(room: RoomRecord) -> str:
    return name(room.room_type) if room.room_type else "unknown"


def _who(source: str | None) -> str:
    return "you" if source in ("me", None) else name(str(source))


def _yes(flag: bool) -> str:
    return "yes" if flag else "no"


def _distance(point: tuple[float, float], pose: Pose) -> str:
    return f"{math.hypot(point[0] - pose.x, point[1] - pose.y):.1f}"
