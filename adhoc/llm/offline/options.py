"""What a robot could do: every sub-task of the vocabulary filled with what the prompt knows, best first."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from adhoc.llm.offline.facts import CallText, Facts, ObjectFact, SpecFact
from adhoc.llm.offline.knowledge import Knowledge, failures, refused_now

HELD, NEEDED, UNEXPLORED, ELSEWHERE, SHARED, HOPELESS, LAST_RESORT = range(7)
"""Preference: what is in the hand; what needs attention; rooms to explore; other places for what needs
attention; rooms that a teammate explores already; what failed before; what needs no argument."""

_PATIENCE = 3
"""So many failures with a thing or a room put everything about it behind; a thing in the hand stays first."""
_PLACES = 3
"""The best places of a thing that are considered."""
_CROWDING = 5.0
"""Metres that a teammate in a room is worth: rather explore another one."""


class Option(NamedTuple):
    """One sub-task that could be done, its preference, its cost in metres, and why."""

    call: CallText
    preference: int
    cost: float
    reason: str


def options(facts: Facts, knowledge: Knowledge) -> list[Option]:
    """All sub-tasks that make sense, best first; those refused at this very step are left out.

    What needs no argument is the last resort: it is there only if nothing else is.
    """
    refused = refused_now(facts)
    found = [
        it for spec in facts.sub_tasks for it in _grounded(facts, knowledge, spec) if it.call not in refused
    ]
    found.sort(key=lambda it: (it.preference, it.cost, it.call))
    useful = [it for it in found if it.preference < LAST_RESORT]
    return useful or found


def unattended(facts: Facts, knowledge: Knowledge) -> Iterator[CallText]:
    """What this robot could do about things in need that nobody else is at, refused at this step or not."""
    for spec in facts.sub_tasks:
        if "object id" in spec.parameters.values():
            yield from (it.call for it in _grounded(facts, knowledge, spec))


def objection(facts: Facts, call: CallText) -> str | None:
    """Why the robot should not do `call` by what the prompt says besides the replies, or None."""
    spec = next((it for it in facts.sub_tasks if it.name == call.name), None)
    if spec is None:
        return f"{call.name} is not a sub-task"
    if spec.needs_manipulation and not facts.manipulation:
        return f"{call.name} needs manipulation, which I lack"
    for kind, value in zip(spec.parameters.values(), call.args):
        reason = _object_objection(facts, value) if kind == "object id" else None
        if kind == "room id" and any(it.id == value and it.explored for it in facts.rooms):
            reason = f"{value} is explored already"
        if reason is not None:
            return reason
    return None


def claimant(facts: Facts, identifier: str) -> str | None:
    """The teammate that is at the thing or room, or None."""
    return next((it.name for it in facts.teammates if identifier in it.claims), None)


def _object_objection(facts: Facts, identifier: str) -> str | None:
    who = claimant(facts, identifier)
    if who is not None:
        return f"{who} is at {identifier}"
    thing = next((it for it in facts.objects if it.id == identifier), None)
    if thing is None:
        return None if identifier == facts.holding else f"{identifier} is gone"
    if thing.mass > facts.payload:
        return f"{identifier} is too heavy for me"
    if thing.attention is False and identifier != facts.holding:
        return f"{identifier} needs no attention any more"
    return None


def _grounded(facts: Facts, knowledge: Knowledge, spec: SpecFact) -> Iterator[Option]:
    kinds = tuple(spec.parameters.values())
    if not kinds:
        yield Option(CallText(spec.name), LAST_RESORT, 0.0, "nothing else is left to do")
    elif "number" in kinds or (spec.needs_manipulation and not facts.manipulation):
        return
    elif "object id" in kinds:
        for thing in _needed(facts, spec.needs_manipulation):
            yield from _about_object(facts, knowledge, spec, kinds, thing)
    elif kinds == ("room id",):
        yield from _about_rooms(facts, spec)
    elif kinds == ("receptacle id",):
        for it in itertools.chain.from_iterable(facts.receptacles.values()):
            yield Option(CallText(spec.name, (it.id,)), ELSEWHERE, it.distance, f"{it.id} is known")


def _needed(facts: Facts, with_hands: bool) -> list[ObjectFact]:
    """What needs attention and is free for this robot; with a full hand only what is in it."""
    held = [it for it in facts.objects if it.id == facts.holding]
    if with_hands and facts.holding is not None:
        return held
    return [it for it in facts.objects if it.attention and _object_objection(facts, it.id) is None]


def _about_object(
    facts: Facts, knowledge: Knowledge, spec: SpecFact, kinds: Sequence[str], thing: ObjectFact
) -> Iterator[Option]:
    first = HELD if thing.id == facts.holding else NEEDED
    if first == NEEDED and failures(facts, thing.id) >= _PATIENCE:
        first = HOPELESS
    nearer = _nearer_helpers(facts, thing, spec.needs_manipulation)
    reason = (
        f"{thing.id} is in my hand"
        if first == HELD
        else f"{thing.id} needs attention, {thing.distance:.1f} m away"
    )
    if not {"receptacle type", "room type"} & set(kinds):
        yield Option(_fill(spec, kinds, thing, None, None), first, thing.distance + nearer, reason)
        return
    for rank, place in enumerate(knowledge.places(facts, thing)[:_PLACES]):
        preference = first if rank == 0 else max(first, ELSEWHERE)
        call = _fill(spec, kinds, thing, place.receptacle, place.room_type)
        why = f"{reason}; it belongs on {place.receptacle} in {place.room_type}"
        yield Option(call, preference, thing.distance + nearer + rank, why)


def _fill(
    spec: SpecFact, kinds: Sequence[str], thing: ObjectFact, receptacle: str | None, room_type: str | None
) -> CallText:
    values = {
        "object id": thing.id,
        "receptacle id": thing.receptacle,
        "room id": thing.room,
        "receptacle type": receptacle,
        "room type": room_type,
    }
    return CallText(spec.name, tuple(values.get(kind) or "unknown" for kind in kinds))


def _nearer_helpers(facts: Facts, thing: ObjectFact, with_hands: bool) -> float:
    """A detour in metres for each free teammate that is nearer to the thing and could do it as well."""
    if thing.position is None:
        return 0.0
    free = (
        it
        for it in facts.teammates
        if it.position is not None
        and it.holding is None
        and (not with_hands or (it.manipulation and it.payload >= thing.mass))
        and math.dist(it.position, thing.position) < thing.distance
    )
    return _CROWDING * sum(1 for _ in free)


def _about_rooms(facts: Facts, spec: SpecFact) -> Iterator[Option]:
    for room in facts.rooms:
        if room.explored:
            continue
        who = claimant(facts, room.id)
        crowd = sum(1 for it in facts.teammates if it.room == room.id)
        preference = UNEXPLORED if who is None else SHARED
        if failures(facts, room.id) >= _PATIENCE:
            preference = HOPELESS
        reason = f"{room.id} is not explored, {room.distance:.1f} m away"
        if who is not None:
            reason += f", though {who} is at it"
        yield Option(CallText(spec.name, (room.id,)), preference, room.distance + _CROWDING * crowd, reason)
