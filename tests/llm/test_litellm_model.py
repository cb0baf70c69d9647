"""The adapter to litellm, against the provider on loopback."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError, ModelBusy, ModelError, ReplyError
from adhoc.core.replies import Reading, ReplyFormat
from adhoc.llm.litellm_model import LiteLLMModel
from adhoc.llm.model import LMRequest, LMResponse
from adhoc.llm.together import complete_together
from adhoc.testing.loopback_provider import LoopbackProvider
from adhoc.testing.model_contract import LanguageModelContract
from adhoc.testing.provider_faults import Reply

pytestmark = pytest.mark.filterwarnings(
    "ignore::DeprecationWarning", "ignore::ResourceWarning", "ignore::UserWarning"
)
REQUEST = LMRequest(
    (ChatMessage("system", "Be brief."), ChatMessage("user", "Hello")), "generate", max_tokens=50
)
SCHEMA = {"type": "object", "properties": {"a": {"type": "integer"}}, "required": ["a"]}
FORMED = replace(REQUEST, reply=ReplyFormat("answer", SCHEMA, Reading))


@pytest.fixture(autouse=True)
def _no_keys(monkeypatch: pytest.MonkeyPatch) -> None:
    for provider in ("OPENAI", "ANTHROPIC"):
        monkeypatch.delenv(f"{provider}_API_KEY", raising=False)


@pytest.fixture
def provider() -> Iterator[LoopbackProvider]:
    with LoopbackProvider('{"a": 1}') as provider:
        yield provider


@pytest.fixture
def model(provider: LoopbackProvider) -> LiteLLMModel:
    return LiteLLMModel("openai/small", api_base=provider.url, timeout=10)


def formats(provider: LoopbackProvider) -> list[str | None]:
    return [(call.body.get("response_format") or {}).get("type") for call in provider.calls]


class TestContract(LanguageModelContract):
    @pytest.fixture(autouse=True)
    def _serve(self, provider: LoopbackProvider) -> None:
        self.url = provider.url

    def model(self) -> LiteLLMModel:
        return LiteLLMModel("openai/small", api_base=self.url, timeout=10)


def test_success_sends_what_was_configured_once(provider: LoopbackProvider, model: LiteLLMModel) -> None:
    response = model.complete(FORMED)
    assert response.text == '{"a": 1}'
    assert response.model == model.name == "openai/small"
    assert response.usage.prompt_tokens > 0
    assert response.usage.completion_tokens > 0
    assert response.usage.cost_usd == 0.0
    assert response.latency_s > 0.0
    (call,) = provider.calls
    assert call.body["model"] == "small"
    assert call.body["temperature"] == 0.3
    assert call.body["max_tokens"] == 50
    assert "seed" not in call.body
    assert call.body["response_format"]["json_schema"]["schema"] == SCHEMA
    assert [it["role"] for it in call.body["messages"]] == ["system", "user"]


def test_the_raw_answer_is_json_and_holds_no_header_or_key(
    model: LiteLLMModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "sk-of-the-test")
    raw = model.complete(REQUEST).raw
    assert raw is not None
    assert raw["choices"][0]["message"]["content"] == '{"a": 1}'
    assert raw["usage"]["prompt_tokens"] > 0
    text = json.dumps(raw).lower()
    assert "sk-of-the-test" not in text
    assert "content-length" not in text


def test_a_request_may_differ_from_the_configuration(provider: LoopbackProvider, model: LiteLLMModel) -> None:
    asked = replace(REQUEST, model="openai/other", temperature=0.0, seed=2**31 + 5, sample=2)
    assert model.complete(asked).model == "openai/other"
    body = provider.calls[0].body
    assert (body["model"], body["temperature"], body["seed"]) == ("other", 0.0, 7)


def test_a_known_model_has_a_price_and_a_window(provider: LoopbackProvider) -> None:
    model = LiteLLMModel("gpt-4-1106-preview", api_base=provider.url)
    usage = model.complete(REQUEST).usage
    assert usage.cost_usd == pytest.approx(usage.prompt_tokens * 10e-6 + usage.completion_tokens * 30e-6)
    assert model.window == 128_000
    assert LiteLLMModel("openai/small").window is None
    assert LiteLLMModel("openai/small", window=4096).window == 4096


def test_tokens_are_counted_without_a_network() -> None:
    """In a process of its own, in which every connection fails."""
    code = """
import socket
tried = []
def refuse(*address, **_):
    tried.append(address)
    raise OSError("no network")
socket.socket.connect = socket.create_connection = socket.getaddrinfo = refuse
from adhoc.core.chat import ChatMessage
from adhoc.llm.litellm_model import LiteLLMModel
for name in ("gpt-4-1106-preview", "gpt-4o", "claude-2", "together_ai/meta-llama/Llama-3-8b", "command-r"):
    count = LiteLLMModel(name).count_tokens([ChatMessage("user", "hello world " * 50)])
    assert 100 <= count <= 120, (name, count)
