"""Keeping one robot that talks without end from crowding out what the others said."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from adhoc.core.messages import Message

MESSAGES_A_STEP = 8
"""In the steps in which it says anything, a robot of this library says less on average: a report or two, a
question for each candidate that it weighs, or as many answers."""


def without_crowding(
    messages: Sequence[Message], me: str, limit: int, a_step: int = MESSAGES_A_STEP
) -> list[Message]:
    """The messages without those that take the places of others: where all fit, all of them.

    A robot crowds the others out if it has more than an equal share of the latest `limit` messages, and said
    more than `a_step` of them in a step, on average over the steps in which it spoke. Of its messages, only
    the latest stay, as many as its share. So robots of a usual pace are shown as if there were no rule.

    Args:
        messages: In the order of sending.
        me: Whose prompt or memory it is; it does not crowd itself out.
        limit: How many there is room for.
        a_step: What a usual pace is.
    """
    kept = list(messages)
    share = limit // max(1, len({message.sender for message in kept}))
    while len(kept) > limit:
        crowding = _crowding(kept[len(kept) - limit :], me, share, a_step)
        if not crowding:
            break
        kept = _latest(kept, crowding, share)
    return kept


def _crowding(latest: Sequence[Message], me: str, share: int, a_step: int) -> set[str]:
    """Who crowds the others out; each has more than its share, hence none is found twice."""
    said = Counter(message.sender for message in latest)
    steps = Counter(sender for sender, _ in {(message.sender, message.step) for message in latest})
    return {it for it, count in said.items() if it != me and count > max(share, a_step * steps[it])}


def _latest(messages: Sequence[Message], senders: set[str], share: int) -> list[Message]:
    """The messages, of each of the senders only the latest `share`."""
    kept: list[Message] = []
    left = dict.fromkeys(senders, share)
    for message in reversed(messages):
        if left.get(message.sender, 1) > 0:
            kept.append(message)
            if message.sender in left:
                left[message.sender] -= 1
    return kept[::-1]
