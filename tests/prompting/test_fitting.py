"""Prompts within a model's window: the earliest messages go first, then memory, then it is an error."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fake_situation import CONTEXT

from adhoc.core.calls import Call
from adhoc.core.errors import PromptError
from adhoc.core.messages import Message, MessageKind
from adhoc.core.plans import Candidate, Event
from adhoc.prompting.library import PromptLibrary, shipped_prompts
from adhoc.prompting.stage import StageInput

MESSAGES = tuple(Message(MessageKind.DETECTION, f"word{it}.", {}, None, "t", it) for it in range(20))
HISTORY = tuple(Event(it, f"deed{it}.") for it in range(6))
TALK = replace(CONTEXT, messages=MESSAGES, history=HISTORY)
STAGE = StageInput(count=3)


def length(messages) -> int:
    return sum(len(it.content) for it in messages)


def fitted(longest: int, context=TALK, library=None):
    library = library or shipped_prompts()
    return library.fit("generate", context, STAGE, lambda messages: length(messages) <= longest)


def shown(prompt, word: str) -> list[int]:
    return [it for it in range(20) if f"{word}{it}." in prompt.messages[1].content]


def without(messages: int, events: int = 0):
    """The prompt of a robot that never heard and never noted the earliest."""
    context = replace(TALK, messages=MESSAGES[messages:], history=HISTORY[events:])
    return shipped_prompts().render("generate", context, STAGE)


def test_a_prompt_that_fits_is_left_alone() -> None:
    prompt = fitted(length(without(0)))
    assert prompt.messages == without(0)
    assert prompt.left_out_messages == 0


@pytest.mark.parametrize("left_out", [1, 2, 7, 19, 20])
def test_as_few_of_the_earliest_messages_go_as_will_do(left_out: int) -> None:
    prompt = fitted(length(without(left_out)))
    assert prompt.messages == without(left_out)
    assert prompt.left_out_messages == left_out
    if left_out > 1:
        one_less = length(without(left_out - 1)) - 1
        assert fitted(one_less).left_out_messages == left_out


@pytest.mark.parametrize("events", [1, 5, 6])
def test_then_the_earliest_memory_goes(events: int) -> None:
    prompt = fitted(length(without(20, events)))
    assert prompt.left_out_messages == 20
    assert shown(prompt, "deed") == list(range(events, 6))


def test_what_is_left_out_counts_from_those_that_would_be_shown() -> None:
    library = PromptLibrary(max_messages=9)
    whole = length(library.render("generate", TALK, STAGE))
    prompt = fitted(whole - 1, library=library)
    assert (shown(prompt, "word"), prompt.left_out_messages) == ([13, 14, 15, 16, 17, 18, 19], 1)


def test_a_situation_that_does_not_fit_is_an_error_that_says_what_to_do() -> None:
    with pytest.raises(PromptError, match=r"'generate'.*longer than the model's context window.*max_objects"):
        fitted(500)


def test_the_search_renders_few_prompts() -> None:
    asked = []
    many = tuple(replace(it, text=f"{it.text} {number}") for number in range(10) for it in MESSAGES)
    whole = length(shipped_prompts().render("generate", replace(TALK, messages=many), STAGE))

    def fits(messages) -> bool:
        asked.append(length(messages))
        return asked[-1] <= whole - 100

    shipped_prompts().fit("generate", replace(TALK, messages=many), STAGE, fits)
    assert len(asked) <= 11


def test_replies_are_never_left_out_nor_counted() -> None:
    """They have a section of their own, and are among the messages as well."""
    replies = MESSAGES[-3:]
    stage = StageInput(chosen=Candidate(Call("Rest")), replies=replies)
    prompt = shipped_prompts().fit(
        "reflect",
        TALK,
        stage,
        lambda messages: "word16." not in messages[1].content and "deed0." not in messages[1].content,
    )
    assert shown(prompt, "word") == [17, 18, 19]
    assert prompt.left_out_messages == 17