assert not tried, tried
"""
    subprocess.run([sys.executable, "-W", "ignore", "-c", code], check=True, timeout=60)


def test_options_reach_the_endpoint(provider: LoopbackProvider, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "sk-of-the-test")
    model = LiteLLMModel(
        "openai/small", temperature=None, max_tokens=7, api_base=provider.url, structured="text", name="mine"
    )
    assert model.complete(FORMED).model == "mine"
    (call,) = provider.calls
    assert call.body["max_tokens"] == 7
    assert "temperature" not in call.body
    assert "response_format" not in call.body
    assert call.authorization == "Bearer sk-of-the-test"


@pytest.mark.parametrize(
    ("refuses", "first", "then"),
    [
        ((), ["json_schema"], "json_schema"),
        (("json_schema",), ["json_schema", "json_object"], "json_object"),
        (("json_schema", "json_object"), ["json_schema", "json_object", None], None),
    ],
)
def test_a_refused_form_gives_way_to_a_freer_one_for_good(
    refuses: tuple[str, ...], first: list[str | None], then: str | None
) -> None:
    with LoopbackProvider('{"a": 1}', refuses=refuses) as provider:
        model = LiteLLMModel("openai/small", api_base=provider.url, timeout=10)
        assert model.complete(FORMED).text == '{"a": 1}'
        assert formats(provider) == first
        model.complete(FORMED)
        assert formats(provider) == [*first, then]


def test_a_form_that_is_configured_is_kept_to() -> None:
    with LoopbackProvider('{"a": 1}', refuses=("json_schema",)) as provider:
        model = LiteLLMModel("openai/small", api_base=provider.url, timeout=10, structured="schema")
        with pytest.raises(ModelError, match=r"llm\.structured"):
            model.complete(FORMED)
        assert formats(provider) == ["json_schema"]


def test_a_refusal_of_something_else_changes_no_form(provider: LoopbackProvider, model: LiteLLMModel) -> None:
    provider.fail_next("400*3")
    with pytest.raises(ModelError, match="request was refused"):
        model.complete(FORMED)
    model.complete(FORMED)
    assert formats(provider) == ["json_schema", "json_object", None, "json_schema"]


def test_the_paper_s_model_is_asked_for_json_without_a_schema(provider: LoopbackProvider) -> None:
    LiteLLMModel("gpt-4-1106-preview", api_base=provider.url).complete(FORMED)
    assert formats(provider) == ["json_object"]


def test_any_text_is_asked_for_without_a_form(provider: LoopbackProvider, model: LiteLLMModel) -> None:
    model.complete(REQUEST)
    assert formats(provider) == [None]


def test_an_empty_key_is_a_missing_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", " ")
    with pytest.raises(ModelError, match=r"needs the environment variable OPENAI_API_KEY"):
        LiteLLMModel("gpt-4-1106-preview").complete(REQUEST)


def test_missing_key_is_found_before_any_call() -> None:
    with pytest.raises(ModelError, match=r"OPENAI_API_KEY.*llm=offline") as caught:
        LiteLLMModel("gpt-4-1106-preview").complete(REQUEST)
    assert not isinstance(caught.value, ModelBusy)


def test_unknown_model_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    model = LiteLLMModel("no-such-model")
    with pytest.raises(ModelError, match=r"no-such-model.*PROVIDER/NAME"):
        model.complete(REQUEST)
    assert model.window is None
    assert capsys.readouterr().out == ""


def test_a_key_of_another_provider_is_refused_and_not_shown(
    provider: LoopbackProvider, model: LiteLLMModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "xyz-of-another-provider")
    message = "Incorrect key: xyz-of-another-provider or sk-proj-****wxyz. Bearer abcdefghijkl"
    body = json.dumps({"error": {"message": message, "code": "invalid_api_key"}}).encode()
    monkeypatch.setattr(provider, "serve", lambda *_: Reply(body, 401))
    with pytest.raises(ModelError, match=r"key was refused.*OPENAI_API_KEY") as caught:
        model.complete(REQUEST)
    assert "Incorrect key: [key] or [key] [key]" in str(caught.value)


@pytest.mark.parametrize(
    ("fault", "error", "words"),
    [
        ("401", ModelError, "key was refused"),
        ("403", ModelError, "key was refused"),
        ("404", ModelError, "does not know"),
        ("400", ModelError, "request was refused"),
        ("quota", ModelError, "add credit"),
        ("overflow", ModelError, r"context window; set llm\.window"),
        ("429", ModelBusy, "rate limit"),
        ("500", ModelBusy, "has a fault"),
        ("503", ModelBusy, "has a fault"),
        ("html502", ModelBusy, "has a fault"),
        ("drop", ModelBusy, "has a fault"),
        ("truncated", ModelBusy, "has a fault"),
        ("html", ModelError, "not with chat completions"),
        ("foreign", ModelError, "not with chat completions"),
    ],
)
def test_refusals(
    provider: LoopbackProvider, model: LiteLLMModel, fault: str, error: type[Exception], words: str
) -> None:
    provider.fail_next(fault)
    with pytest.raises(error, match=words) as caught:
        model.complete(REQUEST)
    assert isinstance(caught.value, ModelBusy) is (error is ModelBusy)
    assert ("try again later" in str(caught.value)) is (error is ModelBusy)
    assert len(provider.calls) == 1


@pytest.mark.parametrize(("fault", "seconds"), [("429:7", 7.0), ("429:0.5", 0.5), ("429", None)])
def test_the_provider_s_wait_is_told(
    provider: LoopbackProvider, model: LiteLLMModel, fault: str, seconds: float | None
) -> None:
    provider.fail_next(fault)
    with pytest.raises(ModelBusy) as caught:
        model.complete(REQUEST)
    assert caught.value.retry_after == seconds
    assert caught.value.rate_limited


@pytest.mark.parametrize("fault", ["html", "foreign", "drop"])
def test_what_worked_before_and_fails_now_is_an_outage(
    provider: LoopbackProvider, model: LiteLLMModel, fault: str
) -> None:
    model.complete(REQUEST)
    provider.fail_next(fault)
    with pytest.raises(ModelBusy, match="try again later"):
        model.complete(REQUEST)


def test_nobody_there_is_a_mistake_at_first_and_an_outage_later() -> None:
    with LoopbackProvider("x") as provider:
        model = LiteLLMModel("openai/small", api_base=provider.url, timeout=5)
        model.complete(REQUEST)
    with pytest.raises(ModelBusy):
        model.complete(REQUEST)
    with pytest.raises(ModelError, match=r"cannot be reached; check llm\.api_base") as caught:
        LiteLLMModel("openai/small", api_base=provider.url, timeout=5).complete(REQUEST)
    assert not isinstance(caught.value, ModelBusy)
    assert provider.url in str(caught.value)


@pytest.mark.parametrize("api_base", ["127.0.0.1:1/v1", "http://no-such-host.invalid/v1", "nonsense"])
def test_an_address_that_is_none(api_base: str) -> None:
    with pytest.raises(ModelError, match=r"llm\.api_base") as caught:
        LiteLLMModel("openai/small", api_base=api_base, timeout=5).complete(REQUEST)
    assert not isinstance(caught.value, ModelBusy)


def test_timeout() -> None:
    with (
        LoopbackProvider("x", faults="silence:30") as provider,
        pytest.raises(ModelBusy, match=r"in time; raise llm\.timeout"),
    ):
        LiteLLMModel("openai/small", api_base=provider.url, timeout=0.2).complete(REQUEST)


@pytest.mark.parametrize(
    ("fault", "outcome"),
    [("no_choices", "empty"), ("null", "empty"), ("empty", "empty"), ("length", "truncated")],
)
def test_useless_answers_are_errors_and_were_paid_for(
    provider: LoopbackProvider, model: LiteLLMModel, fault: str, outcome: str
) -> None:
    provider.fail_next(fault)
    with pytest.raises(ReplyError) as caught:
        model.complete(REQUEST)
    assert caught.value.outcome == outcome
    assert isinstance(caught.value.response, LMResponse)
    assert caught.value.response.usage.prompt_tokens > 0


@pytest.mark.parametrize("has_answered", [False, True])
@pytest.mark.parametrize(
    "body",
    [
        b'{"choices": [{',
        b"[]",
        b"null",
        b"3",
        b'"text"',
        b'{"choices": "x"}',
        b'{"choices": [{"message": null}]}',
        b'{"choices": [{"message": {"content": 5}}]}',
        b'{"choices": [null]}',
        b"\xff\xfe\x00",
        b"",
    ],
)
def test_malformed_bodies_are_the_library_s_errors(
    provider: LoopbackProvider,
    model: LiteLLMModel,
    body: bytes,
    has_answered: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    if has_answered:
        model.complete(REQUEST)
    monkeypatch.setattr(provider, "serve", lambda *_: Reply(body))
    with pytest.raises((ReplyError, ModelError)) as caught:
        model.complete(REQUEST)
    assert "openai/small" in str(caught.value)


def test_questions_go_out_together_and_come_back_in_order() -> None:
    with LoopbackProvider(delay=lambda number: 0.02 * (6 - number)) as provider:
        model = LiteLLMModel("openai/small", api_base=provider.url, timeout=10)
        asked = [replace(REQUEST, max_tokens=50 + number) for number in range(6)]
        answers = complete_together(model, asked)
    assert len(answers) == 6
    assert provider.most_at_once > 1


@pytest.mark.parametrize(
    "arguments", [{"timeout": 0}, {"max_tokens": 0}, {"window": 0}, {"structured": "yes"}]
)
def test_impossible_arguments_are_refused(arguments: dict[str, Any]) -> None:
    with pytest.raises(ConfigurationError):
        LiteLLMModel("openai/small", **arguments)
