"""The shared limit on calls, with a clock that stands still unless somebody sleeps."""

from __future__ import annotations

import threading

import pytest
from fake_time import FakeTime

from adhoc.core.errors import ConfigurationError
from adhoc.llm.limiting import GROW_AFTER, CallLimiter


def limiter_with(time: FakeTime, concurrent: int = 8, per_minute: int | None = None) -> CallLimiter:
    return CallLimiter(concurrent, per_minute, time.clock, time.sleep)


def refuse(limiter: CallLimiter, pause: float = 0.0) -> None:
    with limiter.slot() as slot:
        limiter.refused(slot, pause)


def test_no_more_than_so_many_calls_go_at_once() -> None:
    limiter, lock = CallLimiter(3), threading.Lock()
    now, most = 0, 0
    together = threading.Barrier(3)

    def call() -> None:
        nonlocal now, most
        with limiter.slot():
            with lock:
                now += 1
                most = max(most, now)
            together.wait(5)
            with lock:
                now -= 1

    threads = [threading.Thread(target=call) for _ in range(9)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(10)
    assert most == 3
    assert not any(thread.is_alive() for thread in threads)


def test_a_refusal_halves_and_answers_give_back() -> None:
    limiter = limiter_with(FakeTime(), concurrent=8)
    seen = []
    for _ in range(5):
        refuse(limiter)
        seen.append(limiter.concurrent)
    assert seen == [4, 2, 1, 1, 1]
    for _ in range(GROW_AFTER - 1):
        limiter.answered()
    assert limiter.concurrent == 1
    limiter.answered()
    assert limiter.concurrent == 2
    for _ in range(100 * GROW_AFTER):
        limiter.answered()
    assert limiter.concurrent == 8, "it never grows beyond what was configured"


def test_a_refusal_starts_the_count_of_answers_again() -> None:
    limiter = limiter_with(FakeTime(), concurrent=4)
    refuse(limiter)
    for _ in range(GROW_AFTER - 1):
        limiter.answered()
    refuse(limiter)
    limiter.answered()
    assert limiter.concurrent == 1


def test_calls_under_way_together_are_refused_for_one_reason() -> None:
    limiter = limiter_with(FakeTime(), concurrent=8)
    with limiter.slot() as first, limiter.slot() as second, limiter.slot() as third:
        for slot in (first, second, third):
            limiter.refused(slot)
    assert limiter.concurrent == 4


def test_the_minute_spaces_calls_out() -> None:
    time = FakeTime()
    limiter = limiter_with(time, per_minute=3)
    starts = []
    for _ in range(7):
        with limiter.slot():
            starts.append(time.now)
            time.now += 1.0
    assert starts == [0.0, 1.0, 2.0, 60.0, 61.0, 62.0, 120.0]


def test_a_pause_holds_everybody_back() -> None:
    time = FakeTime()
    limiter = limiter_with(time)
    refuse(limiter, pause=7.0)
    with limiter.slot():
        assert time.slept == [7.0]
    with limiter.slot():
        assert time.slept == [7.0]


def test_a_call_that_raises_gives_its_place_back() -> None:
    limiter = limiter_with(FakeTime(), concurrent=1)
    for _ in range(3):
        with pytest.raises(ValueError, match="x"), limiter.slot():
            raise ValueError("x")


@pytest.mark.parametrize(("concurrent", "per_minute"), [(0, None), (1, 0)])
def test_limits_below_one_are_refused(concurrent: int, per_minute: int | None) -> None:
    with pytest.raises(ConfigurationError, match="CallLimiter"):
        CallLimiter(concurrent, per_minute)
