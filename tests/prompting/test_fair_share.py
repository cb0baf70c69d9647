"""A robot that talks without end does not hide what the others said."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest
from fake_situation import CONTEXT
from hypothesis import given
from hypothesis import strategies as st

from adhoc.agents.memory import Memory
from adhoc.core.messages import Message, MessageKind
from adhoc.prompting.fair_share import MESSAGES_A_STEP, without_crowding
from adhoc.prompting.limits import Limits, messages_shown
from adhoc.tasks.tidying_up import TidyingUp

LIMIT = 200


def say(sender: str, step: int, number: int = 0) -> Message:
    return Message(MessageKind.DETECTION, f"{sender} {step} {number}", {}, None, sender, step)


def talk(steps: int, **rates: int) -> list[Message]:
    """So many messages of each sender in every step."""
    return [
        say(name, step, it) for step in range(steps) for name, rate in rates.items() for it in range(rate)
    ]


def flood(before: int = 60, during: int = 20) -> list[Message]:
    quiet = {"me": 1, "teammate_1": 1, "teammate_2": 1}
    later = talk(before + during, **quiet, liar=64)
    return [it for it in later if it.sender != "liar" or it.step >= before]


def counts(messages) -> Counter:
    return Counter(message.sender for message in messages)


def test_a_flood_has_an_equal_share_and_the_others_the_rest() -> None:
    shown = messages_shown(replace(CONTEXT, me="me", messages=tuple(flood())), (), Limits(messages=LIMIT))
    assert counts(shown)["liar"] <= LIMIT // 4
    assert min(counts(shown)[name] for name in ("me", "teammate_1", "teammate_2")) >= 25
    assert [it for it in flood() if it in shown] == shown, "the order is that of sending"
    assert shown[-1] == flood()[-1]


def test_without_the_rule_it_hides_them() -> None:
    assert counts(flood()[-LIMIT:])["teammate_1"] < 5


def test_two_floods_after_each_other_are_both_cut() -> None:
    first = [it for it in flood(60, 20) if it.step < 70 or it.sender != "liar"]
    second = [say("other", step, it) for step in range(80, 100) for it in range(64)]
    kept = counts(without_crowding([*first, *second], "me", LIMIT))
    assert kept["other"] == kept["liar"] == LIMIT // 5
    assert kept["teammate_1"] == 80


@given(
    st.lists(st.integers(0, MESSAGES_A_STEP), min_size=1, max_size=4), st.integers(1, 60), st.integers(1, 250)
)
def test_whoever_keeps_to_a_usual_pace_is_not_cut(rates, steps, limit) -> None:
    """However unequal the robots are: what honest teams say is shown as if there were no rule."""
    messages = talk(steps, me=64, **{f"teammate_{it}": rate for it, rate in enumerate(rates)})
    assert without_crowding(messages, "me", limit) == messages


def test_where_all_fit_nothing_goes() -> None:
    messages = talk(1, liar=100)
    assert without_crowding(messages, "me", 100) == messages


@given(st.lists(st.tuples(st.sampled_from("abcd"), st.integers(0, 5)), max_size=80), st.integers(0, 30))
def test_what_is_left_is_a_part_in_order_and_the_latest_of_everybody(said, limit) -> None:
    said = sorted(said, key=lambda it: it[1])
    messages = [say(sender, step, number) for number, (sender, step) in enumerate(said)]
    kept = without_crowding(messages, "a", limit)
    assert [it for it in messages if it in kept] == kept
    for name in "abcd":
        of_all, left = ([it for it in some if it.sender == name] for some in (messages, kept))
        assert left == of_all[len(of_all) - len(left) :]
    assert counts(kept)["a"] == counts(messages)["a"]


@pytest.mark.parametrize("kept", [100, 1000])
def test_a_memory_keeps_what_the_others_said_through_a_flood(kept: int) -> None:
    memory = Memory("me", TidyingUp(), messages_kept=kept)
    for step in range(100):
        memory.hear([say("quiet", step)] if step < 20 else [say("liar", step, it) for it in range(64)])
        assert len(memory.messages) <= kept
    assert counts(memory.messages)["quiet"] == 20
