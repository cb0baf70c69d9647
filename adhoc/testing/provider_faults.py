"""The ways in which a provider of language models fails, as words that a script is made of."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from adhoc.core.errors import ConfigurationError

Completion = Mapping[str, Any]
"""An answer in OpenAI's form, `chat.completion`."""

ANSWER = "ok"
_PAGE = b"<html><body><h1>502 Bad Gateway</h1></body></html>"
_KINDS = (
    "429[:RETRY_AFTER_S] 500 503 400 401 403 404 quota overflow drop silence:SECONDS html html502 foreign "
    "truncated wrong_type no_choices null empty length ok"
)


@dataclass(frozen=True)
class Reply:
    """What a provider sends back for one request."""

    body: bytes
    status: int = 200
    headers: Mapping[str, str] = field(default_factory=dict)
    content_type: str = "application/json"
    silence_s: float = 0.0
    """How long nothing is sent."""
    sent: float = 1.0
    """The share of the announced body that is sent before the connection is closed; 0 drops it at once."""


def parse_script(script: str | Sequence[str]) -> list[str]:
    """The faults of a script, one for each call in order of arrival.

    A word is a kind of fault, for some with a number after a colon (`429:2`, `silence:30`), and may be
    repeated by `*COUNT` (`503*4`); in a string, words are separated by commas. `ok` is an answer.

    Raises:
        ConfigurationError: a word is unknown.
    """
    words = script.split(",") if isinstance(script, str) else script
    faults: list[str] = []
    for word in (it.strip() for it in words if it.strip()):
        fault, _, count = word.partition("*")
        try:
            reply_with(fault, {"choices": [{"message": {}}]})
            faults += [fault] * (int(count) if count else 1)
        except (KeyError, ValueError) as error:
            raise ConfigurationError(f"fault {word!r}: is none of {_KINDS}, with *COUNT or not") from error
    return faults


def reply_with(fault: str, completion: Completion) -> Reply:
    """What is sent instead of `completion`. Raises KeyError or ValueError where there is no such fault."""
    kind, _, number = fault.partition(":")
    if kind == "429":
        return _error(429, "rate_limit_exceeded", {"Retry-After": number} if float(number or 0) else {})
    if kind == "silence":
        return Reply(b" ", silence_s=float(number), sent=0.0)
    if number:
        raise ValueError(fault)
    body = json.dumps(completion).encode()
    whole = {
        ANSWER: Reply(body),
        "drop": Reply(body, sent=0.0),
        "truncated": Reply(body, sent=0.5),
        "html": Reply(_PAGE, content_type="text/html"),
        "html502": Reply(_PAGE, status=502, content_type="text/html"),
        "foreign": Reply(b'{"greeting": "hello"}'),
        "wrong_type": Reply(body, content_type="text/plain"),
        "quota": _error(429, "insufficient_quota"),
        "overflow": _error(400, "context_length_exceeded"),
        **{str(status): _error(status, code) for status, code in _CODES.items()},
    }
    if kind in whole:
        return whole[kind]
    return Reply(json.dumps(_changed(kind, completion)).encode())


_CODES = {
    400: "invalid_request_error",
    401: "invalid_api_key",
    403: "forbidden",
    404: "model_not_found",
    500: "server_error",
    503: "server_error",
}
_SENTENCES = {
    "context_length_exceeded": "This model's maximum context length is 10 tokens; your messages have more.",
    "insufficient_quota": "You exceeded your current quota, please check your plan and billing details.",
}


def _error(status: int, code: str, headers: Mapping[str, str] | None = None) -> Reply:
    message = _SENTENCES.get(code, code)
    error = {"message": message, "type": code, "code": code, "param": None}
    return Reply(json.dumps({"error": error}).encode(), status, headers or {})


def _changed(kind: str, completion: Completion) -> Completion:
    """A completion without anything usable in it."""
    if kind == "no_choices":
        return {**completion, "choices": []}
    changes: Mapping[str, tuple[Mapping[str, Any], str]] = {
        "null": ({"content": None}, "stop"),
        "empty": ({"content": ""}, "stop"),
        "length": ({"content": '{"sub_tasks": [{"na'}, "length"),
    }
    message, finish_reason = changes[kind]
    choice = completion["choices"][0]
    cut = {**choice, "message": {**choice["message"], **message}, "finish_reason": finish_reason}
    return {**completion, "choices": [cut]}
