"""Making a prompt short enough: the earliest messages go first, then the earliest memory."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import PromptError
from adhoc.prompting.limits import Limits

Fits = Callable[[Sequence[ChatMessage]], bool]
"""Whether a prompt leaves room for the reply in the model's context window."""


@dataclass(frozen=True)
class FittedPrompt:
    """A prompt that fits."""

    messages: tuple[ChatMessage, ...]
    left_out_messages: int = 0
    """How many of the earliest communication messages were left out for it."""


def fit(
    fill: Callable[[Limits], tuple[ChatMessage, ...]],
    messages: int,
    history: int,
    limits: Limits,
    fits: Fits,
    template: str,
) -> FittedPrompt:
    """The longest prompt that fits, as the paper shortens it (section Communication).

    The earliest communication messages are left out, as few as will do; if it is too long without any, the
    earliest events of memory are, too. The number is searched by bisection.

    Args:
        fill: Renders the prompt within limits.
        messages: How many communication messages the whole prompt has.
        history: How many events of memory it has.
        limits: Those of the whole prompt.
        fits: Whether a rendered prompt fits.
        template: Named in the error.

    Raises:
        PromptError: It does not fit even without messages and memory.
    """
    whole = fill(limits)
    if fits(whole):
        return FittedPrompt(whole)

    def attempt(cut: int) -> tuple[ChatMessage, ...]:
        return fill(replace(limits, messages_cut=min(cut, messages), history_cut=max(0, cut - messages)))

    low, high = 0, messages + history
    fitting = attempt(high)
    if not fits(fitting):
        raise PromptError(
            f"prompt {template!r}: the situation alone, without messages and memory, is longer than the "
            "model's context window less the reply; take a model with a longer window, or lower max_tokens, "
            "max_objects or max_receptacles_per_type"
        )
    while low + 1 < high:
        middle = (low + high) // 2
        prompt = attempt(middle)
        if fits(prompt):
            high, fitting = middle, prompt
        else:
            low = middle
    return FittedPrompt(fitting, min(high, messages))
