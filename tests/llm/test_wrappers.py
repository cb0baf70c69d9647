"""Models around a model: counting, retrying; and the scripted one."""

from __future__ import annotations

import pytest

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError, ModelBusy, ModelError, ReplyError
from adhoc.llm.counting import CountingModel
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage
from adhoc.llm.retrying import RetryingModel
from adhoc.llm.scripted import ScriptedModel
from adhoc.testing.model_contract import LanguageModelContract

REQUEST = LMRequest((ChatMessage("user", "one two three"),), "generate")


class Priced(LanguageModel):
    name = "priced"

    def complete(self, request: LMRequest) -> LMResponse:
        return LMResponse("x", self.name, Usage(10, 2, 0.5))


class TestScripted(LanguageModelContract):
    def model(self) -> LanguageModel:
        return ScriptedModel(["an answer"])


class TestCounting(LanguageModelContract):
    def model(self) -> LanguageModel:
        return CountingModel(ScriptedModel(["an answer"]))


class TestRetrying(LanguageModelContract):
    def model(self) -> LanguageModel:
        return RetryingModel(ScriptedModel(["an answer"]))


def test_counts_are_kept_per_stage_and_added_up() -> None:
    model = CountingModel(Priced())
    for stage in ("generate", "generate", "reflect"):
        model.complete(LMRequest(REQUEST.messages, stage))
    for stage, outcome in (("generate", "empty"), ("generate", "invalid"), ("reflect", "repaired")):
        model.note(stage, outcome)
    assert model.name == "priced"
    assert model.stages["generate"].calls == 2
    total = model.total
    assert (total.calls, total.prompt_tokens, total.completion_tokens, total.cost_usd) == (3, 30, 6, 1.5)
    assert (total.invalid, total.repaired) == (1, 1)
    assert total.outcomes == {"empty": 1, "invalid": 1, "repaired": 1}
    model.begin_episode("second", 0)
    assert model.total.calls == 0


def test_a_failed_call_is_a_call() -> None:
    model = CountingModel(ScriptedModel([ReplyError("cut", "truncated")]))
    with pytest.raises(ReplyError):
        model.complete(REQUEST)
    assert (model.total.calls, model.total.invalid) == (1, 0)


def test_wrappers_pass_notes_on() -> None:
    inner = CountingModel(Priced())
    outer = CountingModel(RetryingModel(inner))
    outer.note("generate", "invalid")
    outer.note("generate", "repaired")
    assert (inner.total.invalid, inner.total.repaired) == (1, 1)


def test_a_busy_model_is_asked_again_after_doubling_waits() -> None:
    waits: list[float] = []
    script = ScriptedModel([ModelBusy("a"), ModelBusy("b"), "here"])
    model = RetryingModel(script, attempts=3, wait=2.0, sleep=waits.append)
    assert model.complete(REQUEST).text == "here"
    assert waits == [2.0, 4.0]


def test_the_last_refusal_stands() -> None:
    script = ScriptedModel([ModelBusy("a"), ModelBusy("b"), "here"])
    with pytest.raises(ModelBusy, match=r"^b \(asked 2 times\)$"):
        RetryingModel(script, attempts=2, sleep=lambda _: None).complete(REQUEST)
    with pytest.raises(ConfigurationError, match="attempts"):
        RetryingModel(script, attempts=0)


@pytest.mark.parametrize("error", [ModelError("no key"), ReplyError("empty", "empty")])
def test_other_errors_are_not_retried(error: Exception) -> None:
    script = ScriptedModel([error, "here"])
    with pytest.raises(type(error)):
        RetryingModel(script, sleep=lambda _: None).complete(REQUEST)
    assert len(script.requests) == 1


def test_a_script_ends_and_remembers() -> None:
    script = ScriptedModel(["one"])
    assert script.complete(REQUEST).usage == Usage(3, 1)
    with pytest.raises(ModelError, match="used up"):
        script.complete(REQUEST)
    assert script.requests == [REQUEST, REQUEST]


def test_importing_the_models_does_not_import_litellm() -> None:
    import subprocess
    import sys

    code = (
        "import sys, adhoc.llm.litellm_model, adhoc.llm.offline.reasoner, adhoc.planning.staged\n"
        "assert not {'litellm', 'openai', 'torch', 'numba'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
