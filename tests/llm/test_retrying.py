"""Asking a busy model again: how often, how long, and when not."""

from __future__ import annotations

import pytest
from fake_time import FakeTime

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError, ModelBusy
from adhoc.llm.limiting import CallLimiter
from adhoc.llm.model import LMRequest
from adhoc.llm.retrying import RetryingModel
from adhoc.llm.scripted import ScriptedModel

REQUEST = LMRequest((ChatMessage("user", "hello"),), "generate")


def retrying(script: ScriptedModel, time: FakeTime, **arguments: float) -> RetryingModel:
    limiter = CallLimiter(4, clock=time.clock, sleep=time.sleep)
    return RetryingModel(script, limiter=limiter, clock=time.clock, sleep=time.sleep, **arguments)  # type: ignore[arg-type]


def test_the_provider_s_word_goes_before_doubling() -> None:
    time = FakeTime()
    script = ScriptedModel([ModelBusy("a", 7.0, True), ModelBusy("b"), ModelBusy("c", 0.0), "here"])
    response = retrying(script, time).complete(REQUEST)
    assert response.text == "here"
    assert time.slept == [7.0, 4.0, 0.0]
    assert response.latency_s == 11.0, "the waits are part of it"


def test_single_waits_are_capped() -> None:
    time = FakeTime()
    script = ScriptedModel([*(ModelBusy("a") for _ in range(6)), "here"])
    retrying(script, time, max_wait=10.0).complete(REQUEST)
    assert time.slept == [2.0, 4.0, 8.0, 10.0, 10.0, 10.0]


def test_a_provider_that_asks_for_too_long_a_wait_is_given_up() -> None:
    time = FakeTime()
    script = ScriptedModel([ModelBusy("a", 3600.0, True), "here"])
    with pytest.raises(ModelBusy, match=r"^a \(it asks to wait 3600 s, longer than max_wait=60\)$") as caught:
        retrying(script, time).complete(REQUEST)
    assert (caught.value.retry_after, caught.value.rate_limited) == (3600.0, True)
    assert time.slept == []


def test_all_waits_together_are_bounded() -> None:
    time = FakeTime()
    script = ScriptedModel([ModelBusy("a") for _ in range(100)])
    with pytest.raises(ModelBusy, match=r"asked 4 times; waiting longer would pass total_wait=15 s"):
        retrying(script, time, attempts=100, total_wait=15.0).complete(REQUEST)
    assert time.slept == [2.0, 4.0, 8.0]


@pytest.mark.parametrize("attempts", [1, 2, 5])
def test_attempts_are_a_cap(attempts: int) -> None:
    time = FakeTime()
    script = ScriptedModel([ModelBusy("a") for _ in range(9)])
    with pytest.raises(ModelBusy, match=rf"asked {attempts} times"):
        retrying(script, time, attempts=attempts).complete(REQUEST)
    assert len(script.requests) == attempts
    assert len(time.slept) == attempts - 1


def test_only_rate_limits_shrink_the_limit() -> None:
    time = FakeTime()
    limiter = CallLimiter(8, clock=time.clock, sleep=time.sleep)
    script = ScriptedModel([ModelBusy("a"), ModelBusy("b", 1.0, True), "here"])
    RetryingModel(script, limiter=limiter, clock=time.clock, sleep=time.sleep).complete(REQUEST)
    assert limiter.concurrent == 4


def test_who_else_asks_waits_as_well() -> None:
    time = FakeTime()
    limiter = CallLimiter(8, clock=time.clock, sleep=time.sleep)
    refused = RetryingModel(
        ScriptedModel([ModelBusy("a", 9.0, True)]),
        attempts=1,
        limiter=limiter,
        clock=time.clock,
        sleep=time.sleep,
    )
    other = RetryingModel(ScriptedModel(["here"]), limiter=limiter, clock=time.clock, sleep=time.sleep)
    with pytest.raises(ModelBusy):
        refused.complete(REQUEST)
    assert other.complete(REQUEST).text == "here"
    assert time.slept == [9.0]


@pytest.mark.parametrize("name", ["wait", "max_wait", "total_wait"])
@pytest.mark.parametrize("seconds", [-1.0, float("nan"), float("inf")])
def test_waits_that_are_none_are_refused(name: str, seconds: float) -> None:
    with pytest.raises(ConfigurationError, match=f"{name}={seconds}"):
        RetryingModel(ScriptedModel([]), **{name: seconds})  # type: ignore[arg-type]


def test_any_number_of_attempts_can_be_made() -> None:
    model = RetryingModel(ScriptedModel([ModelBusy("later")] * 1500), attempts=1500, wait=0.0)
    with pytest.raises(ModelBusy, match="asked 1500 times"):
        model.complete(REQUEST)
