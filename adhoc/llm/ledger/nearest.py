"""Why a call is not in a ledger: how the nearest recorded one differs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from heapq import nlargest
from pathlib import Path

from adhoc.llm.ledger.entry import Call, Entry, Failure, Text
from adhoc.llm.ledger.key import text_hash
from adhoc.llm.ledger.reader import existing_files
from adhoc.llm.model import LMRequest

MOST_COMPARED = 200
"""So many calls with other messages are compared text by text."""
_SHOWN = 40


def nearest_difference(path: Path, asked: Call, request: LMRequest) -> str:
    """What differs between a request and the most similar recorded call, as the end of a sentence.

    `asked` is the entry that the request would be recorded as. Reads the whole ledger, more than once: that
    takes seconds where it is large.
    """
    for entry in _entries(path):
        if isinstance(entry, Failure) and entry.key == asked.key:
            return f"it was made, but failed: {entry.error}: {entry.message}"
    calls = [call for call in _calls(path) if call.key == asked.key or call.messages == asked.messages]
    if any(call.key == asked.key for call in calls):
        return "it was made, but never answered: the run was ended while it was in flight"
    if calls:
        apart = min((_settings_apart(call, asked) for call in calls), key=len)
        return f"a recorded call with the same messages has another {', another '.join(apart)}"
    same_stage = (call for call in _calls(path) if call.stage == asked.stage)
    alike = nlargest(MOST_COMPARED, same_stage, key=lambda call: _likeness(call, asked))
    if not alike:
        return f"no call of stage {asked.stage!r} is recorded at all"
    return _messages_apart(alike, _texts(path, alike), asked, request)


def _entries(path: Path) -> Iterator[Entry]:
    for file in existing_files(path):
        for _, entry in file.entries():
            yield entry


def _calls(path: Path) -> Iterator[Call]:
    return (entry for entry in _entries(path) if isinstance(entry, Call))


def _settings_apart(call: Call, asked: Call) -> list[str]:
    """`name (value there, value here)` of everything in a key that differs and is no message."""
    names = ("template", "model", "temperature", "max_tokens", "seed", "sample", "repeat", "schema")
    apart = [
        f"{name} ({getattr(call, name)!r} there, {getattr(asked, name)!r} here)"
        for name in names
        if getattr(call, name) != getattr(asked, name)
    ]
    return apart or ["setting of the model"]


def _likeness(call: Call, asked: Call) -> tuple[int, bool, bool]:
    equal = sum(mine == theirs for mine, theirs in zip(call.messages, asked.messages))
    return equal, call.episode == asked.episode, call.agent == asked.agent


def _texts(path: Path, calls: Iterable[Call]) -> Mapping[str, Text]:
    """These calls' messages, by hash."""
    wanted = {digest for call in calls for _, digest in call.messages}
    return {
        entry.sha256: entry for entry in _entries(path) if isinstance(entry, Text) and entry.sha256 in wanted
    }


def _messages_apart(alike: Sequence[Call], texts: Mapping[str, Text], asked: Call, request: LMRequest) -> str:
    """Where the messages part, for the call that goes along with the request for longest."""

    def parting(call: Call) -> tuple[int, int]:
        """The first message that differs, and its first character that does."""
        for number, message in enumerate(request.messages):
            if number >= len(call.messages):
                return number, 0
            digest = call.messages[number][1]
            if digest != text_hash(message.content):
                there = texts.get(digest)
                return number, 0 if there is None else _equal_characters(there.content, message.content)
        return len(request.messages), 0

    call = max(alike, key=parting)
    number, character = parting(call)
    told = f"the nearest recorded call ({call.key[:12]}..., of {call.agent!r} in episode {call.episode!r})"
    there = texts.get(call.messages[number][1]) if number < len(call.messages) else None
    if there is not None and there.redacted:
        return f"{told} has another message {number + 1}, whose text was taken out of this ledger"
    here = request.messages[number].content if number < len(request.messages) else None
    return (
        f"{told} has another message {number + 1}: from character {character} on "
        f"{_from(None if there is None else there.content, character)} there, {_from(here, character)} here"
    )


def _equal_characters(there: str, here: str) -> int:
    pairs = enumerate(zip(there, here))
    return next((place for place, (one, other) in pairs if one != other), min(len(there), len(here)))


def _from(text: str | None, character: int) -> str:
    return "no message" if text is None else repr(text[character : character + _SHOWN])
