"""What of a configuration or a command line may be published: no keys, and no home folder."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any

from adhoc.llm.ledger.storable import REMOVED, without_keys

HOME = "~"
_SECRET_NAME = re.compile(
    r"(^|[._-])(api_?key|access_?key|private_?key|key|token|secret|password|passwd|credentials?|authorization"
    r"|auth|cookie|bearer)$",
    re.IGNORECASE,
)
"""Names of fields and environment variables whose values are secrets: `api_key`, `HF_TOKEN`, but not
`max_tokens`."""
_IN_ADDRESS = re.compile(r"(?<=://)[^/\s@]+@")
"""User and password in an address, as in `https://me:secret@host/v1`."""
_IN_QUERY = re.compile(r"([?&][\w.-]*(?:key|token|secret|password|sig(?:nature)?)=)[^&\s\"']+", re.IGNORECASE)
_ASSIGNMENT = re.compile(r"^(?P<name>[+~]*[\w./@-]+|--[\w-]+)=(?P<value>.*)$", re.DOTALL)
_PLACEHOLDER = re.compile(r".{0,7}|[a-z_-]*")
"""Values of environment variables that are ordinary words, such as `not-needed`."""


def publishable(value: Any, name: str = "") -> Any:
    """A copy of plain values (as JSON has them) that may be published.

    What stands in fields with secret names, what looks like a provider's key, the values of secret
    environment variables, and passwords in addresses are replaced by `[removed]`; the home folder is `~`.
    Fields stay, so that a configuration can still be read as one.
    """
    if value is not None and not isinstance(value, bool) and _SECRET_NAME.search(name):
        return REMOVED
    if isinstance(value, str):
        return publishable_text(value)
    if isinstance(value, Mapping):
        return {str(key): publishable(entry, str(key)) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [publishable(entry) for entry in value]
    if value is None or isinstance(value, int) or (isinstance(value, float) and isfinite(value)):
        return value
    return publishable_text(str(value))


def publishable_argument(argument: str) -> str:
    """One word of a command line, likewise: `llm.api_key=...` is a field with a name."""
    found = _ASSIGNMENT.match(argument)
    if found is None:
        return publishable_text(argument)
    name, value = found["name"], found["value"]
    return f"{name}={REMOVED if value and _SECRET_NAME.search(name) else publishable_text(value)}"


def publishable_text(text: str) -> str:
    """A text, likewise."""
    for name, value in os.environ.items():
        if _SECRET_NAME.search(name) and not _PLACEHOLDER.fullmatch(value):
            text = text.replace(value, REMOVED)
    text = _IN_QUERY.sub(rf"\g<1>{REMOVED}", _IN_ADDRESS.sub(f"{REMOVED}@", without_keys(text)))
    return _without_home(text)


def at_home(text: str) -> str:
    """A path that begins with `~`, the home folder of whoever reads it; another text as it is."""
    return str(Path(text).expanduser()) if text == HOME or text.startswith(f"{HOME}/") else text


def _without_home(text: str) -> str:
    home = str(Path.home()).rstrip("/\\")
    if not home:
        return text
    return re.sub(rf"{re.escape(home)}(?=$|[/\\\s\"',\]}}])", lambda _: HOME, text)
