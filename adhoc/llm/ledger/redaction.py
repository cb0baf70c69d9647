"""Taking out of a ledger what others shall not read, so that it can still be replayed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

from adhoc.core.errors import LedgerError
from adhoc.llm.ledger.entry import Answer, Call, Entry, Failure, Header, Text
from adhoc.llm.ledger.storable import REMOVED, storable, without_keys


@dataclass(frozen=True)
class Redaction:
    """What is taken out; keys of providers are in any case. Calls keep their keys, so that a replay finds
    them, and answers what they say, unless `answers` is set.

    Call it with an entry and its place; it returns the entry that may be published.
    """

    prompts: bool = False
    """Remove the contents of all messages and schemas."""
    raw: bool = False
    """Remove what providers sent beside the text."""
    words: Sequence[str] = ()
    """Remove these wherever they stand, in upper or lower case."""
    answers: bool = False
    """Remove words from answers, too. A replay may then miss calls that quote them."""

    def __call__(self, entry: Entry, where: str) -> Entry:
        """The entry without what is to be taken out.

        Raises LedgerError if a word is in an answer and `answers` is not set, or in the header, which is part
        of all keys.
        """
        if isinstance(entry, Text):
            content = "" if self.prompts else self._without(entry.content)
            return replace(entry, content=content, redacted=entry.redacted or content != entry.content)
        if isinstance(entry, Call):
            return self._call(entry)
        if isinstance(entry, Failure):
            return replace(entry, message=self._without(entry.message))
        if isinstance(entry, Answer):
            return self._answer(entry, where)
        return self._header(entry, where)

    def _call(self, call: Call) -> Call:
        """A replay does not look at who asked."""
        stage, agent, episode = map(self._without, (call.stage, call.agent, call.episode))
        return replace(call, stage=stage, agent=agent, episode=episode)

    def _answer(self, answer: Answer, where: str) -> Answer:
        text, problem = self._without(answer.text), answer.problem and self._without(answer.problem)
        if (text, problem) != (answer.text, answer.problem) and not self.answers:
            raise LedgerError(
                f"{where}: the answer to {answer.key} holds a word that is to be removed, and a replay may "
                "need it; --answers removes it all the same"
            )
        raw = None if self.raw or answer.raw is None else self._everywhere(storable(answer.raw))
        return replace(answer, text=text, problem=problem, raw=raw)

    def _header(self, header: Header, where: str) -> Header:
        for field in fields(header):
            value = getattr(header, field.name)
            if self._everywhere(value) != value:
                raise LedgerError(
                    f"{where}: {field.name} is {value!r}, which holds a word that is to be removed"
                )
        return header

    def _everywhere(self, value: Any) -> Any:
        """JSON values with all their texts changed."""
        if isinstance(value, str):
            return self._without(value)
        if isinstance(value, dict):
            return {self._without(name): self._everywhere(entry) for name, entry in value.items()}
        return [self._everywhere(entry) for entry in value] if isinstance(value, list) else value

    def _without(self, text: str) -> str:
        text = without_keys(text)
        if not self.words:
            return text
        longest_first = sorted(self.words, key=len, reverse=True)
        return re.sub("|".join(map(re.escape, longest_first)), REMOVED, text, flags=re.IGNORECASE)
