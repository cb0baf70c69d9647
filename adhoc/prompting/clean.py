"""Making foreign text harmless: one line, printable, of bounded length, without reserved tokens."""

from __future__ import annotations

import json
import re
from functools import lru_cache

_MAX_NAME = 160
_READ_AT_MOST = 8
"""How many times its limit of a text is looked at: what is longer is cut before it is cleaned."""
_BRACKETS = str.maketrans("<>", "‹›")
_RESERVED = re.compile(r"\[(/?[A-Z_]{2,})\]")
_FIELD_MARKS = str.maketrans(';()[]{}"', ",_______")
_INVISIBLE = re.compile("[\u034f\u115f\u1160\u17b4\u17b5\u3164\uffa0\ufe00-\ufe0f\U000e0100-\U000e01ef]")
"""Printable according to Unicode, but without any ink: fillers, joiners and variation selectors."""


def one_line(text: str, limit: int) -> str:
    """`text` on one line, without control and formatting characters, at most `limit` characters long.

    A section heading or a role can only be imitated at the beginning of a line, and this begins none. The
    tokens by which models part the turns of a conversation (`<|im_start|>`, `</s>`, `[INST]`) are kept
    readable in other brackets: some tokenizers would take them for the real ones wherever they stand.
    """
    text = text[: _READ_AT_MOST * max(limit, 1)]
    if not text.isprintable():
        text = "".join(character if character.isprintable() else " " for character in text)
    if not text.isascii():
        text = _INVISIBLE.sub("", text)
    text = _RESERVED.sub(r"(\1)", text.translate(_BRACKETS))
    text = " ".join(text.split())
    return text if len(text) <= limit else text[: max(limit - 1, 0)] + "…"


def quoted(text: str, limit: int) -> str:
    """`text` as one line in double quotes, with the quotes inside escaped, so that its end is certain."""
    return json.dumps(one_line(text, limit), ensure_ascii=False)


@lru_cache(maxsize=8192)
def name(text: str) -> str:
    """An id or a category as it may stand in a line of facts: it holds nothing that parts their fields.

    Never empty. Ids of letters, digits, `_`, `|`, `.` and the like stay as they are.
    """
    text = one_line(text, _MAX_NAME).translate(_FIELD_MARKS).replace(": ", " ").rstrip(":")
    return text or "_"
