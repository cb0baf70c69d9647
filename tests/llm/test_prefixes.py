"""What part of a prompt is the beginning of the one before."""

from __future__ import annotations

import pytest

from adhoc.core.chat import ChatMessage
from adhoc.llm.counting import CountingModel
from adhoc.llm.model import LMRequest, LMResponse, Usage
from adhoc.llm.prefixes import SharedPrefixes
from adhoc.llm.scripted import ScriptedModel


def request(system: str, user: str, stage: str = "generate", agent: str = "a", **fields) -> LMRequest:
    return LMRequest((ChatMessage("system", system), ChatMessage("user", user)), stage, agent=agent, **fields)


def test_the_first_of_a_stage_and_an_agent_shares_nothing() -> None:
    prefixes = SharedPrefixes()
    assert prefixes.share(request("S", "1 2")) == 0
    assert prefixes.share(request("S", "1 2", stage="evaluate")) == 0
    assert prefixes.share(request("S", "1 2", agent="b")) == 0
    assert prefixes.share(request("S", "1 2")) == 1


@pytest.mark.parametrize(
    ("first", "second", "shared", "whole"),
    [
        ("1234", "1239", 3, 4),
        ("1234", "12345678", 4, 8),
        ("12345678", "1234", 4, 4),
        ("1234", "9234", 0, 4),
        ("", "1", 0, 1),
        ("1ab4", "1ab9", 1, 2),
        ("\u00e9", "\u00e8", 1, 2),
    ],
)
def test_the_share_ends_at_the_first_byte_that_differs(first, second, shared, whole) -> None:
    """Roles and separators count, too: 2 x 2 characters that are no small letters, less the last one."""
    prefixes = SharedPrefixes()
    prefixes.share(request("", first))
    expected = (shared + 3 + (first == second[: len(second)])) / (whole + 4)
    assert prefixes.share(request("", second)) == pytest.approx(expected)


def test_what_follows_the_difference_does_not_count() -> None:
    prefixes = SharedPrefixes()
    prefixes.share(request("1", "2222"))
    assert prefixes.share(request("9", "2222")) == pytest.approx(1 / 9)


class FixedUsage(ScriptedModel):
    def complete(self, request: LMRequest) -> LMResponse:
        return LMResponse("x", "m", Usage(1000, 1))


def test_counts_hold_shared_tokens_and_left_out_messages_of_one_episode() -> None:
    model = CountingModel(FixedUsage([]))
    for _ in range(2):
        model.begin_episode("e", 0)
        model.complete(request("S", "1", left_out_messages=2))
        assert (model.total.prefix_tokens, model.total.left_out_messages) == (0, 2)
        model.complete(request("S", "1", left_out_messages=3))
        assert (model.total.prefix_tokens, model.total.left_out_messages) == (1000, 5)
        assert model.total.prompt_tokens == 2000
