"""What the offline reasoner knows before it reads a prompt, as a language model's weights do."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from adhoc.core.values import Place
from adhoc.llm.offline.facts import CallText, Facts, ObjectFact, ReceptacleFact

_FAILURE = re.compile(r"\b(fail\w*|could not|cannot|refused|gave up|impossible)\b", re.IGNORECASE)
_UNKNOWN = 1000.0
"""Metres that a place counts of which no receptacle is known."""


class Knowledge:
    """Where things belong, by category, likeliest place first; and what that means in a situation."""

    def __init__(self, places: Mapping[str, Sequence[Place]]) -> None:
        self._places = {category: tuple(its) for category, its in places.items()}

    def places(self, facts: Facts, thing: ObjectFact) -> list[Place]:
        """Places for `thing`, the best first: those that are known and near, then the likeliest.

        A receptacle that failed to take the thing, or that holds it now, does not count as known.
        """
        return sorted(
            self._places.get(thing.category, ()),
            key=lambda place: next(
                (
                    it.distance
                    for it in usable_receptacles(facts, thing.id, place.receptacle, place.room_type)
                ),
                _UNKNOWN,
            ),
        )

    def belongs(self, facts: Facts) -> dict[str, list[str]]:
        """Where things of the asked category belong: room types by receptacle type, of those in the prompt,
        the likeliest receptacle type first."""
        found: dict[str, list[str]] = {}
        for place in self._places.get(facts.asked_category or "", ()):
            if place.receptacle in facts.receptacle_types and place.room_type in facts.room_types:
                found.setdefault(place.receptacle, []).append(place.room_type)
        return found


def usable_receptacles(
    facts: Facts, thing: str, category: str, room_type: str | None
) -> Iterator[ReceptacleFact]:
    """Known receptacles of the wanted kind that may take the thing, nearest first."""
    known = facts.receptacles.get(category, ())
    here = next((it.receptacle for it in facts.objects if it.id == thing), None) if known else None
    for it in known:
        fits = room_type is None or it.room_type == room_type
        if fits and it.id != here and not last_attempt_failed(facts, it.id):
            yield it


def failures(facts: Facts, identifier: str) -> int:
    """How many lines of memory tell of a failure with the thing or room."""
    return sum(
        1 for event in facts.history if mentions(event.text, identifier) and _FAILURE.search(event.text)
    )


def last_attempt_failed(facts: Facts, words: str) -> bool:
    """Whether the latest line of memory or result that mentions `words` tells of a failure."""
    lines = [*(event.text for event in facts.history), facts.last]
    latest = next((line for line in reversed(lines) if mentions(line, words)), "")
    return _FAILURE.search(latest) is not None


def refused_now(facts: Facts) -> dict[CallText, str]:
    """The sub-tasks that were judged infeasible at this very step, as memory tells, and why."""
    refused = {}
    for event in facts.history:
        begin, _, rest = event.text.partition("judged infeasible: ")
        call, _, reason = rest.partition(" (because: ")
        words = call.split()
        if event.step == facts.step and not begin and words:
            refused[CallText(words[0], tuple(words[1:]))] = reason
    return refused


def mentions(text: str, words: str) -> bool:
    """Whether `text` holds `words` as such, and not as part of a longer id."""
    start = text.find(words)
    while start >= 0:
        end = start + len(words)
        if not _joins(text[start - 1 : start]) and not _joins(text[end : end + 1]):
            return True
        start = text.find(words, start + 1)
    return False


def _joins(character: str) -> bool:
    return character.isalnum() or character in ("|", "_") if character else False
