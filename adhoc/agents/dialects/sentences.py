"""Plain English: `My sub-task is Explore room|2. I hold nothing. My room is room|1.`"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Any, NamedTuple

from adhoc.agents.dialects.atoms import MAX_TEXT, NUMBER, WORD, fill, read_atoms, write_atom
from adhoc.agents.dialects.dialect import Dialect
from adhoc.agents.dialects.meaning import Fact, Value, facts_of, payload_of
from adhoc.core.messages import Message, MessageKind

MAX_EVENT = 500
"""Characters of what a robot says in its own words."""
MAX_SENTENCES = 200
"""Of a message that are looked at; it has no more objects and facts to tell of."""
_SLOTS = {
    "<number>": f"({NUMBER})",
    "<name>": f"({WORD})",
    "<call>": f"({WORD}(?: (?:{NUMBER}|{WORD}))*)",
    "<names>": f"({WORD}(?:, {WORD})*)",
}
_BETWEEN = {"<call>": " ", "<names>": ", "}


class Form(NamedTuple):
    """How a fact is said. `values` are those that the sentence stands for; None where they fill its slots."""

    fact: str
    sentence: str
    values: tuple[Value, ...] | None = None


FORMS = (
    Form("stopped", "I have stopped.", (True,)),
    Form("stopped", "I am at work.", (False,)),
    Form("intention", "I have no intention.", ()),
    Form("intention", "I intend to do <call>."),
    Form("sub_task", "I have no sub-task.", ()),
    Form("sub_task", "My sub-task is <call>."),
    Form("sub_skill", "I have no sub-skill.", ()),
    Form("sub_skill", "My sub-skill is <call>."),
    Form("holding", "I hold nothing.", (None,)),
    Form("holding", "I hold <name>."),
    Form("room", "I do not know my room.", (None,)),
    Form("room", "My room is <name>."),
    Form("position", "My position is (<number>, <number>)."),
    Form("explored_rooms", "Explored rooms: <names>."),
    Form("steps_left", "I have <number> steps of battery left."),
    Form("can_navigate", "I can move.", (True,)),
    Form("can_navigate", "I cannot move.", (False,)),
    Form("can_manipulate", "I can manipulate objects.", (True,)),
    Form("can_manipulate", "I cannot manipulate objects.", (False,)),
    Form("camera_height", "My camera is <number> m high."),
    Form("payload", "My payload is <number> kg."),
    Form("max_steps", "My full battery lasts <number> steps."),
)
"""Every sentence but those about objects."""

_SLOT = re.compile("(<[a-z]+>)")
_SAW = re.compile(
    rf"I saw (?P<id>{WORD})"
    rf" \((?P<state>misplaced |well placed )?(?P<category>{WORD})(?P<holds>, a receptacle)?\)"
    rf" at \((?P<x>{NUMBER}), (?P<y>{NUMBER}), (?P<z>{NUMBER})\) in (?:an unknown room|(?P<room>{WORD}))"
    rf" on (?:an unknown place|(?P<receptacle>{WORD}))(?: \((?P<receptacle_category>{WORD})\))?"
    rf"(?:, weighing (?P<mass>{NUMBER}) kg)?\."
)
_STATES = {"misplaced ": True, "well placed ": False, "": None}
_PIECE = re.compile(r'"(?:[^"\\]|\\.)*"|\\.|(?P<end>[.!?](?= |$))|[^".!?\\]+|.', re.DOTALL)
"""Of a text: something in quotes, the end of a sentence, anything else. An open quote begins nothing, and
since what a backslash stands before is one piece within and without quotes, only one can be open."""


class Sentences(Dialect):
    """All in the text, nothing in the payload: one sentence a fact, in fixed words.

    What a robot says in its own words when its task state changes is said first, in quotes. Sentences of
    other words are passed over, so that a person or a model that uses some of these is understood as far.
    """

    name = "sentences"
    plain = True

    def write(self, message: Message) -> Message | None:
        """See `Dialect`."""
        facts = facts_of(message)
        if not facts:
            return message
        opening = f"{_opening(message)} ".lstrip()
        return Message(message.kind, opening + sentences_of(facts), {}, message.recipient)

    def read(self, message: Message) -> Mapping[str, Any] | None:
        """See `Adapter`."""
        sentences = islice(_split(message.text[:MAX_TEXT]), MAX_SENTENCES)
        facts = [fact for fact in map(_read, sentences) if fact is not None]
        return payload_of(facts) if facts else None


def sentences_of(facts: list[Fact]) -> str:
    """The facts in plain English, as many as fit into a message."""
    return fill(_object(fact) if fact.name == "object" else _sentence(fact) for fact in facts)


def _opening(message: Message) -> str:
    if message.kind is MessageKind.JOIN:
        return "I join the team."
    if message.kind is not MessageKind.TASK_STATE or not message.text:
        return ""
    words = message.text[:MAX_EVENT].rstrip(".").replace("\\", "/").replace('"', "'")
    return f'I say: "{words}".'


def _sentence(fact: Fact) -> str:
    form = next(it for it in FORMS if it.fact == fact.name and it.values in (None, fact.values))
    values = iter(fact.values)
    return _SLOT.sub(lambda slot: _BETWEEN.get(slot[0], "").join(_taken(slot[0], values)), form.sentence)


def _taken(slot: str, values: Iterator[Value]) -> Iterator[str]:
    """As many of the values as the slot takes: all, or the next one."""
    return map(write_atom, values if slot in _BETWEEN else [next(values)])


def _object(fact: Fact) -> str:
    name, category, x, y, z, room, receptacle, receptacle_category, misplaced, holds, mass = fact.values
    state = next(words for words, meant in _STATES.items() if meant is misplaced)
    where = f"({', '.join(map(write_atom, (x, y, z)))})"
    inside = write_atom(room) if room is not None else "an unknown room"
    place = write_atom(receptacle) if receptacle is not None else "an unknown place"
    kind = f" ({write_atom(receptacle_category)})" if receptacle_category is not None else ""
    what = f"{state}{write_atom(category)}{', a receptacle' if holds else ''}"
    weight = f", weighing {write_atom(mass)} kg" if mass else ""
    return f"I saw {write_atom(name)} ({what}) at {where} in {inside} on {place}{kind}{weight}."


def _split(text: str) -> Iterator[str]:
    """The sentences of a text; what is in quotes ends none."""
    pieces: list[str] = []
    for found in _PIECE.finditer(text):
        pieces.append(found[0])
        if found["end"]:
            yield "".join(pieces).strip()
            pieces = []


def _pattern(form: Form) -> re.Pattern[str]:
    parts = _SLOT.split(form.sentence)
    return re.compile("".join(_SLOTS.get(part) or re.escape(part) for part in parts))


_PATTERNS = tuple((_pattern(form), form) for form in FORMS)


def _read(sentence: str) -> Fact | None:
    saw = _SAW.fullmatch(sentence)
    if saw is not None:
        return _seen(saw)
    for pattern, form in _PATTERNS:
        found = pattern.fullmatch(sentence)
        if found is not None:
            said = tuple(value for group in found.groups() for value in read_atoms(group))
            return Fact(form.fact, said if form.values is None else form.values)
    return None


def _seen(saw: re.Match[str]) -> Fact:
    def value(group: str) -> Value:
        return None if saw[group] is None else read_atoms(saw[group])[0]

    misplaced, mass = _STATES[saw["state"] or ""], value("mass") or 0.0
    names = ("id", "category", "x", "y", "z", "room", "receptacle", "receptacle_category")
    return Fact("object", (*map(value, names), misplaced, saw["holds"] is not None, mass))
