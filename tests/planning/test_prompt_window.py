"""A question to a model with a small window: the earliest messages are left out, and counted."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fake_situation import CONTEXT

from adhoc.core.errors import PromptError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.replies import Reading, ReplyFormat
from adhoc.llm.counting import CountingModel
from adhoc.llm.scripted import ScriptedModel
from adhoc.planning.inquiry import Inquiry
from adhoc.prompting.stage import StageInput

ANY = ReplyFormat("any", {}, Reading)
MESSAGES = tuple(
    Message(MessageKind.DETECTION, f"word{it}. {'y' * 90}", {}, None, "t", it) for it in range(60)
)
TALK = replace(CONTEXT, messages=MESSAGES)


class SmallWindow(ScriptedModel):
    """Has room for so many tokens, prompt and reply together."""

    def __init__(self, tokens: int) -> None:
        super().__init__(["x"] * 9)
        self.tokens = tokens

    @property
    def window(self) -> int:
        return self.tokens


def asked(tokens: int) -> tuple[SmallWindow, CountingModel]:
    model = SmallWindow(tokens)
    counting = CountingModel(model)
    Inquiry(counting, "generate", max_tokens=100).ask(TALK, StageInput(), lambda prompt: ANY)
    return model, counting


def test_the_earliest_messages_are_left_out_and_counted() -> None:
    model, counting = asked(2000)
    (request,) = model.requests
    left_out = counting.total.left_out_messages
    assert 0 < left_out < 60
    shown = [it for it in range(60) if f"word{it}." in request.messages[1].content]
    assert shown == list(range(left_out, 60))
    assert 1900 - 50 < model.count_tokens(request.messages) <= 1900


def test_a_large_window_takes_all() -> None:
    assert asked(100_000)[1].total.left_out_messages == 0


def test_what_cannot_fit_is_never_asked() -> None:
    with pytest.raises(PromptError, match="longer than the model's context window"):
        asked(300)
