"""A provider of language models on loopback, for tests: it counts what it is asked, and fails on demand.

As a context manager, `with LoopbackProvider() as provider:`, it serves from a thread; as
`python -m adhoc.testing.loopback_provider --count-file FILE` from a process of its own, which says on its
first line of output where it listens. Either way, point a model at it: `llm=litellm llm.model=openai/small
llm.api_base=URL`.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import threading
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from types import TracebackType
from typing import Any

from adhoc.core.chat import ChatMessage
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage
from adhoc.llm.offline.reasoner import OfflineReasoner
from adhoc.tasks.placement import placement_table
from adhoc.testing.provider_faults import ANSWER, Completion, Reply, parse_script, reply_with

_POLL_S = 0.02


@dataclass(frozen=True)
class ReceivedCall:
    """One request as it arrived."""

    content: str
    """Hash of the body: equal for equal requests."""
    body: Mapping[str, Any]
    authorization: str
    fault: str
    """What it was answered with; `ok` for an answer."""


class LoopbackProvider:
    """An OpenAI-compatible endpoint, `URL/chat/completions`, that does what a test wants of it.

    Args:
        answer: Who answers: a model, or a text that is always the same; the offline reasoner by default.
        faults: The script: how to fail, call by call (see `provider_faults`); answers once it is used up.
        delay: Seconds before every reply, or what gives them for the number of the call.
        count_file: Gets a line of JSON for every request before it is replied to, so that the counts
            outlive whoever asks.
        port: 0 takes a free one.
        key: If given, any other is refused (401).
        refuses: Types of `response_format` that are refused (400), as many local servers do.
        capacity: More calls at once than this are refused (429).
    """

    def __init__(
        self,
        answer: LanguageModel | str | None = None,
        faults: str | Sequence[str] = (),
        delay: float | Callable[[int], float] = 0.0,
        count_file: Path | None = None,
        port: int = 0,
        key: str | None = None,
        refuses: Sequence[str] = (),
        capacity: int | None = None,
    ) -> None:
        self._answer = _FixedText(answer) if isinstance(answer, str) else answer or _offline()
        self._script = parse_script(faults)
        self._delay, self._count_file, self._key = delay, count_file, key
        self._refuses, self._capacity = tuple(refuses), capacity
        self._lock, self._stopped = threading.Lock(), threading.Event()
        self.calls: list[ReceivedCall] = []
        """Everything that was asked, in order of arrival."""
        self.at_once = 0
        """Calls that are being answered now."""
        self.most_at_once = 0
        self._http = ThreadingHTTPServer(("127.0.0.1", port), _handler(self))
        self._thread = threading.Thread(target=self._http.serve_forever, args=(_POLL_S,), daemon=True)

    @property
    def url(self) -> str:
        """What goes into `api_base`."""
        return f"http://127.0.0.1:{self._http.server_port}/v1"

    @property
    def answered(self) -> Counter[str]:
        """How often each content was answered, that is: paid."""
        return Counter(call.content for call in self.calls if call.fault == ANSWER)

    def fail_next(self, faults: str | Sequence[str]) -> None:
        """Forget the rest of the script; the next calls fail so."""
        with self._lock:
            self._script = [ANSWER] * len(self.calls) + parse_script(faults)

    def __enter__(self) -> LoopbackProvider:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stopped.set()
        self._http.shutdown()
        self._http.server_close()
        self._thread.join()

    def serve(self, body: bytes, authorization: str) -> Reply | None:
        """The reply to one request, after the delay; None if the provider was stopped meanwhile."""
        asked = json.loads(body)
        with self._lock:
            self.at_once += 1
            self.most_at_once = max(self.most_at_once, self.at_once)
            number = len(self.calls)
            fault = self._fault(number, asked, authorization)
            call = ReceivedCall(content_hash(asked), asked, authorization, fault)
            self.calls.append(call)
            self._count(call)
        try:
            reply = reply_with(fault, self._complete(asked))
            delay = self._delay(number) if callable(self._delay) else self._delay
            return None if self._stopped.wait(delay + reply.silence_s) else reply
        finally:
            with self._lock:
                self.at_once -= 1

    def _fault(self, number: int, asked: Mapping[str, Any], authorization: str) -> str:
        if self._key is not None and authorization != f"Bearer {self._key}":
            return "401"
        if (asked.get("response_format") or {}).get("type") in self._refuses:
            return "400"
        if self._capacity is not None and self.at_once > self._capacity:
            return "429"
        return self._script[number] if number < len(self._script) else ANSWER

    def _count(self, call: ReceivedCall) -> None:
        if self._count_file is not None:
            with self._count_file.open("a") as file:
                file.write(json.dumps({"content": call.content, "fault": call.fault}) + "\n")

    def _complete(self, asked: Mapping[str, Any]) -> Completion:
        messages = tuple(ChatMessage(it["role"], it["content"]) for it in asked["messages"])
        response = self._answer.complete(LMRequest(messages, "loopback"))
        tokens = (response.usage.prompt_tokens, response.usage.completion_tokens)
        message = {"role": "assistant", "content": response.text}
        return {
            "id": "chatcmpl-loopback",
            "object": "chat.completion",
            "created": 1,
            "model": asked.get("model"),
            "choices": [{"index": 0, "finish_reason": "stop", "message": message}],
            "usage": dict(
                zip(("prompt_tokens", "completion_tokens", "total_tokens"), (*tokens, sum(tokens)))
            ),
        }


class _FixedText(LanguageModel):
    def __init__(self, text: str) -> None:
        self._text = text

    @property
    def name(self) -> str:
        return "fixed text"

    def complete(self, request: LMRequest) -> LMResponse:
        return LMResponse(self._text, self.name, Usage(self.count_tokens(request.messages), len(self._text)))


def _offline() -> LanguageModel:
    return OfflineReasoner(placement_table())


def content_hash(body: Mapping[str, Any]) -> str:
    """What is counted: equal for equal requests, whatever the order of their fields."""
    return hashlib.sha256(json.dumps(body, sort_keys=True).encode()).hexdigest()[:16]


def read_counts(count_file: Path) -> Counter[str]:
    """How often each content was answered, from the lines that a provider left behind."""
    lines = [json.loads(line) for line in count_file.read_text().splitlines()] if count_file.exists() else []
    return Counter(line["content"] for line in lines if line["fault"] == ANSWER)


def _handler(provider: LoopbackProvider) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"
        disable_nagle_algorithm = True

        def do_POST(self) -> None:
            body = self.rfile.read(int(self.headers["Content-Length"]))
            reply = provider.serve(body, self.headers.get("Authorization", ""))
            self.close_connection = True
            if reply is None or reply.sent == 0.0:
                return
            self.send_response(reply.status)
            self.send_header("Content-Type", reply.content_type)
            self.send_header("Content-Length", str(len(reply.body)))
            self.send_header("Connection", "close")
            for name, value in reply.headers.items():
                self.send_header(name, value)
            with contextlib.suppress(OSError):
                self.end_headers()
                self.wfile.write(reply.body[: int(len(reply.body) * reply.sent)])

        def log_message(self, *_: Any) -> None:
            pass

    return Handler


if __name__ == "__main__":
    from adhoc.testing.loopback_process import main

    main()
