"""The adapter to litellm, against an OpenAI-compatible server on loopback."""

from __future__ import annotations

import contextlib
import json
import threading
import time
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import pytest

from adhoc.core.chat import ChatMessage
from adhoc.core.errors import ConfigurationError, ModelBusy, ModelError, ReplyError
from adhoc.llm.litellm_model import LiteLLMModel
from adhoc.llm.model import LMRequest
from adhoc.testing.model_contract import LanguageModelContract

pytestmark = pytest.mark.filterwarnings(
    "ignore::DeprecationWarning", "ignore::ResourceWarning", "ignore::UserWarning"
)
REQUEST = LMRequest(
    (ChatMessage("system", "Be brief."), ChatMessage("user", "Hello")), "generate", max_tokens=50
)


def completion(content: str | None = '{"a": 1}', finish_reason: str = "stop") -> dict[str, Any]:
    return {
        "id": "x",
        "object": "chat.completion",
        "created": 1,
        "model": "small",
        "choices": [
            {"index": 0, "finish_reason": finish_reason, "message": {"role": "assistant", "content": content}}
        ],
        "usage": {"prompt_tokens": 12, "completion_tokens": 5, "total_tokens": 17},
    }


class Server:
    """Answers every request with `status` and `body`, and remembers what it was asked."""

    def __init__(self) -> None:
        self.status = 200
        self.body: bytes = json.dumps(completion()).encode()
        self.delay = 0.0
        self.asked: list[dict[str, Any]] = []
        self.headers: list[dict[str, str]] = []
        outer = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                length = int(self.headers["Content-Length"])
                outer.asked.append(json.loads(self.rfile.read(length)))
                outer.headers.append(dict(self.headers))
                time.sleep(outer.delay)
                self.send_response(outer.status)
                self.send_header("Content-Type", "application/json")
                self.send_header("Content-Length", str(len(outer.body)))
                self.end_headers()
                with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                    self.wfile.write(outer.body)

            def log_message(self, *_: Any) -> None:
                pass

        self._http = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.base = f"http://127.0.0.1:{self._http.server_port}/v1"
        self._thread = threading.Thread(
            target=self._http.serve_forever, kwargs={"poll_interval": 0.02}, daemon=True
        )
        self._thread.start()

    def answer(self, body: dict[str, Any] | bytes, status: int = 200) -> None:
        self.status = status
        self.body = body if isinstance(body, bytes) else json.dumps(body).encode()

    def close(self) -> None:
        self._http.shutdown()
        self._http.server_close()
        self._thread.join()


@pytest.fixture(scope="module")
def shared_server() -> Iterator[Server]:
    server = Server()
    yield server
    server.close()


@pytest.fixture
def server(shared_server: Server, monkeypatch: pytest.MonkeyPatch) -> Server:
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    shared_server.answer(completion())
    shared_server.delay = 0.0
    shared_server.asked.clear()
    shared_server.headers.clear()
    return shared_server


@pytest.fixture
def model(server: Server) -> LiteLLMModel:
    return LiteLLMModel("openai/small", api_base=server.base, timeout=10)


class TestContract(LanguageModelContract):
    @pytest.fixture(autouse=True)
    def _serve(self, server: Server) -> None:
        self.base = server.base

    def model(self) -> LiteLLMModel:
        return LiteLLMModel("openai/small", api_base=self.base, timeout=10)


def test_success_sends_what_was_configured_once(server: Server, model: LiteLLMModel) -> None:
    response = model.complete(REQUEST)
    assert response.text == '{"a": 1}'
    assert response.model == model.name == "openai/small"
    assert (response.usage.prompt_tokens, response.usage.completion_tokens) == (12, 5)
    assert response.usage.cost_usd == 0.0
    (asked,) = server.asked
    assert asked["temperature"] == 0.3
    assert asked["max_tokens"] == 50
    assert asked["response_format"] == {"type": "json_object"}
    assert [it["role"] for it in asked["messages"]] == ["system", "user"]


def test_a_known_model_has_a_price(server: Server) -> None:
    body = completion()
    body["model"] = "gpt-4-1106-preview"
    server.answer(body)
    response = LiteLLMModel("gpt-4-1106-preview", api_base=server.base).complete(REQUEST)
    assert response.usage.cost_usd == pytest.approx(12 * 10e-6 + 5 * 30e-6)


