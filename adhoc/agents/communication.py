"""The paper's communications as messages (section Communication), written and read in one place.

The payload of every message is JSON; its fields are the functions' below. A stranger may leave out any of
them: reading takes what is there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from adhoc.core.calls import Call
from adhoc.core.messages import Message, MessageKind, TeammateView
from adhoc.core.values import Capability, ObjectRecord, Pose

MAX_ENTRIES = 64
"""Of a list that a stranger sends, objects or rooms, this many are taken."""
MAX_ARGUMENTS = 8
"""Of the arguments of a call likewise."""
MAX_NUMBER = 1e6
"""Larger numbers are not believed."""


def state_payload(
    pose: Pose,
    capability: Capability,
    room: str | None,
    holding: str | None,
    steps_left: int,
    sub_task: Call | None,
    sub_skill: Call | None,
    explored_rooms: Sequence[str] = (),
    stopped: bool = False,
) -> dict[str, Any]:
    """A robot's state and capability, as `join` and `reflected` messages carry them."""
    return {
        "position": [round(pose.x, 3), round(pose.y, 3)],
        "capability": dict(vars(capability)),
        "room": room,
        "holding": holding,
        "steps_left": steps_left,
        "sub_task": call_payload(sub_task),
        "sub_skill": call_payload(sub_skill),
        "explored_rooms": list(explored_rooms),
        "stopped": stopped,
    }


def call_payload(call: Call | None) -> dict[str, Any] | None:
    """A sub-task or sub-skill as JSON."""
    return None if call is None else {"name": call.name, "args": list(call.args)}


def object_payload(record: ObjectRecord) -> dict[str, Any]:
    """A detection as JSON."""
    return {
        "id": record.id,
        "category": record.category,
        "position": [round(value, 3) for value in record.position],
        "room": record.room,
        "receptacle": record.receptacle,
        "receptacle_category": record.receptacle_category,
        "misplaced": record.misplaced,
        "is_receptacle": record.is_receptacle,
        "mass": record.mass,
    }


def join_message(name: str, state: Mapping[str, Any]) -> Message:
    """A newcomer's broadcast of its state and capability."""
    return Message(MessageKind.JOIN, f"I am {name} and I join the team. {_state_text(state)}", state)


def reflected_message(state: Mapping[str, Any], newcomer: str) -> Message:
    """A teammate's answer to a newcomer: its own state and capability."""
    return Message(MessageKind.REFLECTED, _state_text(state), state, recipient=newcomer)


def intention_message(sub_task: Call) -> Message:
    """What the sender is about to do; teammates are expected to reply."""
    return Message(
        MessageKind.INTENTION, f"I intend to do: {sub_task}.", {"intention": call_payload(sub_task)}
    )


def reply_message(
    asker: str, state: Mapping[str, Any], records: Iterable[ObjectRecord], explored_rooms: Sequence[str]
) -> Message:
    """Answer to an intention: previously detected objects, explored rooms, the current sub-task."""
    objects = [object_payload(record) for record in records]
    text = f"{_doing_text(state)} {_explored_text(explored_rooms)} {_objects_text(objects)}"
    payload = {**state, "explored_rooms": list(explored_rooms), "objects": objects}
    return Message(MessageKind.REPLY, text, payload, recipient=asker)


def task_state_message(event: str, state: Mapping[str, Any]) -> Message:
    """The sender began, finished or gave up a sub-task or a sub-skill, or stopped; `event` says which."""
    return Message(MessageKind.TASK_STATE, event, state)


def detection_message(records: Iterable[ObjectRecord], explored_rooms: Sequence[str]) -> Message:
    """Key detections: misplaced objects, receptacles that may take them, and newly explored rooms."""
    objects = [object_payload(record) for record in records]
    text = " ".join(
        filter(None, [_objects_text(objects), _explored_text(explored_rooms) if explored_rooms else ""])
    )
    return Message(MessageKind.DETECTION, text, {"objects": objects, "explored_rooms": list(explored_rooms)})


def read_view(view: TeammateView, message: Message) -> TeammateView:
    """The view of a teammate after a message of its own. What cannot be read is as if it were left out."""
    payload = message.payload
    changes: dict[str, Any] = {"last_heard": max(view.last_heard, message.step)}
    for name in ("room", "holding"):
        if name in payload and isinstance(payload[name], (str, type(None))):
            changes[name] = payload[name]
    if isinstance(payload.get("capability"), Mapping):
        changes["capability"] = read_capability(payload["capability"], view.capability or Capability())
    position = read_numbers(payload.get("position"), 2)
    if position is not None:
        changes["position"] = position
    for name in ("sub_task", "sub_skill"):
        if name in payload:
            changes[name] = read_call(payload[name])
    steps_left = read_numbers([payload.get("steps_left")], 1)
    if steps_left is not None:
        changes["steps_left"] = int(steps_left[0])
    explored = {*view.explored_rooms, *read_explored_rooms(message)}
    changes["explored_rooms"] = tuple(sorted(explored)[:MAX_ENTRIES])
    if isinstance(payload.get("stopped"), bool):
        changes["stopped"] = payload["stopped"]
    return replace(view, **changes)


