"""How many public messages a stranger can understand, and in which dialects they are."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from adhoc.agents.dialects.listening import Listener
from adhoc.core.messages import Message, MessageKind


class Understanding:
    """Counts what robots say to everybody or to each other, by the adapters that every robot has.

    What a team says to itself (`MessageKind.TEAM`) is not counted, and neither are adapters that a robot has
    besides.
    """

    def __init__(self) -> None:
        self._listener = Listener()
        self.understood: Counter[str] = Counter()
        """By dialect; `structured` is the library's own format."""
        self.not_understood = 0
        """What stays text."""

    def add(self, messages: Iterable[Message]) -> None:
        """Count these."""
        for message in messages:
            if message.kind is MessageKind.TEAM:
                continue
            dialect = self._listener.dialect_of(message)
            if dialect is None:
                self.not_understood += 1
            else:
                self.understood[dialect] += 1