def test_options_reach_the_endpoint(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENAI_API_KEY", "sk-of-the-test")
    model = LiteLLMModel(
        "openai/small", temperature=None, max_tokens=7, api_base=server.base, json_mode=False, name="mine"
    )
    assert model.complete(REQUEST).model == "mine"
    assert server.asked[0]["max_tokens"] == 7
    assert "temperature" not in server.asked[0]
    assert "response_format" not in server.asked[0]
    assert server.headers[0]["Authorization"] == "Bearer sk-of-the-test"


def test_missing_key_is_found_before_any_call(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    with pytest.raises(ModelError, match=r"OPENAI_API_KEY.*llm=offline") as caught:
        LiteLLMModel("gpt-4-1106-preview").complete(REQUEST)
    assert not isinstance(caught.value, ModelBusy)


def test_unknown_model_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ModelError, match=r"no-such-model.*PROVIDER/NAME"):
        LiteLLMModel("no-such-model").complete(REQUEST)
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("status", "code", "error", "words"),
    [
        (401, "invalid_api_key", ModelError, "key was refused"),
        (403, "forbidden", ModelError, "key was refused"),
        (404, "model_not_found", ModelError, "does not know"),
        (400, "bad", ModelError, "request was refused"),
        (429, "insufficient_quota", ModelError, "quota"),
        (429, "rate_limit_exceeded", ModelBusy, "rate limit"),
        (500, "server_error", ModelBusy, "has a fault"),
        (503, "server_error", ModelBusy, "has a fault"),
        (400, "context_length_exceeded", ReplyError, "context window"),
    ],
)
def test_refusals(
    server: Server, model: LiteLLMModel, status: int, code: str, error: type[Exception], words: str
) -> None:
    message = "This model's maximum context length is 10 tokens" if "context" in code else code
    server.answer({"error": {"message": message, "type": code, "code": code, "param": None}}, status)
    with pytest.raises(error, match=words) as caught:
        model.complete(REQUEST)
    assert type(caught.value) is error
    assert "RetryingModel" not in str(caught.value), "the command line has wrapped the model already"
    assert ("try again later" in str(caught.value)) is (error is ModelBusy)
    assert len(server.asked) == 1


def test_refused_connection(server: Server) -> None:
    idle = Server()
    base = idle.base
    idle.close()
    with pytest.raises(ModelError, match="cannot be reached") as caught:
        LiteLLMModel("openai/small", api_base=base, timeout=5).complete(REQUEST)
    assert not isinstance(caught.value, ModelBusy)
    assert base in str(caught.value)


def test_timeout(server: Server) -> None:
    server.delay = 1.0
    with pytest.raises(ModelBusy, match="in time"):
        LiteLLMModel("openai/small", api_base=server.base, timeout=0.2).complete(REQUEST)


@pytest.mark.parametrize(
    ("body", "outcome"),
    [
        ({**completion(), "choices": []}, "empty"),
        (completion(None), "empty"),
        (completion(""), "empty"),
        (completion('{"a": ', "length"), "truncated"),
    ],
)
def test_useless_answers(server: Server, model: LiteLLMModel, body: dict[str, Any], outcome: str) -> None:
    server.answer(body)
    with pytest.raises(ReplyError) as caught:
        model.complete(REQUEST)
    assert caught.value.outcome == outcome


@pytest.mark.parametrize(
    "body", [b'{"choices": [{', b"<html>Bad gateway</html>", b"[]", b'{"unexpected": 1}']
)
def test_malformed_bodies_are_the_library_s_errors(server: Server, model: LiteLLMModel, body: bytes) -> None:
    server.answer(body)
    with pytest.raises((ReplyError, ModelBusy)) as caught:
        model.complete(REQUEST)
    assert "openai/small" in str(caught.value)


@pytest.mark.parametrize("arguments", [{"timeout": 0}, {"max_tokens": 0}])
def test_impossible_numbers_are_refused(arguments: dict[str, Any]) -> None:
    with pytest.raises(ConfigurationError):
        LiteLLMModel("openai/small", **arguments)
