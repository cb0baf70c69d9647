"""Questions that go out together: the order of arrival changes nothing."""

from __future__ import annotations

import subprocess
import sys
import threading
import time

import numpy as np
import pytest

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ModelError, ReplyError
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse
from adhoc.llm.together import complete_together


def requests(count: int) -> list[LMRequest]:
    return [LMRequest((ChatMessage("user", str(number)),), "generate") for number in range(count)]


class Echo(LanguageModel):
    """Answers `n` to the request `n` after its delay, or raises its error."""

    name = "echo"

    def __init__(
        self, delays: dict[str, float] | None = None, errors: dict[str, Exception] | None = None
    ) -> None:
        self.delays, self.errors = delays or {}, errors or {}
        self.ended: list[str] = []
        self.threads: set[int] = set()

    def complete(self, request: LMRequest) -> LMResponse:
        text = request.messages[0].content
        self.threads.add(threading.get_ident())
        time.sleep(self.delays.get(text, 0.0))
        self.ended.append(text)
        if text in self.errors:
            raise self.errors[text]
        return LMResponse(text, self.name)


class OneByOne(Echo):
    def may_go_together(self, requests: object) -> bool:
        return False


class Meeting(Echo):
    """Answers only when all have arrived."""

    def __init__(self, count: int) -> None:
        super().__init__()
        self.barrier = threading.Barrier(count)

    def complete(self, request: LMRequest) -> LMResponse:
        self.barrier.wait(5)
        return super().complete(request)


@pytest.mark.parametrize("seed", range(5))
def test_answers_come_in_the_order_of_the_requests(seed: int) -> None:
    delays = np.random.default_rng(seed).permutation(8) * 0.01
    model = Echo({str(number): float(delay) for number, delay in enumerate(delays)})
    assert [answer.text for answer in complete_together(model, requests(8))] == [str(it) for it in range(8)]
    assert model.ended != sorted(model.ended), "the delays did not shuffle anything"


def test_they_go_out_at_the_same_time() -> None:
    assert len(complete_together(Meeting(5), requests(5))) == 5


def test_errors_wait_until_all_have_ended() -> None:
    model = Echo({"3": 0.05}, {"1": ReplyError("one"), "2": ReplyError("two")})
    with pytest.raises(ReplyError, match="one"):
        complete_together(model, requests(4))
    assert sorted(model.ended) == ["0", "1", "2", "3"]


def test_what_ends_a_run_goes_before_a_bad_reply() -> None:
    for kind in (Echo, OneByOne):
        with pytest.raises(ModelError, match="key"):
            complete_together(kind(errors={"0": ReplyError("bad"), "2": ModelError("key")}), requests(3))


def test_a_model_that_needs_the_order_is_asked_in_order() -> None:
    model = OneByOne({"0": 0.02}, {"1": ReplyError("bad")})
    with pytest.raises(ReplyError):
        complete_together(model, requests(4))
    assert model.ended == ["0", "1", "2", "3"]
    assert model.threads == {threading.get_ident()}


def test_one_and_none_need_no_threads() -> None:
    model = Echo()
    assert complete_together(model, []) == []
    assert complete_together(model, requests(1))[0].text == "0"
    assert model.threads == {threading.get_ident()}


INTERRUPTED = """
import signal, sys, threading
from adhoc.core.chat import ChatMessage
from adhoc.llm import together
from adhoc.llm.model import LanguageModel, LMRequest

together.PATIENCE_S = 0.1
asked = []

class Silent(LanguageModel):
    name = "silent"

    def complete(self, request):
        asked.append(request)
        if len(asked) == together.MOST_AT_ONCE:
            signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)
        threading.Event().wait(600)

try:
    together.ask_together(Silent(), [LMRequest((ChatMessage("user", str(it)),), "s") for it in range(40)])
except KeyboardInterrupt:
    sys.exit(7 if len(asked) == together.MOST_AT_ONCE else 8)
"""


def test_an_interruption_does_not_wait_for_a_provider_that_is_silent() -> None:
    done = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (7, "")
