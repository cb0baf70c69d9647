"""Names and numbers in a text, each with a certain end, read in time that is linear in the text."""

from __future__ import annotations

import re
from collections.abc import Iterable

from adhoc.agents.dialects.meaning import Value

MAX_TEXT = 8000
"""Characters of a message that are read; the radio lets through no more."""
MAX_WRITTEN = 7400
"""Characters that a dialect writes: what does not fit is left out, where the radio would cut anywhere."""

NUMBER = r"-?[0-9]{1,16}(?:\.[0-9]{1,25})?(?:e[+-]?[0-9]{1,3})?"
WORD = r'(?:[A-Za-z_][A-Za-z0-9_|-]*|"(?:[^"\\]|\\.)*")'
"""A plain name as it is; any other in double quotes, in which a backslash goes before `"` and itself."""
RESERVED = frozenset({"nothing"})
"""Plain names that are quoted nevertheless: sentences use them for something else."""
_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_|-]*")
_ESCAPED = re.compile(r"\\(.)")
_ATOM = re.compile(f"({NUMBER})|({WORD})")


def write_atom(value: Value) -> str:
    """A name or a number. Raises TypeError for anything else."""
    if isinstance(value, str):
        return _word(value)
    if isinstance(value, bool) or value is None:
        raise TypeError(f"{value!r} is no name and no number")
    return repr(float(value) if isinstance(value, float) else int(value))


def read_atoms(text: str) -> list[Value]:
    """The names and numbers in a text, in order, whatever is between them."""
    return [_number(found[1]) if found[1] else _name(found[2]) for found in _ATOM.finditer(text)]


def fill(phrases: Iterable[str], limit: int = MAX_WRITTEN) -> str:
    """As many phrases as fit, joined by spaces; one that is too long is left out."""
    chosen, left = [], limit
    for phrase in phrases:
        if len(phrase) < left:
            chosen.append(phrase)
            left -= len(phrase) + 1
    return " ".join(chosen)


def _word(name: str) -> str:
    if _PLAIN.fullmatch(name) and name not in RESERVED:
        return name
    return '"{}"'.format(name.replace("\\", "\\\\").replace('"', '\\"'))


def _name(word: str) -> str:
    return _ESCAPED.sub(r"\1", word[1:-1]) if word.startswith('"') else word


def _number(text: str) -> float:
    return float(text) if "." in text or "e" in text else int(text)
