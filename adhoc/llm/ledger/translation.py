"""Between requests and responses on one side, and entries of a ledger on the other."""

from __future__ import annotations

import json
from collections.abc import Iterator
from datetime import datetime, timezone

from adhoc.core.errors import ReplyError
from adhoc.llm.ledger.entry import Answer, Call, Text
from adhoc.llm.ledger.key import text_hash
from adhoc.llm.ledger.storable import storable, without_keys
from adhoc.llm.model import LMRequest, LMResponse, Usage


def given(answer: Answer, replayed: bool = True) -> LMResponse:
    """The response that a recorded answer stands for. Raises ReplyError if it is one of no use."""
    usage = Usage(answer.prompt_tokens, answer.completion_tokens, answer.cost_usd)
    response = LMResponse(
        answer.text,
        answer.model,
        usage,
        answer.finish_reason,
        answer.latency_s,
        answer.raw,
        replayed=replayed,
    )
    if answer.outcome is not None:
        raise ReplyError(answer.problem or answer.outcome, answer.outcome, response if answer.model else None)
    return response


def call_entry(key: str, repeat: int, request: LMRequest, model: str) -> Call:
    """What is recorded of a request before it is made; `model` is the one that will answer."""
    schema = _schema_text(request)
    return Call(
        key,
        request.stage,
        request.agent,
        request.episode,
        request.template,
        request.sample,
        repeat,
        model,
        request.temperature,
        request.max_tokens,
        request.seed,
        None if schema is None else text_hash(schema),
        tuple((message.role, text_hash(message.content)) for message in request.messages),
        utc_now(),
    )


def utc_now() -> str:
    """The time of an entry."""
    return datetime.now(timezone.utc).isoformat(timespec="milliseconds")


def answer_entry(key: str, response: LMResponse, latency: float, error: ReplyError | None = None) -> Answer:
    """What is recorded of a response, `latency` seconds after it was asked for where it does not say."""
    return Answer(
        key,
        response.model,
        response.usage.prompt_tokens,
        response.usage.completion_tokens,
        response.usage.cost_usd,
        response.finish_reason,
        round(response.latency_s or latency, 6),
        without_keys(response.text),
        storable(response.raw),
        None if error is None else error.outcome,
        None if error is None else without_keys(str(error)),
        utc_now(),
    )


def refusal_entry(key: str, error: ReplyError, latency: float) -> Answer:
    """What is recorded of an answer of no use."""
    response = error.response if isinstance(error.response, LMResponse) else LMResponse("", "")
    return answer_entry(key, response, latency, error)


def texts_of(request: LMRequest) -> Iterator[Text]:
    """The texts that the entry of a request refers to."""
    schema = _schema_text(request)
    for content in (*(() if schema is None else (schema,)), *(it.content for it in request.messages)):
        stored = without_keys(content)
        yield Text(text_hash(content), stored, stored != content)


def _schema_text(request: LMRequest) -> str | None:
    return None if request.reply is None else json.dumps(request.reply.schema, default=dict)
