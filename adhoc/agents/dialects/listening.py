"""Understanding strangers: each message by the first adapter that can read it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from adhoc.agents.dialects.codes import Codes
from adhoc.agents.dialects.dialect import Adapter
from adhoc.agents.dialects.meaning import checked, facts_of, is_understood
from adhoc.agents.dialects.sentences import Sentences, sentences_of
from adhoc.agents.dialects.structured import Structured
from adhoc.core.messages import Message, MessageKind

KNOWN_ADAPTERS: tuple[Adapter, ...] = (Codes(), Sentences())
"""The formats that every robot of this library understands besides its own."""


class Listener:
    """Turns what others say into messages whose payload `agents.communication` can read.

    A payload in that format is never touched, and what a team says to itself (`MessageKind.TEAM`) is left
    alone. Of a translated message the text stays where it is plain language and is put into sentences where
    it is not. What no adapter can read stays as it came: text for those that read texts.

    Args:
        adapters: Tried before the known ones, in order: for teams of your own.
    """

    def __init__(self, adapters: Sequence[Adapter] = ()) -> None:
        self._adapters = (*adapters, *KNOWN_ADAPTERS)

    def understand(self, messages: Iterable[Message]) -> tuple[Message, ...]:
        """The messages, translated where they can be."""
        return tuple(self._recognise(message)[0] for message in messages)

    def dialect_of(self, message: Message) -> str | None:
        """The name of the adapter that understands the message; None if none does.

        `structured` for the library's own format.
        """
        return self._recognise(message)[1]

    def _recognise(self, message: Message) -> tuple[Message, str | None]:
        if message.kind is MessageKind.TEAM:
            return message, None
        if is_understood(message):
            return message, Structured.name
        for adapter in self._adapters:
            translated = _translated(adapter, message)
            if translated is not None:
                return translated, adapter.name
        return message, None


def _translated(adapter: Adapter, message: Message) -> Message | None:
    payload = adapter.read(message)
    if payload is None:
        return None
    raw = replace(message, payload=payload)
    read = replace(raw, payload=checked(raw))
    if not read.payload:
        return None
    return read if adapter.plain else replace(read, text=sentences_of(facts_of(read)))
