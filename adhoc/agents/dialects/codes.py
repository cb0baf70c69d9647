"""A terse machine format: `T:Explore,room|2 H:? R:room|1 P:1.0,2.5 B:99`."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from adhoc.agents.dialects.atoms import MAX_TEXT, NUMBER, WORD, fill, read_atoms, write_atom
from adhoc.agents.dialects.dialect import Dialect
from adhoc.agents.dialects.meaning import Fact, Value, facts_of, payload_of
from adhoc.core.messages import Message

TAGS = {
    "stopped": "X",
    "intention": "I",
    "sub_task": "T",
    "sub_skill": "S",
    "holding": "H",
    "room": "R",
    "position": "P",
    "explored_rooms": "E",
    "object": "O",
    "steps_left": "B",
    "can_navigate": "N",
    "can_manipulate": "M",
    "camera_height": "K",
    "payload": "L",
    "max_steps": "F",
}
"""The letter of each fact (see `dialects.meaning`)."""
MAX_CODES = 200
"""Of a message that are read; it has no more objects and facts to tell of."""
_FACTS = {tag: name for name, tag in TAGS.items()}
_CALLS = frozenset("ITS")
_MARKS: Mapping[str, Value] = {"?": None, "+": True, "-": False}
"""Unknown or none, yes, no."""
_VALUE = f"(?:{NUMBER}|[?+-]|{WORD})"
_CODE = re.compile(rf"([A-Z]):({_VALUE}(?:,{_VALUE})*)(?: |$)")
_SEPARATE = re.compile(_VALUE)


class Codes(Dialect):
    """All in the text, nothing in the payload: codes parted by spaces, each a letter and its values.

    Codes of other letters are passed over. A message is in this format if it consists of codes; one that the
    radio cut at its end is read up to there.
    """

    name = "codes"

    def write(self, message: Message) -> Message | None:
        """See `Dialect`."""
        facts = facts_of(message)
        if not facts:
            return message
        return Message(message.kind, fill(map(_write, facts)), {}, message.recipient)

    def read(self, message: Message) -> Mapping[str, Any] | None:
        """See `Adapter`."""
        text, place = message.text[:MAX_TEXT], 0
        facts: list[Fact] = []
        while place < len(text) and len(facts) < MAX_CODES:
            code = _CODE.match(text, place)
            if code is None:
                break
            place = code.end()
            if code[1] in _FACTS:
                facts.append(Fact(_FACTS[code[1]], _values(code[1], code[2])))
        whole = place == len(text) or len(facts) == MAX_CODES or text.endswith("…")
        return payload_of(facts) if facts and whole else None


def _write(fact: Fact) -> str:
    tag = TAGS[fact.name]
    values = fact.values or (None,)
    return f"{tag}:{','.join(map(_value, values))}"


def _value(value: Value) -> str:
    return next((mark for mark, meant in _MARKS.items() if meant is value), None) or write_atom(value)


def _values(tag: str, text: str) -> tuple[Value, ...]:
    if tag in _CALLS and text == "?":
        return ()
    return tuple(
        _MARKS[it] if it in _MARKS else read_atoms(it)[0] for it in map(_text, _SEPARATE.finditer(text))
    )


def _text(found: re.Match[str]) -> str:
    return found[0]
