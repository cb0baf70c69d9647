"""The library's own format, and silence."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from adhoc.agents.dialects.dialect import Dialect
from adhoc.agents.dialects.meaning import is_understood
from adhoc.core.messages import Message


class Structured(Dialect):
    """A text for people and models, and a payload for machines, as `agents.communication` writes them."""

    name = "structured"
    plain = True

    def write(self, message: Message) -> Message | None:
        """See `Dialect`: as it is."""
        return message

    def read(self, message: Message) -> Mapping[str, Any] | None:
        """See `Adapter`: the payload, as it is."""
        return message.payload if is_understood(message) else None


class Silent(Dialect):
    """Says nothing to strangers: no reports, no answers, no questions."""

    name = "silent"

    def write(self, message: Message) -> Message | None:
        """See `Dialect`."""
        return None

    def read(self, message: Message) -> Mapping[str, Any] | None:
        """See `Adapter`: nothing can be read of it."""
        return None
