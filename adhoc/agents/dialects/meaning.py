"""What a message means, whatever its format: a bounded list of facts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from adhoc.agents.communication import (
    call_payload,
    capability_fields,
    object_payload,
    read_call,
    read_explored_rooms,
    read_numbers,
    read_objects,
)
from adhoc.core.messages import Message
from adhoc.core.values import Capability
from adhoc.prompting.clean import one_line

Value = str | float | bool | None

MAX_WORD = 1000
"""Characters of a name; the radio lets through no longer ones in payloads either."""
CALLS = ("intention", "sub_task", "sub_skill")
CAPABILITY = tuple(vars(Capability()))
OBJECT = (
    *("id", "category", "x", "y", "z", "room", "receptacle", "receptacle_category"),
    *("misplaced", "is_receptacle", "mass"),
)
"""The values of an `object` fact, in order."""
FACTS = (
    *("stopped", *CALLS, "holding", "room", "position", "explored_rooms", "object", "steps_left"),
    *CAPABILITY,
)
"""All there is to say, in the order in which it is said: what planners need most comes first."""


class Fact(NamedTuple):
    """One thing that a message says: a name of `FACTS` and its values.

    A call is its name and arguments, or nothing if there is none; `explored_rooms` are so many names; an
    `object` has the values of `OBJECT`; `position` has two numbers; all others have one value.
    """

    name: str
    values: tuple[Value, ...]


def is_understood(message: Message) -> bool:
    """Whether the payload says something in the library's own format."""
    payload = message.payload
    return (
        read_numbers(payload.get("position"), 2) is not None
        or isinstance(payload.get("stopped"), bool)
        or any(isinstance(payload.get(name), str) for name in ("room", "holding"))
        or any(read_call(payload.get(name)) is not None for name in CALLS)
        or read_numbers([payload.get("steps_left")], 1) is not None
        or bool(_capability(payload))
        or bool(read_explored_rooms(message))
        or bool(read_objects(message))
    )


def checked(message: Message) -> dict[str, Any]:
    """What can be read of the payload, with clean names of bounded length, and nothing else.

    Empty lists say nothing, and are left out.
    """
    payload = message.payload
    read: dict[str, Any] = {}
    if isinstance(payload.get("stopped"), bool):
        read["stopped"] = payload["stopped"]
    for name in CALLS:
        call = read_call(payload.get(name))
        if call is not None or (name in payload and payload[name] is None):
            read[name] = call_payload(call)
    for name in ("room", "holding"):
        if name in payload and isinstance(payload[name], (str, type(None))):
            read[name] = payload[name]
    position = read_numbers(payload.get("position"), 2)
    steps_left = read_numbers([payload.get("steps_left")], 1)
    several = {
        "position": None if position is None else list(position),
        "explored_rooms": read_explored_rooms(message),
        "objects": [object_payload(record) for record in read_objects(message)],
        "steps_left": None if steps_left is None else int(steps_left[0]),
        "capability": _capability(payload),
    }
    read.update((name, value) for name, value in several.items() if value not in (None, [], {}))
    return {name: _clean(value) for name, value in read.items()}


def facts_of(message: Message) -> list[Fact]:
    """What a message with a payload in the library's own format says, in the order of `FACTS`."""
    payload = checked(message)
    facts = [*_simple_facts(payload), *_call_facts(payload)]
    if "explored_rooms" in payload:
        facts.append(Fact("explored_rooms", tuple(payload["explored_rooms"])))
    for entry in payload.get("objects", ()):
        flat = {**entry, **dict(zip("xyz", entry["position"]))}
        facts.append(Fact("object", tuple(flat[name] for name in OBJECT)))
    facts += [Fact(name, (value,)) for name, value in payload.get("capability", {}).items()]
    return sorted(facts, key=lambda fact: FACTS.index(fact.name))


def payload_of(facts: Iterable[Fact]) -> dict[str, Any]:
    """The inverse of `facts_of`; facts with too few values are left out. It is not checked."""
    payload: dict[str, Any] = {}
    for name, values in facts:
        if name in CALLS:
            payload[name] = {"name": values[0], "args": list(values[1:])} if values else None
        elif name in ("position", "explored_rooms"):
            payload[name] = list(values)
        elif name == "object" and len(values) == len(OBJECT):
            payload.setdefault("objects", []).append(_object(values))
        elif name in CAPABILITY and values:
            payload.setdefault("capability", {})[name] = values[0]
        elif name in FACTS and name != "object" and values:
            payload[name] = values[0]
    return payload


def _capability(payload: Mapping[str, Any]) -> dict[str, Any]:
    capability = payload.get("capability")
    return capability_fields(capability) if isinstance(capability, Mapping) else {}


def _simple_facts(payload: Mapping[str, Any]) -> Iterator[Fact]:
    for name in ("stopped", "holding", "room", "steps_left"):
        if name in payload:
            yield Fact(name, (payload[name],))
    if "position" in payload:
        yield Fact("position", tuple(payload["position"]))


def _call_facts(payload: Mapping[str, Any]) -> Iterator[Fact]:
    for name in CALLS:
        if name in payload:
            call = payload[name]
            yield Fact(name, () if call is None else (call["name"], *call["args"]))


def _object(values: Sequence[Value]) -> dict[str, Any]:
    entry: dict[str, Any] = dict(zip(OBJECT, values))
    entry["position"] = [entry.pop(axis) for axis in "xyz"]
    return entry


def _clean(value: Any) -> Any:
    """The same with clean texts; its depth is that of `checked`."""
    if isinstance(value, str):
        return one_line(value, MAX_WORD)
    if isinstance(value, Mapping):
        return {name: _clean(inner) for name, inner in value.items()}
    return [_clean(inner) for inner in value] if isinstance(value, list) else value
