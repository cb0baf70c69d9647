"""JSON as language models write it, made strict.

Forgiven: single quotes, trailing commas, comments, bare keys, Python's True, False and None, line breaks in
strings, needless backslashes. Refused: NaN and infinities, a key that one object has twice (which of the two
is meant is anybody's guess), and nesting beyond `MAX_DEPTH`.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass
from typing import Any

from adhoc.core.errors import ReplyError
from adhoc.core.replies import DUPLICATE, TRUNCATED, UNREADABLE

MAX_DEPTH = 32
"""Brackets within brackets; the deepest reply that is asked for has 4."""

_TOKEN = re.compile(
    r"""
      (?P<gap>\s+|//[^\n]*|\#[^\n]*|/\*.*?\*/)
    | (?P<double>"(?:[^"\\]|\\.)*")
    | (?P<single>'(?:[^'\\]|\\.|'(?!\s*(?:[,:}\]]|$)))*'(?=\s*(?:[,:}\]]|$)))
    | (?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)
    | (?P<infinite>[-+]?(?:NaN|nan|Infinity|inf)\b)
    | (?P<word>[A-Za-z_]\w*)
    | (?P<bracket>[{}\[\]])
    | (?P<mark>[,:])
    """,
    re.VERBOSE | re.DOTALL,
)
_LITERALS = {"True": "true", "False": "false", "None": "null"}
_JSON_WORDS = frozenset(_LITERALS.values())
_NEEDLESS_BACKSLASH = re.compile(r'\\(?:(["\\/bfnrt]|u[0-9a-fA-F]{4})|(.))', re.DOTALL)
_BARE_QUOTE = re.compile(r'(\\.)|"', re.DOTALL)
_PAIRS = {"}": "{", "]": "["}
_PLAIN_NUMBER = re.compile(r"-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][-+]?\d+)?", re.ASCII)
_LONGEST_NUMBER = 20
_SHOWN = 60


class NoJSON(Exception):
    """What begins here is no JSON value, however leniently it is read; `end` is how far it was looked at."""

    def __init__(self, message: str, end: int) -> None:
        super().__init__(message)
        self.end = end


@dataclass(frozen=True)
class Found:
    """A bracketed stretch of a text, as strict JSON."""

    json: str
    end: int
    """The index after its closing bracket in the original text."""

    def value(self) -> Any:
        """Its value.

        Raises:
            NoJSON: its grammar is wrong.
            ReplyError: an object in it has a key twice (`duplicate`).
        """
        try:
            return json.loads(self.json, strict=False, object_pairs_hook=_without_duplicates)
        except json.JSONDecodeError as error:
            near = self.json[max(error.pos - _SHOWN // 2, 0) : error.pos + _SHOWN // 2]
            raise NoJSON(f"{error.msg} near {near!r}", self.end) from error


def bracketed(text: str, start: int) -> Found:
    """The bracketed stretch that begins at `start`.

    Raises:
        NoJSON: something in it is no part of any JSON.
        ReplyError: `truncated` if it does not end, `unreadable` if it is nested too deeply or holds NaN, an
            infinity, or a number that is too large.
    """
    parts: list[str] = []
    open_brackets: list[str] = []
    position = start
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            if text[position] in "\"'" or text.startswith("/*", position):
                break
            raise NoJSON(f"unexpected {text[position : position + _SHOWN]!r}", position)
        position, kind, token = match.end(), match.lastgroup, match.group()
        if kind == "bracket":
            if token in _PAIRS and open_brackets[-1] != _PAIRS[token]:
                raise NoJSON(f"{token} closes what it did not open", position)
            _bracket(token, open_brackets, parts)
            if not open_brackets:
                return Found(" ".join(parts), position)
        elif kind == "infinite":
            raise ReplyError(f"{token} is no number in JSON; every number must be finite", UNREADABLE)
        elif kind != "gap":
            parts.append(_strict(str(kind), token))
    raise ReplyError(f"the JSON object does not end: {text[start : start + 2 * _SHOWN]!r}", TRUNCATED)


def _bracket(token: str, open_brackets: list[str], parts: list[str]) -> None:
    if token in "{[":
        open_brackets.append(token)
        if len(open_brackets) > MAX_DEPTH:
            raise ReplyError(f"the JSON object is nested more than {MAX_DEPTH} deep", UNREADABLE)
    else:
        open_brackets.pop()
        if parts[-1] == ",":
            parts.pop()
    parts.append(token)


def _strict(kind: str, token: str) -> str:
    """The token as strict JSON has it."""
    if kind == "double":
        return _NEEDLESS_BACKSLASH.sub(_needed, token)
    if kind == "single":
        body = _BARE_QUOTE.sub(lambda it: it[1] or '\\"', token[1:-1])
        return '"' + _NEEDLESS_BACKSLASH.sub(_needed, body) + '"'
    if kind == "number":
        return _number(token)
    if kind == "word":
        return token if token in _JSON_WORDS else _LITERALS.get(token) or json.dumps(token)
    return token


def _needed(escape: re.Match[str]) -> str:
    return escape[0] if escape[1] else escape[2]


def _number(token: str) -> str:
    """A number in JSON's spelling; long integers as floats, since Python reads them in quadratic time."""
    number = float(token)
    if not math.isfinite(number):
        raise ReplyError(f"the number {token[:_SHOWN]} is too large", UNREADABLE)
    is_plain = _PLAIN_NUMBER.fullmatch(token) and len(token) <= _LONGEST_NUMBER
    return token if is_plain else repr(number)


def _without_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise ReplyError(f"the key {key[:_SHOWN]!r} is given twice in one object", DUPLICATE)
        found[key] = value
    return found
