"""A planning context as the plain rows that the templates lay out.

Rows are tuples of strings, in the order in which the templates unpack them. Everything that another robot
or a world has named goes through `prompting.clean`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator
from typing import Any

from adhoc.core.calls import Call, CallSpec, ParameterKind, TaskBrief
from adhoc.core.messages import Message, TeammateView
from adhoc.core.plans import Assessment, Candidate, Context
from adhoc.prompting.clean import name, one_line, quoted
from adhoc.prompting.limits import Limits, history_shown, messages_shown
from adhoc.prompting.stage import StageInput
from adhoc.prompting.surroundings import Row, object_rows, receptacle_rows, room_row

_ARGUMENT_WORDS = {
    ParameterKind.OBJECT: "object id",
    ParameterKind.RECEPTACLE: "receptacle id",
    ParameterKind.ROOM: "room id",
    ParameterKind.RECEPTACLE_TYPE: "receptacle type",
    ParameterKind.ROOM_TYPE: "room type",
    ParameterKind.NUMBER: "number",
}


def describe(context: Context, stage: StageInput, limits: Limits) -> dict[str, Any]:
    """Every variable that a template may use.

    A subject that the stage does not have (`chosen`, `current`) is left undefined, so that a template that
    needs it fails instead of saying nothing.
    """
    rooms = {room.id: room for room in context.rooms}
    now, before, left_out = object_rows(context, limits)
    subjects = {"chosen": _chosen(stage.chosen, limits), "current": _current(stage.sub_task, context.task)}
    return {
        "task": _task(context.task),
        "examples": dict(context.task.examples),
        "me": _me(context),
        "last": _last(stage.last, limits),
        "rooms": [room_row(room, context.pose) for room in context.rooms],
        "objects_now": now,
        "objects_before": before,
        "objects_left_out": left_out,
        "receptacles": receptacle_rows(context, rooms, limits),
        "abilities": [(name(view.name), "; ".join(_ability(view))) for view in context.teammates],
        "teammates": [_teammate(view) for view in context.teammates],
        "messages": [
            _message(message, context.me, limits.message_characters)
            for message in messages_shown(context, stage.replies, limits)
        ],
        "history": [
            (event.step, one_line(event.text, limits.message_characters))
            for event in history_shown(context, limits)
        ],
        "count": stage.count,
        "candidates": [_candidate(*entry, limits) for entry in enumerate(stage.candidates)],
        "replies": [_message(message, context.me, limits.reply_characters) for message in stage.replies],
        "predictions": [
            (name(it.teammate), _call(it.sub_task, "unknown"), _call(it.sub_skill, "unknown"))
            for it in stage.predictions
        ],
        "plans": [(name(robot), _call(sub_task)) for robot, sub_task in stage.plans.items()],
        "objections": [
            (name(it.objector), _call(it.sub_task), quoted(it.reason, limits.reply_characters))
            for it in stage.objections
        ],
        "changes": [one_line(it, limits.message_characters) for it in stage.changes],
        **{name: value for name, value in subjects.items() if value is not None},
    }


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


def _teammate(view: TeammateView) -> Row:
    return (
        name(view.name),
        "unknown" if view.steps_left is None else f"{view.steps_left} steps left",
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
    """What a teammate can do, which stays as it is."""
    capability = view.capability
    if capability is None:
        yield "capability: unknown"
    else:
        yield f"manipulation: {_yes(capability.can_manipulate)}"
        yield f"payload: {capability.payload:g} kg"
        yield f"camera height: {capability.camera_height:g} m"
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


def _yes(flag: bool) -> str:
    return "yes" if flag else "no"
