"""Reading a rendered prompt back into facts.

The reader is tolerant: a section, a line or a field that it does not find or understand is simply not
known. It knows the headings and the field names of the shipped templates, and no task.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from functools import lru_cache

from adhoc.llm.offline.facts import (
    CallText,
    EventFact,
    Facts,
    ObjectFact,
    Position,
    ReceptacleFact,
    ReplyFact,
    RoomFact,
    SpecFact,
    TeammateFact,
)

Sections = dict[str, list[str]]

_SPEC = re.compile(r"- (\S+)((?: <[^>]*>)*)( \(needs manipulation\))?( \(the whole of [^)]*\))?:")
_POINT = re.compile(r"\((-?\d+(?:\.\d+)?), (-?\d+(?:\.\d+)?)")
_ROOM_LINE = re.compile(r"- (.+?) \(([^)]*)\): (.*)")
_RECEPTACLE = re.compile(r"(\S+) \[([^,\]]+), ([\d.]+) m\]")
_EVENT = re.compile(r"- step (-?\d+): (.*)")
_CANDIDATE = re.compile(r"- \d+: (.*)")
_OBJECTION = re.compile(r"- \S+ to ([^:]*):")
_ARGUMENT = re.compile(r"(\w+) \(([^)]*)\) = ([^;]+)")
_BECAUSE = " (because: "
_NOTHING = frozenset({"unknown", "none", "nothing", ""})


def read_prompt(texts: Sequence[str]) -> Facts:
    """The facts in the messages of a prompt, in order."""
    head: Sections = {}
    vocabulary = _vocabulary(texts[0]) if texts else ((), ())
    for text in texts:
        _split(text, head)
    state = _fields(head.get("your state", ()))
    ability = _fields(head.get("your capability", ()))
    abilities = {_id(line): line for line in _entries(head.get("capability of the teammates", ()))}
    current = head.get("current sub-task", [])
    course = _fields(current)
    return Facts(
        output_format="\n".join(head.get("output format", ())),
        instruction="\n".join(head.get("what to do now", ())),
        sub_tasks=vocabulary[0],
        sub_skills=vocabulary[1],
        step=int(_number("".join(head.get("step", ())), 0)),
        room=_known(state.get("room")),
        position=_point(state.get("position", "")),
        holding=_known(state.get("holding")),
        done=tuple(
            _call(it)
            for it in state.get("sub-skills done since it began", "").split(", ")
            if it not in _NOTHING
        ),
        last=state.get("last result", ""),
        manipulation=ability.get("manipulation") == "yes",
        payload=_number(ability.get("payload", ""), float("inf")),
        rooms=tuple(_room(line) for line in _entries(head.get("rooms", ()))),
        objects=tuple(
            _object(line)
            for title in ("objects in view now", "objects detected before")
            for line in _entries(head.get(title, ()))
        ),
        receptacles=_receptacles(head.get("receptacles by room", ())),
        teammates=tuple(
            _teammate(line, abilities.get(_id(line), ""))
            for line in _entries(head.get("teammates", ()))
            if "; has stopped;" not in line
        ),
        history=tuple(
            EventFact(int(match[1]), match[2])
            for match in map(_EVENT.match, head.get("your memory", ()))
            if match
        ),
        candidates=tuple(
            _call(match[1]) for match in map(_CANDIDATE.match, head.get("generated sub-tasks", ())) if match
        ),
        chosen=next(
            (_call(line[2:]) for line in head.get("chosen sub-task", ()) if line.startswith("- ")), None
        ),
        replies=tuple(it for it in map(_reply, head.get("replies to your intention", ())) if it),
        predictions=_plans(head.get("predicted plans of the teammates", ())),
        plans=_plans(head.get("plans of the team", ())),
        objected=frozenset(
            _call(match[1])
            for match in map(_OBJECTION.match, head.get("objections to your plan", ()))
            if match
        ),
        current=_call(course["sub-task"]) if "sub-task" in course else None,
        current_steps=_steps(course.get("usual course", "")),
        current_arguments=_arguments(current),
        asked_category=next(iter(_names(head.get("object type", ()))), None),
        receptacle_types=_names(head.get("receptacle types", ())),
        room_types=_names(head.get("room types", ())),
    )


@lru_cache(maxsize=256)
def _vocabulary(text: str) -> tuple[tuple[SpecFact, ...], tuple[SpecFact, ...]]:
    """Sub-tasks and sub-skills of a system message; the same at every step, hence read once."""
    sections: Sections = {}
    _split(text, sections)
    sub_tasks = sections.get("candidate sub-tasks") or sections.get("what the work consists of") or []
    return _specs(sub_tasks), _specs(sections.get("candidate sub-skills", []))


def _split(text: str, sections: Sections) -> None:
    """Add the non-empty lines of a message to its sections, by lower-case heading."""
    lines: list[str] = []
    for line in text.split("\n"):
        if line.startswith("## "):
            title = line[3:].lower()
            if title.startswith("your state at step "):
                sections["step"] = [title.rsplit(" ", 1)[1]]
                title = "your state"
            lines = sections.setdefault(title, [])
        elif line:
            lines.append(line)


def _specs(lines: Sequence[str]) -> tuple[SpecFact, ...]:
    specs: list[SpecFact] = []
    for line in lines:
        match = _SPEC.match(line)
        if match:
            specs.append(SpecFact(match[1], {}, bool(match[3]), (), bool(match[4])))
        elif specs and line.startswith("  arguments: "):
            pairs = (it.partition(": ") for it in line[len("  arguments: ") :].split("; "))
            specs[-1] = specs[-1]._replace(parameters={name: kind for name, _, kind in pairs})
        elif specs and line.startswith("  usual course: "):
            specs[-1] = specs[-1]._replace(steps=_steps(line[len("  usual course: ") :]))
    return tuple(specs)


def _steps(text: str) -> tuple[str, ...]:
    return tuple(filter(None, text.split("; ")))


def _fields(lines: Sequence[str]) -> dict[str, str]:
    """The `name: value` fields of a list of lines, several on a line parted by `; `."""
    fields: dict[str, str] = {}
    for line in lines:
        parts = (
            [line]
            if line.startswith(("- usual course", "- arguments", "- last result"))
            else line.split("; ")
        )
        for part in parts:
            name, _, value = part.removeprefix("- ").partition(": ")
            fields.setdefault(name, value)
    return fields


def _entries(lines: Sequence[str]) -> list[str]:
    """The lines that describe one thing each: `- id; field: value; ...`."""
    return [line for line in lines if line.startswith("- ") and "; " in line]


def _names(lines: Sequence[str]) -> tuple[str, ...]:
    """The lines that are one name each: `- name`."""
    return tuple(line[2:] for line in lines if line.startswith("- "))


def _id(line: str) -> str:
    return line[2 : line.index("; ")]


def _room(line: str) -> RoomFact:
    fields = _fields((line,))
    explored = fields.get("explored", "no") != "no"
    return RoomFact(
        _id(line), _known(fields.get("type")), explored, _number(fields.get("distance", ""), 99.0)
    )


def _object(line: str) -> ObjectFact:
    fields = _fields((line,))
    return ObjectFact(
        _id(line),
        fields.get("type", ""),
        {"yes": True, "no": False}.get(fields.get("needs attention", "")),
        _known(fields.get("room")),
        _known(fields.get("at", "").partition(" (")[0]),
        _point(fields.get("position", "")),
        _number(fields.get("distance", ""), 99.0),
        _number(fields.get("mass", ""), 0.0),
    )


def _receptacles(lines: Sequence[str]) -> dict[str, tuple[ReceptacleFact, ...]]:
    found: dict[str, list[ReceptacleFact]] = {}
    for match in filter(None, map(_ROOM_LINE.match, lines)):
        room_type = _known(match[2])
        for name, category, distance in _RECEPTACLE.findall(match[3]):
            fact = ReceptacleFact(name, category, match[1], room_type, _number(distance, 99.0))
            found.setdefault(category, []).append(fact)
    return {
        category: tuple(sorted(its, key=lambda it: (it.distance, it.id))) for category, its in found.items()
    }


def _teammate(line: str, ability: str) -> TeammateFact:
    fields = _fields((line, ability))
    sub_task, sub_skill = _known(fields.get("sub-task")), _known(fields.get("sub-skill"))
    return TeammateFact(
        _id(line),
        fields.get("manipulation") == "yes",
        _number(fields.get("payload", ""), 0.0),
        _point(fields.get("position", "")),
        _known(fields.get("room")),
        _known(fields.get("holding")),
        _call(sub_task) if sub_task else None,
        _call(sub_skill) if sub_skill else None,
    )


def _reply(line: str) -> ReplyFact | None:
    sender, parted, quoted = line.removeprefix("- ").partition(": ")
    if not parted:
        return None
    try:
        return ReplyFact(sender, str(json.loads(quoted)))
    except json.JSONDecodeError:
        return ReplyFact(sender, quoted)


def _plans(lines: Sequence[str]) -> dict[str, CallText]:
    fields = {_id(line): _fields((line,)).get("sub-task") for line in _entries(lines)}
    return {teammate: _call(text) for teammate, text in fields.items() if text and text not in _NOTHING}


def _arguments(lines: Sequence[str]) -> dict[str, tuple[str, str]]:
    line = next((it for it in lines if it.startswith("- arguments: ")), "")
    return {name: (kind, value.strip()) for name, kind, value in _ARGUMENT.findall(line)}


def _call(text: str) -> CallText:
    words = text.partition(_BECAUSE)[0].split()
    return CallText(words[0] if words else "", tuple(words[1:]))


def _known(value: str | None) -> str | None:
    return None if value is None or value in _NOTHING else value


def _number(text: str, otherwise: float) -> float:
    try:
        value = float(text.split(" ", 1)[0])
    except ValueError:
        return otherwise
    return value if math.isfinite(value) else otherwise


def _point(text: str) -> Position | None:
    match = _POINT.search(text)
    return None if match is None else (float(match[1]), float(match[2]))
