"""Finding the JSON object in what a language model wrote."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

from adhoc.core.errors import ReplyError

_FENCE = re.compile(r"```(?:json|JSON)?\s*\n?(.*?)```", re.DOTALL)
_OBJECT_BEGINS = re.compile(r'\{\s*(?:"|$)')
_TRAILING_COMMA = re.compile(r",(\s*[}\]])")
_LITERALS = (("True", "true"), ("False", "false"), ("None", "null"))
_MAX_STARTS = 64
"""Opening braces that are tried, so that a hostile text cannot take quadratic time for long."""
_SHOWN = 120


def read_object(text: str) -> dict[str, Any]:
    """The JSON object in `text`: bare, in a code fence, or with prose around it.

    Trailing commas and Python's True, False and None are forgiven. Where there are several objects, the
    last complete outermost one counts: models correct themselves at the end.

    Raises:
        ReplyError: `empty` without any text, `truncated` if an object begins and does not end,
            `unreadable` if there is no object.
    """
    if not text.strip():
        raise ReplyError("the reply is empty; expected one JSON object", "empty")
    for part in (*reversed(_FENCE.findall(text)), text):
        found = list(_objects(part))
        if found:
            return found[-1]
    shown = text.strip()[:_SHOWN]
    if any(_is_cut_off(text, match.start()) for match in _OBJECT_BEGINS.finditer(text)):
        raise ReplyError(f"the reply's JSON object does not end: {shown!r}", "truncated")
    raise ReplyError(f"the reply holds no JSON object: {shown!r}", "unreadable")


def _objects(text: str) -> Iterator[dict[str, Any]]:
    """The outermost objects of a text, in order."""
    decoder = json.JSONDecoder()
    position = text.find("{")
    for _ in range(_MAX_STARTS):
        if position < 0:
            return
        value, end = _decode(decoder, text, position)
        if isinstance(value, dict):
            yield value
        elif _is_cut_off(text, position):
            return
        position = text.find("{", max(end, position + 1))


def _decode(decoder: json.JSONDecoder, text: str, position: int) -> tuple[Any, int]:
    """The value at `position` and where it ends; (None, position) if there is none."""
    try:
        return decoder.raw_decode(text, position)
    except (json.JSONDecodeError, RecursionError):
        pass
    end = _matching_brace(text, position)
    if end is None:
        return None, position
    repaired = _TRAILING_COMMA.sub(r"\1", text[position:end])
    for python, plain in _LITERALS:
        repaired = re.sub(rf"(?<=[:\[,])(\s*){python}\b", rf"\1{plain}", repaired)
    try:
        return json.loads(repaired, strict=False), end
    except (json.JSONDecodeError, RecursionError):
        return None, position


def _matching_brace(text: str, position: int) -> int | None:
    """The index after the brace that closes the one at `position`, outside of strings; None if none does."""
    depth, in_string, escaped = 0, False, False
    for index in range(position, len(text)):
        character = text[index]
        if in_string:
            in_string = escaped or character != '"'
            escaped = character == "\\" and not escaped
        elif character == '"':
            in_string = True
        elif character in "{}":
            depth += 1 if character == "{" else -1
            if depth == 0:
                return index + 1
    return None


def _is_cut_off(text: str, start: int) -> bool:
    """Whether a JSON object, and not just a brace in prose, begins at `start` and does not end."""
    begins = _OBJECT_BEGINS.match(text, start) is not None
    return begins and _matching_brace(text, start) is None