def read_call(payload: Any) -> Call | None:
    """The call that `call_payload` wrote; None for anything else."""
    if not isinstance(payload, Mapping) or not isinstance(payload.get("name"), str):
        return None
    arguments = payload.get("args", ())
    if not isinstance(arguments, Sequence) or isinstance(arguments, str):
        return None
    plain = [it for it in arguments[:MAX_ARGUMENTS] if isinstance(it, str) or _is_number(it)]
    return Call(payload["name"], tuple(plain))


def read_explored_rooms(message: Message) -> list[str]:
    """The rooms that a message reports as explored."""
    rooms = message.payload.get("explored_rooms", ())
    if not isinstance(rooms, (list, tuple)):
        return []
    return [it for it in rooms[:MAX_ENTRIES] if isinstance(it, str)]


def read_objects(message: Message) -> list[ObjectRecord]:
    """The detections that a message reports, with the sender as their source.

    An object needs an id, a category and a position; one that lacks them is left out.
    """
    entries = message.payload.get("objects", ())
    if not isinstance(entries, (list, tuple)):
        return []
    mappings = [entry for entry in entries[:MAX_ENTRIES] if isinstance(entry, Mapping)]
    records = (_read_object(entry, message) for entry in mappings)
    return [record for record in records if record is not None]


def _read_object(entry: Mapping[str, Any], message: Message) -> ObjectRecord | None:
    name, category = _text(entry, "id"), _text(entry, "category")
    position = read_numbers(entry.get("position"), 3)
    if name is None or category is None or position is None:
        return None
    misplaced = entry.get("misplaced")
    mass = read_numbers([entry.get("mass")], 1)
    return ObjectRecord(
        id=name,
        category=category,
        position=(position[0], position[1], position[2]),
        room=_text(entry, "room"),
        receptacle=_text(entry, "receptacle"),
        receptacle_category=_text(entry, "receptacle_category"),
        misplaced=misplaced if isinstance(misplaced, bool) else None,
        mass=0.0 if mass is None else mass[0],
        is_receptacle=entry.get("is_receptacle") is True,
        is_pickupable=isinstance(misplaced, bool),
        last_seen=message.step,
        source=message.sender,
    )


def read_capability(payload: Mapping[str, Any], known: Capability) -> Capability:
    """The fields that have the right type; the others stay as known."""
    return replace(known, **capability_fields(payload))


def capability_fields(payload: Mapping[str, Any]) -> dict[str, Any]:
    """The fields of a capability that have the right type."""
    return {
        name: payload[name]
        for name, default in vars(Capability()).items()
        if _is_alike(payload.get(name), default)
    }


def _is_alike(value: Any, default: bool | int | float) -> bool:
    if isinstance(default, bool):
        return isinstance(value, bool)
    return _is_number(value) and (isinstance(default, float) or isinstance(value, int))


def _is_number(value: Any) -> bool:
    """Whether it is a number that a house or a robot could have, in metres, kilograms or steps."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= MAX_NUMBER


def read_numbers(value: Any, count: int) -> tuple[float, ...] | None:
    """The first `count` numbers of a list, None if they are not all credible numbers."""
    if not isinstance(value, (list, tuple)) or len(value) < count:
        return None
    numbers = [it for it in value[:count] if _is_number(it)]
    return tuple(float(it) for it in numbers) if len(numbers) == count else None


def _text(entry: Mapping[str, Any], field: str) -> str | None:
    return entry[field] if isinstance(entry.get(field), str) else None


def _state_text(state: Mapping[str, Any]) -> str:
    capability = state["capability"]
    hands = (
        f"can manipulate up to {capability['payload']:.1f} kg"
        if capability["can_manipulate"]
        else "cannot manipulate"
    )
    where = f"in {state['room']}" if state["room"] else f"at {state['position']}"
    return (
        f"I am {where}; I {hands}; my camera is {capability['camera_height']:.1f} m high; "
        f"{state['steps_left']} steps of battery are left. {_doing_text(state)}"
    )


def _doing_text(state: Mapping[str, Any]) -> str:
    holding = f" I hold {state['holding']}." if state.get("holding") else ""
    if state.get("stopped"):
        return f"I have stopped.{holding}"
    sub_task = read_call(state.get("sub_task"))
    return f"Current sub-task: {sub_task or 'none'}.{holding}"


def _explored_text(rooms: Sequence[str]) -> str:
    return f"Explored rooms: {', '.join(rooms) or 'none'}."


def _objects_text(objects: Sequence[Mapping[str, Any]]) -> str:
    if not objects:
        return "Detected objects: none."
    return f"Detected objects: {'; '.join(map(_object_text, objects))}."


def _object_text(entry: Mapping[str, Any]) -> str:
    room = entry["room"] or "an unknown room"
    if entry["is_receptacle"]:
        return f"{entry['id']} ({entry['category']}, a receptacle) in {room}"
    state = {True: "misplaced ", False: "well placed "}.get(entry["misplaced"], "")
    place = entry["receptacle"] or "an unknown place"
    return f"{entry['id']} ({state}{entry['category']}) at {place} in {room}"
