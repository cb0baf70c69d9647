"""Finding the JSON object in what a language model wrote."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from adhoc.core.errors import ReplyError
from adhoc.core.replies import EMPTY, UNREADABLE
from adhoc.prompting.lenient_json import NoJSON, bracketed

MAX_CHARACTERS = 64_000
"""The longest reply that is read: some thirteen times what a reply of 1,024 tokens has."""
_FENCE = re.compile(r"```(.*?)```", re.DOTALL)
_OBJECT_BEGINS = re.compile(r"""\{\s*(?:["'}]|[A-Za-z_]\w*\s*:|//|/\*|\#|$)""")
"""A brace with a key after it, and not just a brace in prose."""
_MAX_OBJECTS = 64
"""Objects that a reply may have: the last one counts, but one that has this many is no answer."""
_SHOWN = 120


def read_object(text: str) -> dict[str, Any]:
    """The JSON object in `text`: bare, in a code fence, or with prose around it.

    What `prompting.lenient_json` forgives is forgiven. Where there are several objects, the last outermost
    one counts: models correct themselves at the end.

    Raises:
        ReplyError: `empty` without any text, `truncated` if the last object does not end, `duplicate` if an
            object in it has a key twice, `unreadable` if there is no object, or one that is nested too deeply
            or holds numbers that are none, or if the reply is too long or has too many objects.
    """
    if not text.strip():
        raise ReplyError("the reply is empty; expected one JSON object", EMPTY)
    if len(text) > MAX_CHARACTERS:
        raise ReplyError(
            f"the reply has {len(text)} characters; one of more than {MAX_CHARACTERS} is not read", UNREADABLE
        )
    problem = ""
    for part in _parts(text):
        found: dict[str, Any] | None = None
        for value in _objects(part):
            if isinstance(value, dict):
                found = value
            else:
                problem = value
        if found is not None:
            return found
    raise ReplyError(f"the reply holds no JSON object: {problem or repr(text.strip()[:_SHOWN])}", UNREADABLE)


def _parts(text: str) -> Iterator[str]:
    """Where to look, one place after the other; fences count only around an object, not within one."""
    if not text.lstrip().startswith("{"):
        yield from reversed(_FENCE.findall(text))
    yield text


def _objects(text: str) -> Iterator[dict[str, Any] | str]:
    """The outermost objects of a text in order; for what only looks like one, what is wrong with it."""
    position = 0
    for _ in range(_MAX_OBJECTS):
        match = _OBJECT_BEGINS.search(text, position)
        if match is None:
            return
        try:
            found = bracketed(text, match.start())
            position = found.end
            yield found.value()
        except NoJSON as error:
            position = max(error.end, match.start() + 1)
            yield str(error)
    raise ReplyError(f"the reply has {_MAX_OBJECTS} objects or more; expected one", UNREADABLE)
