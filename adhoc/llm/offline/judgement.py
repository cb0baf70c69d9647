"""Whether a chosen sub-task is feasible, by the situation and by what the teammates reply."""

from __future__ import annotations

import re
from collections.abc import Iterable

from adhoc.llm.offline.facts import CallText, Facts
from adhoc.llm.offline.knowledge import Knowledge, mentions, refused_now
from adhoc.llm.offline.options import LAST_RESORT, SHARED, claimant, objection, options, unattended

_SENTENCE = re.compile(r"(?<=[.;!?])\s+|\n")
_NEGATED_EXPLORED = re.compile(r"\b(not|never|un)[ -]?(yet )?explored\b", re.IGNORECASE)
_EXPLORED = re.compile(r"\b(explored|searched|nothing (is )?(left|there|in)|finished with)\b", re.IGNORECASE)
_DOING = re.compile(
    r"sub-task|sub-skill|\b(i am|i'm|i will|doing|exploring|searching|handling|heading|taking|on it)\b",
    re.IGNORECASE,
)
_HOLDING = re.compile(r"\b(hold|holding|carry|carrying|have picked|picked up|in my hand)\b", re.IGNORECASE)
_GONE = re.compile(
    r"\b(gone|no longer|moved|put away|needs nothing|in place|well placed|placed it|have put"
    r"|already (put|placed|done))\b",
    re.IGNORECASE,
)


def judge(facts: Facts, knowledge: Knowledge) -> tuple[bool, str]:
    """Whether the chosen sub-task is feasible, and the reason as a sentence."""
    chosen = facts.chosen
    if chosen is None:
        return True, "I see nothing against it"
    reason = objection(facts, chosen) or _reported(facts, chosen)
    if reason is None:
        reason = _shared(facts, knowledge, chosen) or _idle(facts, knowledge, chosen)
    return reason is None, reason or "nobody is doing it, it is still needed, and I am able to do it"


def _reported(facts: Facts, chosen: CallText) -> str | None:
    """What a reply says against it for good: a thing that somebody has or that is gone, a room explored."""
    return _told(facts, chosen, _sentences(facts))


def _told(facts: Facts, chosen: CallText, sentences: Iterable[tuple[str, str]]) -> str | None:
    for sender, sentence in sentences:
        for kind, value in _arguments(facts, chosen):
            if not mentions(sentence, value):
                continue
            if kind == "object id" and (_HOLDING.search(sentence) or _DOING.search(sentence)):
                return f"{sender} says that it is handling {value}"
            if kind == "object id" and _GONE.search(_about(sentence, value)):
                return f"{sender} says that {value} needs nothing any more"
            if kind == "room id" and _EXPLORED.search(sentence) and not _NEGATED_EXPLORED.search(sentence):
                return f"{sender} says that {value} is explored already"
    return None


def _shared(facts: Facts, knowledge: Knowledge, chosen: CallText) -> str | None:
    """A room that somebody is exploring: not if anything better is left, else two find more than one."""
    for kind, value in _arguments(facts, chosen):
        if kind != "room id":
            continue
        said = (
            sender
            for sender, sentence in _sentences(facts)
            if mentions(sentence, value) and _DOING.search(sentence)
        )
        who = claimant(facts, value) or next(said, None)
        better = any(it.preference < SHARED and it.call != chosen for it in options(facts, knowledge))
        if who is not None and better:
            return f"{who} is at {value}, and something else is left to do"
    return None


def _idle(facts: Facts, knowledge: Knowledge, chosen: CallText) -> str | None:
    """The last resort, while something is left to do.

    A thing in need that nobody is at speaks against it even if doing something about it was refused at this
    step, unless that refusal, or a reply, tells that somebody handles it or that it needs nothing.
    """
    if chosen.args:
        return None
    told = [*_sentences(facts), *(("memory", reason) for reason in refused_now(facts).values())]
    for call in unattended(facts, knowledge):
        if _told(facts, call, told) is None:
            return f"I am able to do {call}, and nobody else is at it"
    useful = (it.call for it in options(facts, knowledge) if it.preference < LAST_RESORT)
    left = next((call for call in useful if _told(facts, call, told) is None), None)
    return None if left is None else f"{left} is left to do"


def _arguments(facts: Facts, chosen: CallText) -> list[tuple[str, str]]:
    spec = next((it for it in facts.sub_tasks if it.name == chosen.name), None)
    return [] if spec is None else list(zip(spec.parameters.values(), chosen.args))


def _sentences(facts: Facts) -> list[tuple[str, str]]:
    return [
        (reply.sender, sentence)
        for reply in facts.replies
        for sentence in _SENTENCE.split(reply.text)
        if sentence
    ]


def _about(sentence: str, identifier: str) -> str:
    """The part of a sentence from the id to the next comma, so that the things of a list keep apart."""
    rest = sentence[sentence.find(identifier) :]
    return rest.partition(", ")[0]
