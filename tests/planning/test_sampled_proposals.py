"""Several samples of one question: asked for together, merged in an order that arrival does not change."""

from __future__ import annotations

import threading
import time

import pytest
from fake_situation import CONTEXT

from adhoc.core.calls import Call
from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.evaluation.exchanges import TranscribingModel
from adhoc.llm.counting import CountingModel
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage
from adhoc.planning.generate import LLMGenerator

REPLIES = (
    '{"sub_tasks": ["Search room|4", "Rest"]}',
    '{"sub_tasks": ["Search room|3", "Rest"]}',
    "no idea",
    '{"sub_tasks": ["Search room|3"]}',
)


class Sampled(LanguageModel):
    """Answers each sample after its delay; `most` is how many were under way at once."""

    name = "sampled"

    def __init__(self, delays=(0.0,) * 4):
        self.delays, self.under_way, self.most = delays, 0, 0
        self.lock = threading.Lock()

    def complete(self, request: LMRequest) -> LMResponse:
        with self.lock:
            self.under_way += 1
            self.most = max(self.most, self.under_way)
        time.sleep(self.delays[request.sample])
        with self.lock:
            self.under_way -= 1
        return LMResponse(REPLIES[request.sample], self.name, Usage(10, 1))


@pytest.mark.parametrize(
    "delays", [(0.0, 0.02, 0.04, 0.06), (0.06, 0.04, 0.02, 0.0), (0.03, 0.0, 0.06, 0.03)]
)
def test_what_most_samples_propose_comes_first_whatever_arrives_first(delays):
    inner = Sampled(delays)
    transcript = TranscribingModel(inner)
    model = CountingModel(transcript)
    found = LLMGenerator(model, samples=4).generate(CONTEXT)
    assert [it.sub_task for it in found] == [
        Call("Search", ("room|3",)),
        Call("Rest", ()),
        Call("Search", ("room|4",)),
    ]
    assert inner.most > 1
    counts = model.stages["generate"]
    assert (counts.calls, counts.outcomes) == (5, {"valid": 3, "invalid": 1, "unreadable": 2})
    assert [it["reply"] for it in transcript.take(CONTEXT.me)] == [*REPLIES[:3], "no idea", REPLIES[3]]
    prefixes = counts.prefix_tokens
    again = CountingModel(Sampled())
    LLMGenerator(again, samples=4).generate(CONTEXT)
    assert again.stages["generate"].prefix_tokens == prefixes


def test_samples_without_any_use_are_an_error():
    class Useless(Sampled):
        def complete(self, request: LMRequest) -> LMResponse:
            return LMResponse("no idea", self.name)

    with pytest.raises(ReplyError, match="no JSON object"):
        LLMGenerator(Useless(), samples=3).generate(CONTEXT)


def test_the_number_of_samples_is_checked():
    with pytest.raises(ConfigurationError, match="samples=0"):
        LLMGenerator(Sampled(), samples=0)
