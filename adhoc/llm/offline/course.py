"""The next sub-skill: following the usual course of a sub-task as the prompt prints it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from adhoc.llm.offline.facts import CallText, Facts, SpecFact
from adhoc.llm.offline.knowledge import last_attempt_failed, usable_receptacles

_NAME = re.compile(r"\{(\w+)\}")


def next_skill(
    facts: Facts, sub_task: CallText, steps: Sequence[str], arguments: Mapping[str, tuple[str, str]]
) -> CallText:
    """The first step that is not done, with the names in braces bound; else the last step once more.

    `arguments` maps each parameter of the sub-task to its kind and value. Another name in braces stands for
    the nearest usable receptacle of the wanted type, or, where a sub-skill takes a room, for its room. While
    none is known, a room of the wanted type that is not explored comes next, else searching.

    A robot that holds the sub-task's object is past the steps that are about nothing but that object. After
    a step that failed just now it looks around once before it tries again.
    """
    values = {name: value for name, (_, value) in arguments.items()}
    values.update(_bindings(facts, steps, arguments))
    step = _next_step(facts, steps, values)
    if step is None:
        return searching_skill(facts) or CallText("unknown")
    if not set(_NAME.findall(step)) <= values.keys():
        return _search(facts, dict(arguments.values()))
    call = _fill(step, values)
    if _failed_just_now(facts, call):
        return searching_skill(facts) or call
    return call


def searching_skill(facts: Facts) -> CallText | None:
    """The parameterless sub-skill that is not the whole of a sub-task: stopping is, looking around is not."""
    return next(
        (CallText(it.name) for it in facts.sub_skills if not it.parameters and not it.ends_work), None
    )


def _next_step(facts: Facts, steps: Sequence[str], values: Mapping[str, str]) -> str | None:
    done = set(facts.done)
    for step in steps:
        names = _NAME.findall(step)
        bound = [values.get(name) for name in names]
        in_hand = facts.holding is not None and bool(names) and all(it == facts.holding for it in bound)
        if in_hand or (None not in bound and _fill(step, values) in done):
            continue
        return step
    return steps[-1] if steps else None


def _fill(step: str, values: Mapping[str, str]) -> CallText:
    name, *args = step.split()
    return CallText(name, tuple(_NAME.sub(lambda match: values[match[1]], it) for it in args))


def _bindings(facts: Facts, steps: Sequence[str], arguments: Mapping[str, tuple[str, str]]) -> dict[str, str]:
    """Values for the names that are no parameters, as far as a receptacle is known."""
    by_kind = dict(arguments.values())
    free = {name for step in steps for name in _NAME.findall(step)} - arguments.keys()
    if not free:
        return {}
    target = next(
        usable_receptacles(
            facts,
            by_kind.get("object id", ""),
            by_kind.get("receptacle type", ""),
            by_kind.get("room type"),
        ),
        None,
    )
    if target is None:
        return {}
    rooms = _names_of_rooms(steps, facts.sub_skills)
    return {name: target.room if name in rooms else target.id for name in free}


def _names_of_rooms(steps: Sequence[str], sub_skills: Sequence[SpecFact]) -> set[str]:
    """The names in braces that stand where a sub-skill takes a room."""
    specs = {spec.name: tuple(spec.parameters.values()) for spec in sub_skills}
    names: set[str] = set()
    for step in steps:
        name, *args = step.split()
        for kind, arg in zip(specs.get(name, ()), args):
            if kind == "room id":
                names.update(_NAME.findall(arg))
    return names


def _search(facts: Facts, wanted: Mapping[str, str]) -> CallText:
    """Look for what is missing: go to a room of the wanted or an unknown type; once there, look around."""
    look = searching_skill(facts) or CallText("unknown")
    going = next((it for it in facts.sub_skills if tuple(it.parameters.values()) == ("room id",)), None)
    unexplored = [it for it in facts.rooms if not it.explored]
    fitting = [it for it in unexplored if it.room_type == wanted.get("room type")]
    open_ = [it for it in unexplored if it.room_type is None]
    rooms = sorted(fitting, key=lambda it: it.distance) or sorted(open_, key=lambda it: it.distance)
    if going is None or not rooms or rooms[0].id == facts.room:
        return look
    go = CallText(going.name, (rooms[0].id,))
    return look if go in facts.done or _failed_just_now(facts, go) else go


def _failed_just_now(facts: Facts, call: CallText) -> bool:
    """Whether the last thing that happened is the failure of this very call."""
    latest = facts.last or (facts.history[-1].text if facts.history else "")
    only = facts._replace(history=(), last=latest)
    return last_attempt_failed(only, str(call))
