"""What of a provider's answer may be stored: JSON values without headers, and without anybody's key."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping
from typing import Any

REMOVED = "[removed]"
MOST_DEPTH = 40
_MOST_BITS = 4096
_PRIVATE = ("headers", "authorization", "api_key", "cookie", "hidden_params")
"""Fields whose names end so are left out."""
_KEYS = [
    re.compile(pattern)
    for pattern in (
        *(rf"{prefix}-[\w*-]{{12,}}" for prefix in ("sk", "pk", "rk", "xai")),
        *(rf"{prefix}_\w{{20,}}" for prefix in ("gsk", "hf", "ghp")),
        r"AIza[\w-]{30,}",
        r"AKIA[0-9A-Z]{16}",
        r"Bearer\s+[\w.~+/*=-]{8,}",
    )
]
"""Keys as the known providers form them. One pattern for each, and each begins with a literal: that is 100
times faster on a long prompt than one pattern with all of them."""
_SHORTEST = 8


def storable(value: Any, depth: int = 0) -> Any:
    """A copy of a value as JSON values: fields that hold headers or keys are left out, keys in texts are
    removed, and what JSON cannot say is a text."""
    if isinstance(value, str):
        return without_keys(value)
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, int):
        return int(value) if value.bit_length() <= _MOST_BITS else f"a number of {value.bit_length()} bits"
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else str(value)
    if depth >= MOST_DEPTH or not isinstance(value, (Mapping, list, tuple)):
        return f"<{type(value).__name__}>"
    if isinstance(value, Mapping):
        return {
            without_keys(str(name)): storable(entry, depth + 1)
            for name, entry in value.items()
            if not str(name).lower().replace("-", "_").endswith(_PRIVATE)
        }
    return [storable(entry, depth + 1) for entry in value]


def without_keys(text: str) -> str:
    """A text without what looks like a provider's key, and without the keys of this process: the values of
    environment variables whose names end with `_API_KEY`. A value without a digit, or of fewer than 8
    characters, is a placeholder such as `not-needed` and stays."""
    for name, value in os.environ.items():
        if name.upper().endswith("_API_KEY") and _is_key(value):
            text = text.replace(value, REMOVED)
    for pattern in _KEYS:
        text = pattern.sub(_removed, text)
    return text


def _removed(match: re.Match[str]) -> str:
    """A key begins where a word begins: `desk-...` holds none."""
    before = match.string[match.start() - 1 : match.start()]
    return match[0] if before.isalnum() else REMOVED


def _is_key(value: str) -> bool:
    return len(value) >= _SHORTEST and any(character.isdigit() for character in value)
