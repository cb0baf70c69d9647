"""How much of what a robot knows a prompt carries."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from adhoc.core.messages import Message
from adhoc.core.plans import Context, Event
from adhoc.prompting.fair_share import without_crowding

_BLOCKS = 3


@dataclass(frozen=True)
class Limits:
    """How much of each list a prompt carries; see `PromptLibrary`."""

    messages: int = 200
    history: int = 12
    message_characters: int = 1000
    reply_characters: int = 4000
    objects: int = 15
    receptacles_per_type: int = 3
    messages_cut: int = 0
    """How many of the earliest messages that would be shown are left out for want of space."""
    history_cut: int = 0


def messages_shown(context: Context, replies: Sequence[Message], limits: Limits) -> Sequence[Message]:
    """The latest messages, oldest first, without the replies, which have a section of their own.

    Once there are more than the limit, a third of it goes at a time: then the earliest message that is shown,
    and with it the beginning of the prompt, stays the same for many calls. A robot that talks without end has
    no more than an equal share of them.
    """
    replied = set(map(_identity, replies))
    others = [message for message in context.messages if _identity(message) not in replied]
    messages = without_crowding(others, context.me, limits.messages)
    block = max(1, limits.messages // _BLOCKS)
    blocks = -(-max(0, len(messages) - limits.messages) // block)
    return messages[blocks * block + limits.messages_cut :]


def history_shown(context: Context, limits: Limits) -> Sequence[Event]:
    """The latest events of memory, oldest first."""
    return context.history[max(0, len(context.history) - limits.history) + limits.history_cut :]


def _identity(message: Message) -> tuple[str, int, str, str]:
    return message.sender, message.step, message.kind.value, message.text
