"""Making foreign text harmless: one line, printable, of bounded length."""

from __future__ import annotations

import json
from functools import lru_cache

_MAX_NAME = 160


def one_line(text: str, limit: int) -> str:
    """`text` on one line, without control and formatting characters, at most `limit` characters long.

    A section heading or a role can only be imitated at the beginning of a line, and this begins none.
    """
    if not text.isprintable():
        text = "".join(character if character.isprintable() else " " for character in text)
    text = " ".join(text.split())
    return text if len(text) <= limit else text[: max(limit - 1, 0)] + "…"


def quoted(text: str, limit: int) -> str:
    """`text` as one line in double quotes, with the quotes inside escaped, so that its end is certain."""
    return json.dumps(one_line(text, limit), ensure_ascii=False)


@lru_cache(maxsize=8192)
def name(text: str) -> str:
    """An id or a category as it may stand in a line of facts, whose fields are parted by `; `."""
    return one_line(text, _MAX_NAME).replace(";", ",")
